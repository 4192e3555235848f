#include "toolpath/toolpath.hpp"

namespace arris {

std::vector<PathRange> polylines(const ToolPath& path) {
  std::vector<PathRange> ranges;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    if (i == 0 || path.points[i].path != path.points[i - 1].path)
      ranges.push_back({i, i, path.points[i].closed});
    ranges.back().end = i + 1;
  }
  return ranges;
}

std::vector<double> arc_along_mm(const ToolPath& path) {
  std::vector<double> arc_mm(path.points.size(), 0.0);
  for (const PathRange& range : polylines(path))
    for (std::size_t i = range.begin + 1; i < range.end; ++i)
      arc_mm[i] = arc_mm[i - 1] + (path.points[i].tip_mm - path.points[i - 1].tip_mm).norm();
  return arc_mm;
}

std::vector<Eigen::Vector3d> directions(const ToolPath& path) {
  std::vector<Eigen::Vector3d> along(path.points.size(), Eigen::Vector3d::Zero());
  for (const PathRange& range : polylines(path)) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::size_t before = i > range.begin ? i - 1 : (range.closed ? range.end - 1 : i);
      const std::size_t after = i + 1 < range.end ? i + 1 : (range.closed ? range.begin : i);
      const Eigen::Vector3d step_mm = path.points[after].tip_mm - path.points[before].tip_mm;
      if (step_mm.norm() > 1e-9) along[i] = step_mm.normalized();
    }
  }
  return along;
}

}  // namespace arris
