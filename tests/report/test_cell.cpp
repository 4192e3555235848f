// The cell's fixture targets in every result: page, data, verdict.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "report/verdict.hpp"
#include "report/write_html.hpp"
#include "report/write_json.hpp"
#include "sample_record.hpp"

namespace arris::report {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CellReport, PageListsEveryTargetWithItsResidualAndLimit) {
  const std::string page = write_html(test::targets_record(false));
  EXPECT_TRUE(has(page, "Cell: the scanner's frame from fixture targets"));
  for (const char* part : {"<strong>A</strong>", "B &lt;1&gt;", "not found", "0.031", "0.200"})
    EXPECT_TRUE(has(page, part)) << part;
  EXPECT_TRUE(has(page, "<td class=\"n\">0.010</td><td class=\"n\">0.020</td><td class=\"n\">0.030</td>"));
  EXPECT_TRUE(has(page, "0.052"));
  EXPECT_FALSE(has(write_html(test::sample_record()), "fixture target"));
}

TEST(CellReport, ARefusedFrameIsFiveWithAnAcceptedCorrection) {
  const RunRecord record = test::targets_record(true);
  EXPECT_EQ(run_exit_code(record), 5);
  EXPECT_EQ(correction_word(record), "ACCEPTED");
  EXPECT_TRUE(has(next_steps(record).front(), "Do not run the robot"));
  const std::string page = write_html(record);
  EXPECT_TRUE(has(page, "Why no program was written"));
  EXPECT_TRUE(has(page, "<td class=\"out\">over</td>"));
  EXPECT_NE(run_exit_code(test::targets_record(false)), 5);
}

TEST(CellReport, DataHoldFrameCovarianceAndRows) {
  const RunRecord record = test::targets_record(false);
  const auto cell = nlohmann::json::parse(write_json(record))["cell"];
  EXPECT_TRUE(cell["solved"].get<bool>());
  EXPECT_EQ(cell["targets"].size(), 4U);
  EXPECT_TRUE(cell["targets"][3]["residual_mm"].is_null());
  EXPECT_EQ(cell["robot_from_scan"][0][3], 850.0);
  EXPECT_DOUBLE_EQ(cell["covariance_6x6"][7].get<double>(), 4e-10);
  EXPECT_EQ(cell["row_sd_robot_mm"].size(), record.correction.points.size());
  EXPECT_TRUE(cell["row_sd_robot_mm"][0]["along"].is_null());
  const auto refused = nlohmann::json::parse(write_json(test::targets_record(true)))["cell"];
  EXPECT_FALSE(refused["solved"].get<bool>());
  EXPECT_TRUE(refused["robot_from_scan"].is_null());
  EXPECT_TRUE(nlohmann::json::parse(write_json(test::sample_record()))["cell"].is_null());
}

}  // namespace
}  // namespace arris::report
