#include <gtest/gtest.h>

#include <limits>

#include "report/verdict.hpp"
#include "sample_record.hpp"

namespace arris::report {
namespace {

// Binary fractions, so that "exactly at the limit" is exact: t = 1, U = 1/8, the switches lie at y = 7/8 and
// 9/8.
constexpr double kTolerance = 1.0, kU = 0.125;

Verdict at(double y_mm, std::optional<double> u_mm = kU) {
  return judge_profile(0.5 * y_mm, kTolerance, u_mm, "").verdict;
}

TEST(Verdict, SwitchesExactlyAtLimitPlusMinusU) {
  constexpr double kStep = 1.0 / 1024.0;
  for (int i = 0; i <= 2048; ++i) {
    const double y = kStep * i;
    const Verdict expected = y <= kTolerance - kU
                                 ? Verdict::kPass
                                 : (y > kTolerance + kU ? Verdict::kFail : Verdict::kIndeterminate);
    EXPECT_EQ(at(y), expected) << y;
  }
  EXPECT_EQ(at(0.875), Verdict::kPass);
  EXPECT_EQ(at(0.875 + 1e-9), Verdict::kIndeterminate);
  EXPECT_EQ(at(1.125), Verdict::kIndeterminate);
  EXPECT_EQ(at(1.125 + 1e-9), Verdict::kFail);
}

TEST(Verdict, UnknownUncertaintyIsSimpleAcceptanceAndSaysSo) {
  EXPECT_EQ(at(1.0, std::nullopt), Verdict::kPass);
  EXPECT_EQ(at(1.0 + 1e-9, std::nullopt), Verdict::kFail);
  const Judged judged = judge_profile(0.4, 1.0, std::nullopt, "edge");
  EXPECT_FALSE(judged.uncertainty_stated);
  EXPECT_NE(judged.text.find("simple acceptance, U not stated"), std::string::npos) << judged.text;
  EXPECT_EQ(judge_profile(0.4, 1.0, 0.1, "edge").text.find("simple"), std::string::npos);
}

TEST(Verdict, NothingMeasuredIsNeverAPass) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge_profile(nothing, 1.0, 0.1, "edge").verdict, Verdict::kIndeterminate);
  EXPECT_EQ(judge_profile(nothing, 1.0, std::nullopt, "edge").verdict, Verdict::kIndeterminate);
  EXPECT_EQ(judge_profile(0.1, 1.0, nothing, "edge").verdict, Verdict::kIndeterminate);
  EXPECT_EQ(judge_profile(0.1, 0.0, 0.1, "edge").verdict, Verdict::kNotJudged);
}

TEST(Verdict, ExitCodes) {
  RunRecord record;
  record.state = "clamped";
  record.judged_as_scanned.verdict = Verdict::kFail;  // as clamped: plays no part
  const std::pair<Verdict, int> kCodes[] = {
      {Verdict::kPass, 0}, {Verdict::kFail, 4}, {Verdict::kIndeterminate, 7}, {Verdict::kNotJudged, 0}};
  for (const auto& [verdict, code] : kCodes) {
    record.judged_pulled_back.verdict = verdict;
    record.refusals.clear();
    EXPECT_EQ(run_exit_code(record), code);
    record.refusals = {"overlap 0.31, at least 0.60 needed"};
    EXPECT_EQ(run_exit_code(record), 5);
  }
  record.refusals.clear();
  record.state = "free";
  EXPECT_EQ(run_exit_code(record), 4);
}

TEST(Verdict, WordsAndNextSteps) {
  const RunRecord sample = test::sample_record(), refused = test::refused_record();
  EXPECT_EQ(correction_word(sample), "ACCEPTED");
  EXPECT_EQ(correction_word(refused), "REFUSED");
  EXPECT_NE(next_steps(sample)[0].find("dry-run"), std::string::npos);
  EXPECT_NE(next_steps(refused)[0].find("no program was written"), std::string::npos);
  RunRecord inspect = sample;
  inspect.has_toolpath = inspect.program_written = false;
  EXPECT_EQ(correction_word(inspect), "NOT ASKED FOR");
}

}  // namespace
}  // namespace arris::report
