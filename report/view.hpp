#pragma once

#include <Eigen/Core>
#include <span>

#include "report/canvas.hpp"
#include "report/run_record.hpp"

namespace arris::report {

/// Rows: right, up, towards the eye; orthonormal, in the frame of what is drawn.
using Orientation = Eigen::Matrix3d;

/// Looks against `normal`. Right is the longest direction of the points, drawn along an axis of the frame
/// when they say little or nearly that; signs by a fixed rule, so that each part of a kind is seen from the
/// same side.
[[nodiscard]] Orientation look_along(const Eigen::Vector3d& normal,
                                     std::span<const Eigen::Vector3d> points_mm);

/// The same part from the lower right: turned and tilted, so that heights show.
[[nodiscard]] Orientation look_oblique(const Orientation& along);

/// Mean normal of what is drawn of a run, CAD frame: of the contours, else the path's axes, else the CAD's
/// faces, else the plane of the scan points.
[[nodiscard]] Eigen::Vector3d mean_normal(const RunRecord& record,
                                          std::span<const Eigen::Vector3d> points_cad_mm);

/// Plane of the points: direction of least spread (unit; sign by its largest component).
[[nodiscard]] Eigen::Vector3d plane_normal(std::span<const Eigen::Vector3d> points_mm);

/// Parallel projection onto pixels.
struct View {
  Orientation orientation = Orientation::Identity();
  double scale_px_mm = 1.0;
  Eigen::Vector2d centre_mm = Eigen::Vector2d::Zero();  ///< (right, up) at the middle of the box
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  /// x px to the right, y px downwards, depth mm towards the eye.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& p_mm) const;
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& p_mm) const { return project(p_mm).head<2>(); }
};

/// Extent of the points seen in an orientation, (right, up) mm; the outermost 0.2 % on each side may stick
/// out.
struct Extent {
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();
  bool empty = true;
  void include(const Eigen::Vector2d& p);
  [[nodiscard]] Eigen::Vector2d size() const {
    return empty ? Eigen::Vector2d(1.0, 1.0) : Eigen::Vector2d(high - low);
  }
};
[[nodiscard]] Extent extent_of(const Orientation& orientation, std::span<const Eigen::Vector3d> points_mm);

/// The view that shows an extent as large as fits into a box, with a margin around it.
[[nodiscard]] View fit_view(const Orientation& orientation, const Extent& extent, const Box& box,
                            double margin_px);

}  // namespace arris::report
