#pragma once

#include <vector>

#include "acquisition/geometry/polyline.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {

/// Tells whether a motion maps a whole tool path onto itself: then two poses that differ by it give the same
/// path, and neither is wrong.
class PathSymmetry {
 public:
  /// One polyline each, CAD frame; normals are the tool's axes (none: only places count).
  explicit PathSymmetry(const std::vector<Contour>& path);

  /// Whether an exact symmetry lies near `motion` (poses are found to some per cent of the path's size):
  /// every place of the path comes to lie within 0.1 mm of the path, its axis within 1 degree. By
  /// Gauss-Newton on the distances across the path. An empty path has none.
  [[nodiscard]] bool maps_onto_itself(const RigidMotion& motion) const;
  /// Farthest that `motion`, as it is, takes a place of the path from the path; mm.
  [[nodiscard]] double farthest_off_mm(const RigidMotion& motion) const;

 private:
  struct Place {
    Eigen::Vector3d tip_mm, axis;
  };
  struct Foot {
    std::size_t curve = 0;
    CurveFoot at;
  };
  /// `hint`: an earlier answer of a place that has moved a little; it changes nothing.
  [[nodiscard]] Foot nearest(const Eigen::Vector3d& p_mm, const Foot& hint) const;
  /// Whether every place lies so near the path that settling could bring it there.
  [[nodiscard]] bool may_settle(const RigidMotion& motion) const;
  /// The motion nearest to a start that lays the places on the path.
  [[nodiscard]] RigidMotion settled(RigidMotion motion) const;

  std::vector<Curve> curves_;
  std::vector<Place> places_;
  Eigen::Vector3d pivot_mm_ = Eigen::Vector3d::Zero();
  double reach_mm_ = 0.0;  ///< farthest place from the pivot
};

}  // namespace arris
