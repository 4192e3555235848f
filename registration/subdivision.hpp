#pragma once

#include <string>
#include <vector>

#include "acquisition/geometry/polyline.hpp"

namespace arris {

/// Where and how finely a contour is divided: the paper's tuning parameters by name (section 3.1).
struct SubdivisionOptions {
  double corner_radius_max_mm = 80.0;   ///< rho_T: a point that bends tighter is a corner point (H1)
  double segment_length_max_mm = 80.0;  ///< epsilon: longer pieces are divided again (H2)
  double overlap_ratio = 0.3;  ///< beta: each segment reaches beta L / 2 beyond both ends; at most 0.5
  void check() const;          ///< throws Error(kRecipe)
};

/// A piece of a contour, by arc length. On a closed contour end_mm may exceed the length (it wraps).
struct Segment {
  double begin_mm = 0.0, end_mm = 0.0;              ///< core, without overlap
  double reach_begin_mm = 0.0, reach_end_mm = 0.0;  ///< with overlap
};

/// The share of a segment in the blend at one place.
struct BlendWeight {
  int segment = 0;
  double weight = 0.0;  ///< the weights at one place sum to 1
};

/// A contour cut at its corners and then into pieces no longer than epsilon.
///   H1   points with bend radius BELOW rho_T (the printed eq. 5 selects the straight ones); a run of them is
///   a corner
///        piece, cut at both ends
///   H2   ceil(ds / epsilon) - 1 equally spaced points in a longer piece (the printed eq. 6 holds for any ds)
class Subdivision {
 public:
  Subdivision(const Curve& curve, const SubdivisionOptions& options);

  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }
  /// One or two segments with weights that sum to 1: sin^2 across the overlap of neighbours, by arc length.
  /// Repairs eq. 8: the printed sin(pi/2 d_{z+1}/d_z) is not a partition of unity (see printed_eq8).
  [[nodiscard]] std::vector<BlendWeight> weights(double arc_mm) const;
  /// Segments whose reach holds the place (one to three).
  [[nodiscard]] std::vector<int> reaching(double arc_mm) const;

 private:
  [[nodiscard]] double relative(const Segment& segment, double arc_mm) const;

  double length_mm_ = 0.0;
  bool closed_ = false;
  std::vector<Segment> segments_;
};

/// The weight as printed (eq. 8), for the study of what it does: at a quarter, half and three quarters of an
/// overlap the pair sums to -0.5, 2 and -0.5.
[[nodiscard]] double printed_eq8(double distance_own_mm, double distance_next_mm);

}  // namespace arris
