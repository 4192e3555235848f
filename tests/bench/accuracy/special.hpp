#pragma once

#include <filesystem>
#include <vector>

#include "tests/bench/accuracy/goal_row.hpp"

namespace arris::bench {

/// How the rows beyond the usual scans of the parts are measured.
struct SpecialSetup {
  std::filesystem::path fixtures;
  int seeds = 0, threads = 0;
};

/// Role cut: porthole and sheet before their opening is cut. The whole face scanned, the outline holds the
/// part: the path is where the material is; the sheet's is a rectangle, so its pose has to be given. The band
/// alone scanned, nothing holds it: refused, and the free motion named.
[[nodiscard]] std::vector<GoalRow> cut_rows(const SpecialSetup& setup);

/// Bent plates whose hole is 0.3 mm larger, and 0.3 mm smaller, than drawn, at a spacing of 0.5 mm: the path
/// against the edge that is there, and the size error that the report states.
[[nodiscard]] std::vector<GoalRow> size_rows(const SpecialSetup& setup);

/// A bent plate of 10 mm with points on the wall of the cut, and its path on the far face, beside the same
/// seeds without walls and with the path on the scanned face.
[[nodiscard]] std::vector<GoalRow> face_rows(const SpecialSetup& setup);

/// The bracket's usual scans by an estimator that knows what no program can: the least error that they allow.
[[nodiscard]] std::vector<GoalRow> bound_rows(const SpecialSetup& setup);

/// The scans of the parts 10 m away from the origin, in files of double, against where they were.
[[nodiscard]] std::vector<GoalRow> far_rows(const SpecialSetup& setup);

/// From points in memory to the corrected path by the surface field, against the clock.
[[nodiscard]] std::vector<GoalRow> time_rows(const SpecialSetup& setup);

}  // namespace arris::bench
