// A dense scan of the finite element porthole: its rim strains and turns in ways that the priors hardly
// expect.
#include <gtest/gtest.h>

#include "cli/recipe_options.hpp"
#include "tests/support/bench_part.hpp"
#include "tests/support/coverage.hpp"

namespace arris::bench {
namespace {

TEST(StatedErrors, OfADensePortholeHoldTheTrueOnesInEveryDirectionAndItsAxesKeepTheirLimit) {
  const BenchPart part(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/fe/porthole", 2);
  synthetic::ScanOptions dense;
  dense.points = 100000;
  const synthetic::SyntheticScan scan = sample_scan(part.fe, dense, 1);
  const PointCloud cloud = scan.cloud();
  PreparedScan prepared = prepare(part, cloud);
  const RigidMotion cad_from_local = scan.scan_from_cad.inverse() * Eigen::Translation3d(cloud.offset_mm);
  const Registration found =
      register_part(part.cad, prepared.model, registration_options(part.recipe, part.threads));
  ASSERT_TRUE(found.refusals.empty());
  NominalRows nominal;
  for (const PathPoint& row : part.drawing.path.points) {
    nominal.points_mm.push_back(row.tip_mm);
    nominal.normals.push_back(row.axis);
  }
  const std::vector<StatedError> rows =
      stated_errors(part.truth, *found.field, scan, cad_from_local, nominal);
  CoverageTable table;
  table.add(rows);
  for (const StatedError::Direction direction :
       {StatedError::kNormal, StatedError::kAcross, StatedError::kAlong, StatedError::kAxis})
    EXPECT_GE(table.at(direction, false).inside_ratio(), 0.85) << "direction " << direction;
  EXPECT_LE(axis_p95_deg(rows), 0.25);  // nodes 30 mm apart leave 0.3
}

}  // namespace
}  // namespace arris::bench
