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
  std::optional<double> distances_s;  ///< what it prints of the distances alone, where it does
};
[[nodiscard]] std::optional<CloudCompareRun> cloudcompare_distances(const std::filesystem::path& scan,
                                                                    const std::filesystem::path& cad);

}  // namespace arris::bench
