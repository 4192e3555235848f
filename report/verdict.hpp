#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/run_record.hpp"

namespace arris::report {

/// Judges an equally disposed profile: y = 2 max|d| against the full width t of the zone, expanded
/// uncertainty U of y.
///   PASS            y + U <= t
///   FAIL            y - U > t
///   INDETERMINATE   between the two, or nothing was measured (max_abs_mm is NaN)
///   not judged      t <= 0: no tolerance is stated
/// U unknown: simple acceptance (PASS iff y <= t), and the text says so; it is never taken for zero silently.
/// what: the beginning of the text, "found edge against nominal".
///   source  decision rule of ISO 14253-1 with guard factor 1
[[nodiscard]] Judged judge_profile(double max_abs_mm, double tolerance_mm,
                                   std::optional<double> uncertainty_mm, const std::string& what);

/// A result that is shown and, on purpose, not judged ("as clamped, not judged").
[[nodiscard]] Judged not_judged(double max_abs_mm, double tolerance_mm, const std::string& text);

[[nodiscard]] std::string verdict_word(Verdict verdict);  ///< "PASS", "FAIL", "INDETERMINATE", "NOT JUDGED"
[[nodiscard]] std::string correction_word(
    const RunRecord& record);  ///< "ACCEPTED", "REFUSED", "NOT ASKED FOR"

/// 5 refused, correction or scanner's frame (whatever the inspection says), 4 FAIL, 7 INDETERMINATE, 0
/// otherwise.
[[nodiscard]] int run_exit_code(const RunRecord& record);

/// What the operator does next, one sentence each, the first first.
[[nodiscard]] std::vector<std::string> next_steps(const RunRecord& record);

/// Why letting the part go will not bring the cut contour back to the nominal one, in words; empty when it
/// will: a permanent shape (state "free"), or more than 0.3 % strain beyond what the scan could not show
/// anyway.
[[nodiscard]] std::string permanence_warning(const RunRecord& record);

/// "0.412 % at the mid-surface (0.520 % on the scanned face); a scan this dense shows 0.050 %".
[[nodiscard]] std::string strain_text(const RunRecord& record);

}  // namespace arris::report
