#include "registration/whole_fit.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "fixtures/synthetic/big_panel.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

constexpr double kSameMm = 0.01, kSameRad = 0.005 * std::numbers::pi / 180.0;

class WholeFitOfPanel : public testing::Test {
 protected:
  TriangleMesh mesh_ = synthetic::big_panel(12.0);
  SurfaceQuery surface_{mesh_};
};

TEST_F(WholeFitOfPanel, FindsThePoseFromTwoDegreesAndTenMillimetresOff) {
  synthetic::Random random(1);
  for (int i = 0; i < 5; ++i) {
    const RigidMotion truth = scenes::disturbance(random, {0, 0, 0}, 3.0, 500.0);
    const RigidMotion start = truth * scenes::disturbance(random, {0, 0, 0}, 0.035, 10.0);
    const auto points = synthetic::scan_of(mesh_, 60000, 0.05, truth, 2);
    const WholeFit fit = fit_whole(surface_, points, start, {});
    ASSERT_TRUE(fit.usable()) << fit.reason;
    EXPECT_LT((fit.scan_from_cad.translation() - truth.translation()).norm(), kSameMm);
    EXPECT_LT(rotation_between_rad(fit.scan_from_cad, truth), kSameRad);
    EXPECT_NEAR(fit.rms_mm, 0.05, 0.01) << "the noise is left";
    EXPECT_TRUE(fit.free_directions.empty());
  }
}

TEST_F(WholeFitOfPanel, ShuffledPointsAndStraysMoveItLittle) {
  auto points = synthetic::scan_of(mesh_, 60000, 0.05, RigidMotion::Identity(), 3);
  synthetic::Random random(4);
  for (std::size_t i = 0; i < points.size(); i += 5)
    points[i] += Eigen::Vector3f(0, 0, static_cast<float>(random.uniform(0.0, 20.0)));
  synthetic::shuffle(points, 5);
  const RigidMotion start = scenes::disturbance(random, {0, 0, 0}, 0.035, 10.0);
  const WholeFit fit = fit_whole(surface_, points, start, {});
  ASSERT_TRUE(fit.usable()) << fit.reason;
  EXPECT_LT(fit.scan_from_cad.translation().norm(), kSameMm);
  EXPECT_LT(rotation_between_rad(fit.scan_from_cad, RigidMotion::Identity()), kSameRad);
}

TEST_F(WholeFitOfPanel, SameBytesForAnyThreadCount) {
  const auto points = synthetic::scan_of(mesh_, 60000, 0.05, RigidMotion::Identity(), 6);
  synthetic::Random random(7);
  const RigidMotion start = scenes::disturbance(random, {0, 0, 0}, 0.035, 10.0);
  const auto with = [&](int threads) {
    WholeFitOptions options;
    options.threads = threads;
    return fit_whole(surface_, points, start, options).scan_from_cad.matrix().eval();
  };
  const Eigen::Matrix4d one = with(1);
  EXPECT_EQ(one, with(2));
  EXPECT_EQ(one, with(8));
}

TEST_F(WholeFitOfPanel, RefusesAScanThatIsElsewhere) {
  auto points = synthetic::scan_of(mesh_, 5000, 0.05, RigidMotion::Identity(), 8);
  for (Eigen::Vector3f& p : points) p.z() += 500.0F;
  const WholeFit fit = fit_whole(surface_, points, RigidMotion::Identity(), {});
  EXPECT_FALSE(fit.usable());
  EXPECT_FALSE(fit_whole(surface_, {}, RigidMotion::Identity(), {}).usable());
}

TEST(WholeFit, NamesWhatAFlatSheetLeavesFree) {
  const synthetic::PlatePart plate(synthetic::plate_with_circle(60.0));
  const TriangleMesh mesh = plate.cad_mesh(20.0);
  const auto points = synthetic::scan_of(mesh, 20000, 0.02, RigidMotion::Identity(), 9);
  RigidMotion start = RigidMotion::Identity();
  start.translation().z() = 3.0;
  const WholeFit fit = fit_whole(SurfaceQuery(mesh), points, start, {});
  ASSERT_TRUE(fit.usable()) << fit.reason;
  EXPECT_EQ(fit.free_directions.size(), 3U) << "two slides and a turn";
  EXPECT_LT(fit.scan_from_cad.translation().norm(), kSameMm) << "and does not move along them";
}

}  // namespace
}  // namespace arris
