#include <gtest/gtest.h>

#include "report/edge_offset.hpp"

namespace arris::report {
namespace {

EdgeOffset calibrated() {
  return {true, {0.03, 0.01}, 0.5, "2026-11-20", "Hall 2", ""};
}

TEST(EdgeOffset, SaysWhatIsTakenOff) {
  EXPECT_EQ(edge_offset_text({}), "not calibrated, \u00b10.05 mm assumed");
  EXPECT_EQ(edge_offset_text(calibrated()), "calibrated 2026-11-20, +0.030 \u00b1 0.010 mm, scanner Hall 2");
  EdgeOffset inward = calibrated();
  inward.edge.out_mm = -0.03;
  inward.serial = "0042";
  EXPECT_EQ(edge_offset_text(inward),
            "calibrated 2026-11-20, \u22120.030 \u00b1 0.010 mm, scanner Hall 2 (0042)");
}

TEST(EdgeOffset, AnotherSpacingIsDoubtedBeyondAFactorOfTwo) {
  const auto notes = [](double spacing_mm) {
    return edge_offset_notes(calibrated(), spacing_mm, "2026-11-21T09:00:00Z").size();
  };
  EXPECT_EQ(notes(0.26), 0u);
  EXPECT_EQ(notes(0.99), 0u);
  EXPECT_EQ(notes(0.24), 1u);
  EXPECT_EQ(notes(1.01), 1u);
}

TEST(EdgeOffset, MoreThanAYearBeforeTheScanIsDoubted) {
  const auto notes = [](const std::string& scanned) {
    return edge_offset_notes(calibrated(), 0.5, scanned).size();
  };
  EXPECT_EQ(notes("2027-11-20T23:59:59Z"), 0u);
  EXPECT_EQ(notes("2027-11-21T00:00:00Z"), 1u);
  EXPECT_EQ(notes("2026-01-01T00:00:00Z"), 0u) << "a scan from before the calibration";
  EXPECT_TRUE(edge_offset_notes({}, 9.0, "2099-01-01T00:00:00Z").empty());
}

}  // namespace
}  // namespace arris::report
