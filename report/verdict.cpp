#include "report/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "report/number_text.hpp"

namespace arris::report {
namespace {

std::string mm(double value) {
  return fixed_text(value, 3) + " mm";
}

Judged start(double max_abs_mm, double tolerance_mm) {
  Judged judged;
  judged.value_mm = 2.0 * max_abs_mm;
  judged.tolerance_mm = tolerance_mm;
  return judged;
}

Verdict decide(double y_mm, double t_mm, double u_mm) {
  if (y_mm + u_mm <= t_mm) return Verdict::kPass;
  return y_mm - u_mm > t_mm ? Verdict::kFail : Verdict::kIndeterminate;
}

std::string reason(const Judged& judged) {
  const std::string y = mm(judged.value_mm), t = mm(judged.tolerance_mm), u = mm(judged.uncertainty_mm);
  if (!judged.uncertainty_stated)
    return "2 max|d| = " + y + (judged.verdict == Verdict::kPass ? " is within " : " is over ") + t +
           " (simple acceptance, U not stated)";
  if (judged.verdict == Verdict::kPass) return "2 max|d| = " + y + " + U " + u + " is within " + t;
  if (judged.verdict == Verdict::kFail) return "2 max|d| = " + y + " - U " + u + " is over " + t;
  return "2 max|d| = " + y + " lies within U " + u + " of the limit " + t;
}

}  // namespace

Judged judge_profile(double max_abs_mm, double tolerance_mm, std::optional<double> uncertainty_mm,
                     const std::string& what) {
  Judged judged = start(max_abs_mm, tolerance_mm);
  const std::string head = what.empty() ? "" : what + ": ";
  if (!(tolerance_mm > 0.0)) {
    judged.text = head + "no tolerance is stated";
    return judged;
  }
  judged.uncertainty_stated = uncertainty_mm.has_value();
  judged.uncertainty_mm = uncertainty_mm.value_or(0.0);
  if (!std::isfinite(max_abs_mm) || !std::isfinite(judged.uncertainty_mm)) {
    judged.verdict = Verdict::kIndeterminate;
    judged.text =
        head + (std::isfinite(max_abs_mm) ? "its uncertainty is not known" : "nothing was measured");
    return judged;
  }
  judged.verdict = decide(judged.value_mm, tolerance_mm, judged.uncertainty_mm);
  judged.text = head + reason(judged);
  return judged;
}

Judged not_judged(double max_abs_mm, double tolerance_mm, const std::string& text) {
  Judged judged = start(max_abs_mm, tolerance_mm);
  judged.text = text;
  return judged;
}

std::string verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "PASS";
    case Verdict::kFail:
      return "FAIL";
    case Verdict::kIndeterminate:
      return "INDETERMINATE";
    case Verdict::kNotJudged:
      break;
  }
  return "NOT JUDGED";
}

std::string correction_word(const RunRecord& record) {
  if (!record.accepted()) return "REFUSED";
  return record.has_toolpath ? "ACCEPTED" : "NOT ASKED FOR";
}

int run_exit_code(const RunRecord& record) {
  if (!record.accepted() || record.frame_refused()) return 5;
  switch (record.inspection_verdict()) {
    case Verdict::kFail:
      return 4;
    case Verdict::kIndeterminate:
      return 7;
    case Verdict::kPass:
    case Verdict::kNotJudged:
      break;
  }
  return 0;
}

std::vector<std::string> next_steps(const RunRecord& record) {
  std::vector<std::string> steps;
  if (!record.accepted()) {
    steps.push_back("Do not run the robot on this part: no program was written.");
    steps.push_back("Clear the first reason given, scan the part again and start the run again.");
    steps.push_back("If it is refused a second time, call the process engineer and show this page.");
    return steps;
  }
  if (record.frame_refused()) {
    steps.emplace_back("Do not run the robot on this part: where the scanner stood is not known.");
    steps.emplace_back("Clear the reason below, scan again with the fixture targets in view, run again.");
  } else if (record.program_written && record.inspection_verdict() == Verdict::kFail)
    steps.push_back("Run no program yet: whether this part is worth it is for quality to say.");
  else if (record.program_written && !permanence_warning(record).empty())
    steps.push_back("Read the warning, then run the dry-run program first, then the program.");
  else if (record.program_written)
    steps.push_back("Run the dry-run program first, then the program.");
  else if (record.has_toolpath)
    steps.push_back("The corrected path is ready, but no robot program was written.");
  switch (record.inspection_verdict()) {
    case Verdict::kFail:
      steps.push_back("Set the part aside: it is out of tolerance. Tell quality.");
      break;
    case Verdict::kIndeterminate:
      steps.push_back(
          "Too near the limit to say. Scan again with more points near the edge, or measure by hand.");
      break;
    case Verdict::kPass:
      steps.push_back("Nothing else to do for the inspection.");
      break;
    case Verdict::kNotJudged:
      steps.push_back("The shape is shown but not judged.");
      break;
  }
  return steps;
}

std::string strain_text(const RunRecord& record) {
  if (record.role == "cut") return "not measured: a contour that is still to be cut shows no stretch";
  const auto percent = [](double ratio) { return fixed_text(100.0 * ratio, 3) + " %"; };
  const std::string limit = record.strain_limit_ratio > 0.0
                                ? "; a scan this dense shows " + percent(record.strain_limit_ratio)
                                : "";
  if (!record.strain_at_mid)
    return percent(record.face_strain_ratio) +
           " on the scanned face, bending included (thickness not known)" + limit;
  return percent(record.mean_strain_ratio) + " at the mid-surface (" + percent(record.face_strain_ratio) +
         " on the scanned face)" + limit;
}

std::string permanence_warning(const RunRecord& record) {
  constexpr double kMostStrain = 0.003;
  const std::string end = ": letting the part go will not bring the contour back to the nominal one.";
  if (!record.has_toolpath) return "";
  if (record.state == "free") return "The part's shape is permanent (state = \"free\")" + end;
  const double strain = std::abs(record.mean_strain_ratio);
  if (strain <= std::max(kMostStrain, record.strain_limit_ratio)) return "";
  return "The contour is " + fixed_text(100.0 * strain, 2) + " % " +
         (record.mean_strain_ratio > 0.0 ? "longer" : "shorter") +
         " than drawn, more than 0.3 %: the part is stretched, or was not made to the drawing" + end;
}

}  // namespace arris::report
