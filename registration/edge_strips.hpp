#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "registration/burr_bins.hpp"
#include "registration/carried_contour.hpp"
#include "registration/edge_claims.hpp"
#include "registration/edge_posterior.hpp"
#include "registration/edge_support.hpp"
#include "registration/seen_bins.hpp"
#include "registration/surface_pairs.hpp"

namespace arris {

/// The strips of material beside edges that the scan shows, under a surface field: which points lie how far
/// inside, where the edge was seen, and what that says about the field (EdgeSupport).
class EdgeStrips {
 public:
  static constexpr double kGateSigmas = 4.0;  ///< of a point's height: farther off it is not of the surface

  /// edges must outlive this; spacing_mm is the scan's, and it shows edges out_mm out in the void.
  EdgeStrips(const std::vector<const Curve*>& edges, const SurfaceBasis& basis, double strip_mm,
             double spacing_mm, double out_mm);

  /// Renews the strips: pairs within reach_mm of an edge carried by shift_mm and offset_mm inside that, and
  /// within gate_mm of the surface (kGateSigmas of its points); at edges that show a wall, and when walls
  /// count, half of that.
  void update(const std::vector<SurfacePair>& pairs, const std::vector<Eigen::Vector3d>& shift_mm,
              const std::vector<double>& offset_mm, double reach_mm, double gate_mm, bool walls_count,
              int threads);

  struct Point {
    std::size_t edge = 0;
    CarriedContour::Foot foot;
    double weight = 0.0;     ///< undoes the fan of a bent contour; 0: no point of a strip
    double height_mm = 0.0;  ///< above the surface, or above the edge's own where the point is beyond it
    WallPoints wall;         ///< that it may be one of
  };
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  /// Adds points [begin, end): offset_mm is how far each edge lies inside the material of the carried
  /// nominal.
  void add(std::size_t begin, std::size_t end, const std::vector<double>& offset_mm, double tau_mm,
           double stray_ratio, SurfaceSystem& system) const;

  /// The points that pull their edge outward.
  [[nodiscard]] std::vector<EdgeClaim> claims(const std::vector<double>& offset_mm, double tau_mm,
                                              double stray_ratio) const;
  /// What the points cost more at the fit moved by `move` (of the system's unknowns) than their tangents say,
  /// without some pairs.
  [[nodiscard]] double resistance(const SurfaceSystem& system, const Eigen::VectorXd& move,
                                  const std::vector<double>& offset_mm, double tau_mm, double stray_ratio,
                                  std::span<const std::size_t> without_pairs) const;
  /// Density of strays over that of the material, near the surface and beyond the edges, where there is no
  /// material: of what lies level with it farther out than half a strip, or of what stands above and below it
  /// nearer by, whichever is more.
  [[nodiscard]] double stray_ratio() const;
  /// The points that may bound an edge: near it, and those beyond it. Of an edge so dense that its mode is
  /// taken for its mean, none.
  [[nodiscard]] std::vector<EdgeSite> sites(const std::vector<double>& offset_mm, double tau_mm,
                                            double stray_ratio) const;
  /// From now on add() takes these points by their messages.
  void set_messages(const std::vector<EdgeSite>& sites);
  /// From now on this pair pulls no edge outward.
  void call_stray(std::size_t pair) { stray_[pair] = 1; }

  /// Looks for burrs, which tell nothing of where the edge is; true: other places than before.
  bool call_burrs(const std::vector<double>& offset_mm, double tau_mm);
  /// Takes so much beside each burr for one, until they are looked for again, where that leaves a third of
  /// the edge; false: there is nothing to widen.
  bool widen_burrs(double by_mm);

  /// Length of the edges, all together, and of what the scan shows of them.
  [[nodiscard]] double length_mm() const;
  [[nodiscard]] double seen_mm() const;
  /// Points level with the material beyond its edges, out to half a strip.
  [[nodiscard]] std::size_t points_beyond() const {
    return points_in_void(kNearRatio * strip_mm_, 0.5 * strip_mm_, gate_mm_);
  }

  [[nodiscard]] std::size_t size() const { return edges_.size(); }
  [[nodiscard]] const std::vector<ContourStation>& stations(std::size_t edge) const {
    return edges_[edge].stations;
  }
  /// Scale of the support at which an edge known up to a smooth shift over `share_ratio` of its length shows
  /// itself: 1 / (density * share * length), the largest over the edges.
  [[nodiscard]] double finest_tau_mm(double share_ratio) const;
  /// Greatest density of all edges, for the yardstick 1 / (density * 50 mm).
  [[nodiscard]] double greatest_density_per_mm2() const;

 private:
  static constexpr double kNearRatio = 0.2;  // of a strip: nearer by, points beyond an edge may be of it
  struct Edge {
    const Curve* curve = nullptr;
    std::vector<ContourStation> stations;
    std::vector<Eigen::Vector3d> inward;  // deformed, one a station
    SeenBins bins;
    BurrBins burrs;
  };
  [[nodiscard]] std::vector<std::optional<CarriedContour>> carry_edges(
      const std::vector<Eigen::Vector3d>& shift_mm);
  void place_points(const std::vector<SurfacePair>& pairs,
                    const std::vector<std::optional<CarriedContour>>& carried, int threads);
  /// Which points are of a strip, what they count, and what else they may be.
  void weigh_points(const std::vector<double>& offset_mm, bool walls_count);
  void find_seen(std::size_t e);
  /// Points of the cut's own wall, in line with each edge below it; 0 where there is hardly any. 1/mm^2
  [[nodiscard]] std::vector<double> wall_density_per_mm2(const std::vector<double>& offset_mm) const;
  /// Level with the material a point that high may as well be of the edge's wall.
  [[nodiscard]] WallPoints wall_points(double height_mm, double wall_per_mm2, double material_per_mm2) const;
  /// In a strip 1 mm wide all along the edge.
  [[nodiscard]] static double points_per_mm(const Edge& edge);
  /// Of each edge, when that with the fewest points is looked at with tau_mm.
  [[nodiscard]] std::vector<EdgeSupport> supports_at(double tau_mm, double stray_ratio) const;
  [[nodiscard]] double void_mm2(double from_mm, double to_mm) const;
  [[nodiscard]] std::size_t points_in_void(double from_mm, double to_mm, double height_mm) const;
  [[nodiscard]] bool counts(std::size_t point) const;
  [[nodiscard]] double inside_mm(const Point& point, const std::vector<double>& offset_mm) const;
  void set_row(const Point& point, SurfaceSystem::Row& row) const;

  std::vector<Edge> edges_;
  double strip_mm_, spacing_mm_, out_mm_;
  double reach_mm_ = 0.0, gate_mm_ = 0.0;  // of the last update
  std::vector<Point> points_;
  std::vector<char> stray_;                           // one a pair
  std::vector<std::optional<EdgeMessage>> messages_;  // one a pair, or none yet
};

}  // namespace arris
