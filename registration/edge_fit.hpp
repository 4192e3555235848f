#pragma once

#include <Eigen/Core>
#include <vector>

#include "registration/arc_spline.hpp"
#include "registration/scanner_edge.hpp"
#include "registration/scene.hpp"
#include "registration/subdivision_icp.hpp"

namespace arris {

/// Options of fit_edge().
struct EdgeFitOptions {
  double knot_mm = 40.0;             ///< distance of the spline knots along the contour
  double strip_mm = 10.0;            ///< widest strip of material whose density the edge is judged by
  double normal_strip_mm = 25.0;     ///< strip whose points give height and tilt at the edge
  double bend_across_per_mm = 5e-5;  ///< expected second derivative of the shift across, 1/mm
  double bend_normal_per_mm = 1e-4;  ///< and of the height
  double tilt_change_rad = 0.01;     ///< expected change of tilt from knot to knot
  double height_reach_mm = 3.0;  ///< farther from the carried surface (and three spacings) no point is of it
  double start_sigma_mm = 0.0;   ///< about how far off the carried surface may be; 0: not known
  double gate_floor_mm = 0.0;    ///< points this near to the fitted height take part, however low the noise
  ScannerEdge scanner;           ///< taken off what the scan shows
  int threads = 0;
};

/// Where the edge really is, relative to the nominal contour carried by a ContourMotion, as smooth numbers
/// along s.
struct EdgeFit {
  ArcSpline spline;
  Eigen::VectorXd across;             ///< into the material, mm
  Eigen::VectorXd height;             ///< out of the material, mm
  Eigen::VectorXd tilt;               ///< slope of the height across the contour, rad
  Eigen::MatrixXd across_covariance;  ///< of the coefficients, mm^2
  Eigen::MatrixXd height_covariance;
  Eigen::MatrixXd tilt_covariance;  ///< rad^2
  double bin_mm = 0.0;
  std::vector<char> seen;          ///< a bin of arc length: did the scan show the edge here?
  std::vector<char> beside;        ///< a bin: did it show the surface beside the edge?
  std::vector<double> row_gap_mm;  ///< a bin: how far apart rows of points run along the edge; 0: none do
  double density_per_mm2 = 0.0;    ///< median over the seen bins
  double residual_sigma_mm = 0.0;  ///< robust residual of the height fit
  std::size_t points = 0;          ///< inliers of the height fit
  double scanner_sd_mm = 0.0;      ///< of the scanner's edge, alike all along the contour

  /// Nothing found yet: zero on this spline.
  explicit EdgeFit(const ArcSpline& along);
  [[nodiscard]] bool seen_at(double arc_mm) const;
  [[nodiscard]] double row_gap_at_mm(double arc_mm) const;
  /// Arc length to the nearest place where the edge was seen; 0 where it was.
  [[nodiscard]] double to_seen_mm(double arc_mm, bool closed) const;
  /// Standard deviations at s: of the fit, the edge limit 1 / (density * 50 mm) that no scan of this density
  /// goes below across the contour (or that of an edge anywhere between two rows), the scanner's edge, and
  /// what a part may bend unseen inside a gap.
  [[nodiscard]] double sd_across_mm(double arc_mm, bool closed) const;
  [[nodiscard]] double sd_height_mm(double arc_mm, bool closed) const;
  [[nodiscard]] double sd_tilt_rad(double arc_mm) const;
  /// 1 / (density * 50 mm).
  [[nodiscard]] double edge_limit_mm() const;
  /// Share of the contour's length on which the edge was seen.
  [[nodiscard]] double seen_ratio() const;
};

/// The edge by one-sided support: scan points lie on the material side of it, with a density that is uniform
/// near it. A point at distance g inside the edge costs -log sigmoid(g / tau - 0.541); each point of the
/// strip pulls inward by 1 / strip, its share of the density. With log(1 + exp(0.541)) = 1 the two balance
/// without bias for a uniform density at any tau. Averaging boundary points instead keeps a bias of 0.4
/// to 1.3 point spacings.
/// Where it is seen is judged from the fitted edge, and it is fitted where it is seen, in turn: an edge that
/// bending moved into the material would look like a gap from where it was.
///   scan     carried back to the CAD by `motion`; points off the surface by more than 4 sigma (walls,
///   strays)
///            left out
///   returns  shift across, height and tilt along the contour; where a patch is missing the splines'
///   stiffness
///            decides
///   cost     O(points in the strips) + dense solves of the knot count
[[nodiscard]] EdgeFit fit_edge(const CadModel& cad, std::size_t contour, const ScanModel& scan,
                               const ContourMotion& motion, const EdgeFitOptions& options);

/// The fitted edge at s, in the scan frame.
[[nodiscard]] Eigen::Vector3d edge_point_mm(const CadModel& cad, std::size_t contour,
                                            const ContourMotion& motion, const EdgeFit& fit, double arc_mm);

}  // namespace arris
