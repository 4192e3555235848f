#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "toolpath/robot/program.hpp"
#include "toolpath/robot/reading.hpp"

namespace arris {

/// How far what was read may be from what was meant.
struct CompareOptions {
  double position_mm = 0.001;
  double turn_rad = 1.7453292e-5;  ///< 0.001 degrees
  double speed_mm_s = 0.001;
  double zone_mm = 0.001;
};

/// In what a program that was read departs from the program that was meant: frames, every move, every output
/// and wait, the error handler, both hashes. Empty when it is the same; at most 20 lines, each naming the
/// event.
[[nodiscard]] std::vector<std::string> differences(
    const Program& meant, const Reading& read, const std::function<std::string(std::string_view)>& sha256_hex,
    const CompareOptions& options = {});

}  // namespace arris
