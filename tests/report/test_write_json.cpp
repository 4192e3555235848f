#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/result_hash.hpp"
#include "report/run_log.hpp"
#include "report/write_json.hpp"
#include "sample_record.hpp"

namespace arris::report {
namespace {

using nlohmann::json;

TEST(WriteJson, ParsesAndHoldsWhatTheRunFound) {
  const RunRecord record = test::sample_record();
  const json result = json::parse(write_json(record));
  EXPECT_EQ(result["schema"], "arris.result/1");
  EXPECT_EQ(result["result_hash"], record.result_hash);
  EXPECT_EQ(result["part"]["number"], record.part_number);
  EXPECT_EQ(result["inputs"].size(), record.inputs.size());
  EXPECT_EQ(result["verdicts"]["correction"], "ACCEPTED");
  EXPECT_EQ(result["results"]["ii_shape_as_scanned"]["judged"]["verdict"], "NOT JUDGED");
  EXPECT_EQ(result["results"]["ii_shape_as_scanned"]["deviation"]["count"], record.as_scanned.count);
  EXPECT_NEAR(result["results"]["iii_contour_pulled_back"]["judged"]["uncertainty_mm"].get<double>(), 0.12,
              1e-9);
  EXPECT_EQ(result["alignment"]["scan_from_cad"].size(), 4U);
  EXPECT_NEAR(result["alignment"]["scan_from_cad"][0][3].get<double>(), 10120.0, 1e-9);
  EXPECT_NEAR(result["alignment"]["covariance_6x6"][0].get<double>(), 1.23457e-9, 1e-15);
  EXPECT_EQ(result["registration"]["segments"].size(), 6U);
  const json& refinement = result["registration"]["refinement"];
  EXPECT_TRUE(refinement["used"].get<bool>());
  EXPECT_EQ(refinement["rounds"][0]["termination"], "iteration limit");
  EXPECT_EQ(refinement["segments"][0]["pairs"], 48);
  EXPECT_NEAR(refinement["seams"][0]["jump_after_mm"].get<double>(), 0.031, 1e-9);
  EXPECT_EQ(result["results"]["i_correction"]["path"]["points"], record.nominal_path.points.size());
  EXPECT_EQ(result["worst_points"].size(), 10U);
  EXPECT_TRUE(result["program"]["written"].get<bool>());
}

TEST(WriteJson, ProjectionHasItsBendingOnlyWhereItIsKnown) {
  RunRecord record = test::sample_record();
  EXPECT_TRUE(json::parse(write_json(record))["registration"]["projection"].empty());
  record.projection.resize(2);
  record.projection[0].model = "spline";
  record.projection[0].height_rms_mm = record.projection[0].height_max_mm = std::nan("");
  record.projection[1].model = "parabola";
  record.projection[1].height_rms_mm = 0.25;
  record.projection[1].bending = {-4e-4, 1e-6, 0.01, {1.0, 2.0, 3.0}, {0.0, 1.0, 0.0}};
  const json models = json::parse(write_json(record))["registration"]["projection"];
  EXPECT_TRUE(models[0]["height_left_rms_mm"].is_null());
  EXPECT_TRUE(models[0]["bending"].is_null());
  EXPECT_NEAR(models[1]["height_left_rms_mm"].get<double>(), 0.25, 1e-9);
  EXPECT_NEAR(models[1]["bending"]["radius_mm"].get<double>(), -1250.0, 1e-6);   // 1 / (2 alpha)
  EXPECT_NEAR(models[1]["bending"]["radius_sd_mm"].get<double>(), 3.125, 1e-6);  // radius * sd / alpha
  EXPECT_EQ(models[1]["bending"]["axis_point_cad_mm"][2], 3.0);
}

TEST(WriteJson, GapsAreNullAndNumbersRounded) {
  const json result = json::parse(write_json(test::sample_record()));
  const json& contour = result["contour_errors"]["contours"][0];
  EXPECT_TRUE(contour["before_rigid_mm"][75].is_null());
  EXPECT_TRUE(contour["before_rigid_mm"][74].is_null());
  EXPECT_FALSE(contour["before_rigid_mm"][60].is_null());
  const double value = contour["arc_mm"][1].get<double>();
  EXPECT_NEAR(value * 1e6, std::round(value * 1e6), 1e-6);
}

TEST(WriteJson, SameBytesTwiceAndNoTimes) {
  const RunRecord record = test::sample_record();
  EXPECT_EQ(write_json(record), write_json(record));
  EXPECT_EQ(write_json(record), write_json(test::sample_record()));
  EXPECT_EQ(write_json(record).find("_s\""), std::string::npos);
}

TEST(WriteJson, RefusedAndEmptyRecords) {
  const json refused = json::parse(write_json(test::refused_record()));
  EXPECT_EQ(refused["verdicts"]["exit_code"], 5);
  EXPECT_TRUE(refused["alignment"]["diagnosis_only"].get<bool>());
  const json bare = json::parse(write_json(test::barely_started_record()));
  EXPECT_TRUE(bare["results"]["ii_shape_as_scanned"]["deviation"]["mean_mm"].is_null());
  EXPECT_TRUE(bare["worst_points"].empty());
  EXPECT_TRUE(json::accept(write_json(RunRecord{})));
}

TEST(WriteJson, BrokenUtf8IsMended) {
  RunRecord record;
  record.part_number = "A\xFF\"\n";
  EXPECT_TRUE(json::accept(write_json(record)));
}

TEST(RunLog, RunJsonAndLogLines) {
  RunTimes times;
  times.run_id = "20250304-091233-7";
  times.stage_s = {{"align", 0.0123456789}, {"correct", 0.5}};
  const json run = json::parse(write_run_json(times, "abc"));
  EXPECT_EQ(run["result_hash"], "abc");
  EXPECT_NEAR(run["stage_s"][0]["wall_s"].get<double>(), 0.012346, 1e-9);

  const std::string log =
      write_log_jsonl({{"2025-03-04T09:12:33Z", 0.1, "info", "read", "two\nlines \"quoted\""},
                       {"2025-03-04T09:12:34Z", 1.1, "warning", "align", "b"}});
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 2);
  const json line = json::parse(log.substr(0, log.find('\n')));
  EXPECT_EQ(line["text"], "two\nlines \"quoted\"");
  EXPECT_EQ(write_log_jsonl({}), "");
}

TEST(CanonicalText, DependsOnWhatDecidesAndOnNothingElse) {
  RunRecord record = test::sample_record();
  const std::vector<double> field = {1.0, 2.5, -0.0};
  const std::string text = canonical_text(record, field);
  EXPECT_EQ(text.find("part7"), std::string::npos);

  RunRecord same = record;
  std::reverse(same.inputs.begin(), same.inputs.end());
  same.inputs[0].name = "renamed";
  same.report_time = "2031-01-01T00:00:00Z";
  same.alignment.scan_from_cad.translation().x() += 1e-8;
  EXPECT_EQ(canonical_text(same, std::vector<double>{1.0, 2.5, 0.0}), text);

  RunRecord other = record;
  other.inputs[0].sha256[0] = '0';
  EXPECT_NE(canonical_text(other, field), text);
  other = record;
  other.alignment.scan_from_cad.translation().x() += 1e-5;
  EXPECT_NE(canonical_text(other, field), text);
  other = record;
  other.version = "arris 0.1.1";
  EXPECT_NE(canonical_text(other, field), text);
  EXPECT_NE(canonical_text(record, std::vector<double>{1.0, 2.5}), text);
}

}  // namespace
}  // namespace arris::report
