#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace arris {

/// One row of a tool path: where the tool tip goes and where its axis points.
struct PathPoint {
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, out of the material; tool z = -axis
  int path = 1;                                     ///< polyline this row belongs to
  double feed_mm_s = 0.0;                           ///< 0: the recipe's
  bool closed = false;                              ///< of its polyline: the last point joins the first
};

/// An ordered tool path in one frame; rows of one polyline are consecutive.
struct ToolPath {
  std::vector<PathPoint> points;
  bool has_path_column = false, has_feed_column = false, has_closed_column = false;
  std::vector<std::string> columns;  ///< of the file it came from, in its order; empty: the standard order
  std::vector<long> index;           ///< the column `index` where the file has one; empty otherwise
  std::string source;                ///< file name, or "from contour 2"
};

/// First and one-past-last row of each polyline, in order.
struct PathRange {
  std::size_t begin = 0, end = 0;
  bool closed = false;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};
[[nodiscard]] std::vector<PathRange> polylines(const ToolPath& path);

/// Arc length of each row along its own polyline, from the polyline's first row; mm.
[[nodiscard]] std::vector<double> arc_along_mm(const ToolPath& path);

/// Unit direction of travel at each row: from the row before to the row after, round the seam where it is
/// closed; zero where the neighbours coincide (a polyline of one row).
[[nodiscard]] std::vector<Eigen::Vector3d> directions(const ToolPath& path);

}  // namespace arris
