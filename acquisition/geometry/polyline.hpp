#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "acquisition/geometry/box_tree.hpp"
#include "acquisition/types/contour.hpp"

namespace arris {

/// Where a point falls on a polyline.
struct CurveFoot {
  double arc_mm = 0.0;  ///< arc length from the first point; in [0, length)
  double distance_mm = 0.0;
  int segment = -1;    ///< chord from point `segment` to the next
  double ratio = 0.0;  ///< position on that chord, 0..1
  Eigen::Vector3d foot_mm = Eigen::Vector3d::Zero();
};

/// Arc-length view of a contour: position, tangent and normal at s, nearest foot of a point.
/// Nearest foot by a BoxTree over the chords: O(log n) a query; thread-safe after construction.
class Curve {
 public:
  /// Needs at least two distinct points; throws Error(kBug) otherwise. Copies the contour.
  explicit Curve(const Contour& contour);

  [[nodiscard]] double length_mm() const { return arc_mm_.back(); }
  [[nodiscard]] bool closed() const { return contour_.closed; }
  [[nodiscard]] const Contour& contour() const { return contour_; }
  /// Arc length of point i of the contour.
  [[nodiscard]] double arc_of_point_mm(int i) const { return arc_mm_[static_cast<std::size_t>(i)]; }
  /// Brings s into [0, length) on a closed curve, clamps it to the ends of an open one.
  [[nodiscard]] double wrap_mm(double arc_mm) const;
  /// Signed shortest way along the curve from a to b; mm.
  [[nodiscard]] double arc_between_mm(double from_mm, double to_mm) const;
  [[nodiscard]] Eigen::Vector3d point_mm(double arc_mm) const;
  [[nodiscard]] Eigen::Vector3d tangent(double arc_mm) const;  ///< unit chord direction
  /// Unit; interpolated between the points; zero when the contour has none.
  [[nodiscard]] Eigen::Vector3d normal(double arc_mm) const;
  /// Ties: the lower segment. Throws Error(kBug) for a query that is not finite.
  [[nodiscard]] CurveFoot nearest(const Eigen::Vector3d& query_mm) const;
  /// The same foot if it lies nearer than reach_mm, else segment -1 and distance_mm = reach_mm; quicker, for
  /// what lies farther is not looked at. `hint`: the segment of an earlier answer that is likely near; it
  /// makes the search quicker and changes nothing.
  [[nodiscard]] CurveFoot nearest_within(const Eigen::Vector3d& query_mm, double reach_mm,
                                         int hint = -1) const;
  /// Whether any of it lies nearer than reach_mm: the first that does is enough, which is quicker still.
  [[nodiscard]] bool is_within(const Eigen::Vector3d& query_mm, double reach_mm) const;
  /// Distance to one of its chords.
  [[nodiscard]] double to_segment_mm(int segment, const Eigen::Vector3d& query_mm) const {
    return std::sqrt(foot_on(static_cast<std::size_t>(segment), query_mm).distance2_mm2);
  }

 private:
  struct Locus {
    std::size_t segment;
    double ratio;
  };
  struct ChordFoot {
    Eigen::Vector3d foot_mm;
    double ratio, distance2_mm2;
  };
  [[nodiscard]] ChordFoot foot_on(std::size_t segment, const Eigen::Vector3d& query_mm) const;
  [[nodiscard]] Locus locate(double arc_mm) const;
  [[nodiscard]] const Eigen::Vector3d& end_of(std::size_t segment) const;

  Contour contour_;
  std::vector<double> arc_mm_;          // arc length at each point, then the total length
  std::vector<std::int32_t> chord_at_;  // of even steps of arc: the last chord that begins at or before it
  BoxTree tree_;
};

/// Equally spaced points (first point kept), at most step_mm apart; normals interpolated and renormalised.
[[nodiscard]] Contour resample(const Contour& contour, double step_mm);

/// Radius of curvature at each point: circle fitted to the points within +-window_mm of arc (not three
/// points, whose noise a short chord magnifies); straight runs answer 1e9. A side with
/// fewer than two points in the window is represented by points of its chord. mm.
[[nodiscard]] std::vector<double> bend_radius_mm(const Contour& contour, double window_mm);

}  // namespace arris
