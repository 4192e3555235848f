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

}  // namespace arris
