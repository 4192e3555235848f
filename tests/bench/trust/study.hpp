#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/trust/study_part.hpp"
#include "tests/support/coverage.hpp"

namespace arris::bench {

/// What is wrong with a scan of the study; all at a point spacing of 0.5 mm, noise 0.05 mm.
enum class StudyCase {
  kComplete,
  kIndependent,  ///< complete, and no two points share noise: what the others' shared noise costs
  kTenMissing,
  kTwentyMissing,
  kStrays,
  kBurrs
};
inline constexpr std::array kStudyCases = {StudyCase::kComplete,   StudyCase::kIndependent,
                                           StudyCase::kTenMissing, StudyCase::kTwentyMissing,
                                           StudyCase::kStrays,     StudyCase::kBurrs};
struct StudyCaseWords {
  std::string word, name;  ///< as --only has it, and as the tables have it
};
[[nodiscard]] StudyCaseWords words_of(StudyCase study_case);

/// One scan: how far the path is from the true edge, and what the method said about that.
struct StudyOutcome {
  std::uint64_t seed = 0;
  std::string kind;
  std::vector<std::string> refusals;
  bool has_path = false;
  double rms_mm = 0.0, max_mm = 0.0, gap_rms_mm = 0.0, gap_max_mm = 0.0;  ///< gap: 0 without one
  /// In the gap, of subdivision ICP on the same scan; 0: not asked, or no path.
  double subdivision_gap_max_mm = 0.0;  ///< ours
  double paper_gap_max_mm = 0.0;        ///< with the paper's matching and stability points
  double normal_p95_deg = 0.0;
  std::vector<StatedError> rows;
};

[[nodiscard]] StudyOutcome study_scan(const StudyPart& study, StudyCase study_case, std::uint64_t seed,
                                      int threads);

}  // namespace arris::bench
