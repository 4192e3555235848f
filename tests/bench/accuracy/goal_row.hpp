#pragma once

#include <string>
#include <vector>

namespace arris::bench {

/// One stated figure and what was reached.
struct GoalRow {
  std::string what, part;
  std::string goal = {}, reached = {}, worst = {};  ///< `worst`: the worst accepted scan
  std::size_t scans = 0;
  std::size_t within = 0;   ///< scans that reach the figure by themselves; a refused one does not
  std::size_t refused = 0;  ///< scans refused that should not be (accepted that should not be)
  bool met = false;
  std::vector<std::string> notes = {};  ///< of refused scans: the reasons
};

/// The rows as Markdown, with a heading line.
[[nodiscard]] std::string goal_table(const std::vector<GoalRow>& rows);

/// The notes of the rows, each distinct one once, as a list; empty without any.
[[nodiscard]] std::string notes_list(const std::vector<GoalRow>& rows);

/// A mean and a peak error, in mm.
struct MeanMax {
  double mean_mm = 0.0, max_mm = 0.0;
  [[nodiscard]] bool within(const MeanMax& limit) const {
    return mean_mm <= limit.mean_mm && max_mm <= limit.max_mm;
  }
};
/// "0.012 / 0.034 mm".
[[nodiscard]] std::string text_of(const MeanMax& error);
/// The middle of the mean and of the peak errors over all scans, of which refused ones are worse than any.
[[nodiscard]] MeanMax medians(const std::vector<MeanMax>& accepted, std::size_t scans);
/// Errors of the accepted scans of a row against one limit, the refused ones missing it: fills in reached,
/// worst, counts and met (the mean over the scans within the limit, and none refused).
void judge(GoalRow& row, const std::vector<MeanMax>& accepted, std::size_t refused, const MeanMax& limit);

}  // namespace arris::bench
