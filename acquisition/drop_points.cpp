#include "acquisition/drop_points.hpp"

#include <algorithm>
#include <string>

#include "acquisition/types/error.hpp"

namespace arris {

ThinnedScan drop_points(const Scan& scan, std::span<const std::int32_t> dropped) {
  std::vector<std::int32_t> now(scan.cloud.size(), 0);  // new index of each point, -1: dropped
  for (const std::int32_t i : dropped) {
    if (i < 0 || static_cast<std::size_t>(i) >= now.size())
      throw Error(Fault::kBug,
                  "drop_points: point " + std::to_string(i) + " of " + std::to_string(now.size()));
    now[static_cast<std::size_t>(i)] = -1;
  }
  ThinnedScan thinned{scan, {}};
  PointCloud& cloud = thinned.scan.cloud;
  cloud.points_mm.clear();
  cloud.normals.clear();
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] < 0) continue;
    now[i] = static_cast<std::int32_t>(thinned.kept.size());
    thinned.kept.push_back(static_cast<std::int32_t>(i));
    cloud.points_mm.push_back(scan.cloud.points_mm[i]);
    if (scan.cloud.has_normals()) cloud.normals.push_back(scan.cloud.normals[i]);
  }
  auto& triangles = thinned.scan.triangles;
  for (auto& triangle : triangles)
    for (std::int32_t& corner : triangle) corner = now[static_cast<std::size_t>(corner)];
  std::erase_if(triangles, [](const auto& t) { return *std::min_element(t.begin(), t.end()) < 0; });
  return thinned;
}

}  // namespace arris
