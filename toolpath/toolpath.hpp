#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace arris {

/// One row of a tool path: where the tool tip goes and where its axis points.
struct PathPoint {
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, out of the material; tool z = -axis
  int path = 1;              ///< polyline this row belongs to
  double feed_mm_s = 0.0;    ///< 0: the recipe's
  bool closed = false;       ///< of its polyline: the last point joins the first
};

/// An ordered tool path in one frame; rows of one polyline are consecutive.
struct ToolPath {
  std::vector<PathPoint> points;
  bool has_path_column = false, has_feed_column = false, has_closed_column = false;
  std::string source;  ///< file name, or "from contour 2"
};

/// First and one-past-last row of each polyline, in order.
struct PathRange {
  std::size_t begin = 0, end = 0;
  bool closed = false;
};
[[nodiscard]] std::vector<PathRange> polylines(const ToolPath& path);

}  // namespace arris
