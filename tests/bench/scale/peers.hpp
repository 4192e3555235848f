#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tests/bench/scale/child.hpp"

namespace arris::bench {

/// CloudCompare, headless: scan and drawing read, the distance of each point to the drawing, the scan with
/// its distances written. None where it is not installed (Debian package cloudcompare).
struct CloudCompareRun {
  Child child;
  // What it prints, where it does: of the first pass, which builds the octree of the points, measures them
  // roughly and chooses the octree's level from that; of the second, the distances.
  std::optional<double> first_pass_s, distances_s;
};
[[nodiscard]] std::optional<CloudCompareRun> cloudcompare_distances(const std::filesystem::path& scan,
                                                                    const std::filesystem::path& cad);

}  // namespace arris::bench
