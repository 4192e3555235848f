#pragma once

#include <string>
#include <vector>

#include "tests/bench/pose/pose_trial.hpp"

namespace arris::bench {

/// One pose of the table.
struct PoseRow {
  std::string part, scene;
  PoseTrial trial;
};

/// The whole, by part, by scene, and why poses were refused; Markdown.
[[nodiscard]] std::string pose_tables(const std::vector<PoseRow>& rows);
/// One pose in a line, for looking into what is not right.
[[nodiscard]] std::string line_of(int number, const PoseRow& row);

}  // namespace arris::bench
