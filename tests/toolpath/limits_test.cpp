#include "toolpath/limits.hpp"

#include <gtest/gtest.h>

#include "tests/toolpath/plate.hpp"

namespace arris {
namespace {

using test::AnyField;
using test::CylinderBend;
using test::plate_mesh;
using test::straight_path;

const RigidMotion kHome = RigidMotion::Identity();

// The plate moved along z by a function of x, without any turn.
AnyField lifted(const std::function<double(double)>& lift_mm) {
  return AnyField([lift_mm](const Eigen::Vector3d& p) {
    MappedPoint mapped;
    mapped.p_scan_mm = p + Eigen::Vector3d(0.0, 0.0, lift_mm(p.x()));
    mapped.in_domain = true;
    return mapped;
  });
}

TEST(Limits, AShiftOverTheLimitIsRefusedWithItsRowsAndNeverClipped) {
  const AnyField hump = lifted([](double x_mm) { return std::max(0.0, 23.1 - 0.003 * x_mm * x_mm); });
  const Correction correction = correct(straight_path(), SurfaceQuery(plate_mesh()), hump, kHome, {});
  ASSERT_EQ(correction.reasons.size(), 1u);
  EXPECT_EQ(correction.reasons[0], "rows 35 to 67 (s = 68.0 to 132.0 mm): shift 23.10 mm, limit 20.00 mm");
  EXPECT_FALSE(correction.accepted());
  EXPECT_NEAR(correction.points[50].shift_mm, 23.1, 1e-12);
}

TEST(Limits, AJustAllowedShiftIsAccepted) {
  const AnyField lift = lifted([](double) { return 20.0; });
  EXPECT_TRUE(correct(straight_path(), SurfaceQuery(plate_mesh()), lift, kHome, {}).accepted());
}

TEST(Limits, AJumpIsRefused) {
  const AnyField step = lifted([](double x_mm) { return x_mm > 11.0 ? 1.6 : 0.0; });
  const Correction correction = correct(straight_path(), SurfaceQuery(plate_mesh()), step, kHome, {});
  ASSERT_EQ(correction.reasons.size(), 1u);
  EXPECT_EQ(correction.reasons[0],
            "row 56 (s = 110.0 mm): the step to the next row departs by 1.6 mm from the nominal step, limit "
            "50 % of it "
            "plus 0.5 mm");
}

TEST(Limits, AFoldIsRefusedThoughItsStepsAreShort) {
  const AnyField fold([](const Eigen::Vector3d& p) {
    MappedPoint mapped;
    mapped.p_scan_mm = p;
    if (p.x() > 10.0 && p.x() < 16.0) mapped.p_scan_mm.x() = 10.0 - 0.9 * (p.x() - 10.0);
    mapped.in_domain = true;
    return mapped;
  });
  EXPECT_FALSE(correct(straight_path(), SurfaceQuery(plate_mesh()), fold, kHome, {}).accepted());
}

TEST(Limits, ATiltOverTheLimitIsRefused) {
  CorrectOptions options;
  options.max_correction_mm = 100.0;
  const Correction correction =
      correct(straight_path(), SurfaceQuery(plate_mesh()), CylinderBend(250.0), kHome, options);
  ASSERT_EQ(correction.reasons.size(), 2u);  // both ends
  EXPECT_EQ(correction.reasons[0],
            "rows 1 to 7 (s = 0.0 to 12.0 mm): axis turned by 22.9 deg, limit 20.1 deg");
}

TEST(Limits, RowsOutsideTheDomainAreRefusedAndStandWhereTheRigidMotionPutsThem) {
  const Correction correction =
      correct(straight_path(), SurfaceQuery(plate_mesh()), CylinderBend(2000.0, 90.0), kHome, {});
  ASSERT_EQ(correction.reasons.size(), 2u);
  EXPECT_EQ(correction.reasons[0],
            "rows 1 to 5 (s = 0.0 to 8.0 mm): outside the domain of the deformation field, which says "
            "nothing there");
  EXPECT_FALSE(correction.points[0].has_place);
  EXPECT_EQ(correction.points[0].point.tip_mm, straight_path().points[0].tip_mm);
}

TEST(Limits, PlacesThatAreNotFiniteAreRefused) {
  const AnyField broken = lifted([](double x_mm) { return x_mm == 0.0 ? std::nan("") : 0.0; });
  const Correction correction = correct(straight_path(), SurfaceQuery(plate_mesh()), broken, kHome, {});
  ASSERT_EQ(correction.reasons.size(), 1u);
  EXPECT_EQ(correction.reasons[0], "row 51 (s = 100.0 mm): the deformation field gives no finite place");
  for (const CorrectedPoint& row : correction.points) EXPECT_TRUE(row.point.tip_mm.allFinite());
}

TEST(Limits, AnAirMoveOverTheLimitIsRefusedToo) {
  ToolPath nominal = straight_path();
  PathPoint away = nominal.points[100];
  away.tip_mm.z() = 400.0;
  nominal.points.push_back(away);
  const Correction correction =
      correct(nominal, SurfaceQuery(plate_mesh()), CylinderBend(1000.0), kHome, CorrectOptions{});
  ASSERT_EQ(correction.reasons.size(), 1u);
  EXPECT_EQ(correction.reasons[0].substr(0, 7), "row 102");
}

TEST(Limits, PolylinesAreNamedWhenThereAreSeveralAndLongListsAreCut) {
  ToolPath nominal = straight_path();
  for (std::size_t i = 50; i <= 100; ++i) nominal.points[i].path = 2;
  const auto every = [](int n) {
    return [n](std::size_t i) {
      return static_cast<int>(i) % n == 0 ? std::optional<double>(static_cast<double>(i)) : std::nullopt;
    };
  };
  const auto say = [](double worst) { return "worst " + std::to_string(static_cast<int>(worst)); };
  const std::vector<std::string> few = list_rows(nominal, every(50), say);
  ASSERT_EQ(few.size(), 3u);
  EXPECT_EQ(few[0], "path 1, row 1 (s = 0.0 mm): worst 0");
  EXPECT_EQ(few[1], "path 2, row 51 (s = 0.0 mm): worst 50");
  const std::vector<std::string> many = list_rows(nominal, every(2), say);
  ASSERT_EQ(many.size(), 21u);
  EXPECT_EQ(many.back(), "31 more rows in 31 places: worst 100");
  EXPECT_EQ(list_rows(nominal, every(1), say).front(), "path 1, rows 1 to 50 (s = 0.0 to 98.0 mm): worst 49");
}

}  // namespace
}  // namespace arris
