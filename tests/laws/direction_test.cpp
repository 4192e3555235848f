// The path goes forward: cut where the material is now, and it springs back to the drawing.
#include <gtest/gtest.h>

#include "tests/support/released.hpp"
#include "tests/support/scan_trial.hpp"

namespace arris::bench {
namespace {

const std::filesystem::path kParts = std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/fe";

TEST(ReleaseMap, CarriesEachPointOfTheTrueEdgeBackToTheDrawing) {
  const synthetic::FePart part = synthetic::load_fe_part(kParts / "porthole");
  const ReleaseMap map(part);
  for (const synthetic::EdgePoint& e : part.edge(0, 7.0))
    EXPECT_NEAR((map.released_mm(e.true_mm) - e.nominal_mm).norm(), 0.0, 1e-6);
}

TEST(ReleaseMap, UndoesItselfOffTheFaceAndBeyondItsEdge) {
  const synthetic::FePart part = synthetic::load_fe_part(kParts / "sheet");
  const ReleaseMap map(part);
  for (const synthetic::EdgePoint& e : part.edge(0, 25.0))
    for (const double across_mm : {-6.0, 0.0, 6.0})
      for (const double off_mm : {-5.0, 5.0}) {
        const Eigen::Vector3d p = e.nominal_mm + across_mm * e.nominal_void + off_mm * e.nominal_normal;
        EXPECT_NEAR((map.released_mm(map.clamped_mm(p)) - p).norm(), 0.0, 1e-3);
        const Eigen::Vector3d beyond = e.nominal_mm + 4.0 * e.nominal_void;
        EXPECT_NEAR((map.clamped_mm(beyond) - e.true_mm).norm(), 4.0, 0.05);  // strain moves no more
      }
}

/// Mean distance of a path, cut and released, from the contour of the drawing.
double released_error_mm(const BenchPart& part, const CarriedPath& path) {
  double sum_mm = 0.0;
  const auto rows = part.truth.rows(ReleaseMap(part.fe).released_mm(path.tips_mm), false);
  for (const RowError& row : rows) sum_mm += row.distance_mm;
  return sum_mm / static_cast<double>(rows.size());
}

class Direction : public testing::TestWithParam<const char*> {};

TEST_P(Direction, BackwardsIsAtLeastOneAndAHalfTimesWorseThanRigid) {
  const BenchPart part(kParts / GetParam(), 2);
  const synthetic::SyntheticScan scan = sample_scan(part.fe, {}, 1);
  ScanTrial trial(part, scan);
  ASSERT_TRUE(trial.has_pose());
  const CarriedPath rigid = trial.carried(trial.rigid().rigid.scan_from_cad);
  const auto forward = trial.chain(trial.options());
  ASSERT_TRUE(forward && forward->reasons.empty());
  const double rigid_mm = released_error_mm(part, rigid);
  EXPECT_GE(released_error_mm(part, backwards(rigid, *forward)), 1.5 * rigid_mm);
  EXPECT_LE(released_error_mm(part, *forward), 0.5 * rigid_mm);
}

INSTANTIATE_TEST_SUITE_P(Parts, Direction, testing::Values("sheet", "porthole", "nosecone"),
                         [](const auto& part) { return std::string(part.param); });

}  // namespace
}  // namespace arris::bench
