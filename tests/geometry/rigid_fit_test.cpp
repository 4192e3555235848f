#include "acquisition/geometry/rigid_fit.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "acquisition/types/error.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

using testing::Random;
using testing::random_cube_mm;
using Points = std::vector<Eigen::Vector3d>;

RigidMotion random_motion(Random& random) {
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() = Eigen::AngleAxisd(random.uniform(0.0, 3.14159), random.direction()).toRotationMatrix();
  motion.translation() = random.in_cube_mm(1000.0);
  return motion;
}

Points moved(const RigidMotion& motion, const Points& points_mm) {
  Points out;
  for (const Eigen::Vector3d& p_mm : points_mm) out.push_back(motion * p_mm);
  return out;
}

TEST(RigidFit, FindsRandomMotionsToANanometre) {
  Random random(1);
  for (unsigned trial = 0; trial < 500; ++trial) {
    const Points from_mm = random_cube_mm(3 + static_cast<int>(trial % 40), 200.0, 100 + trial);
    const RigidMotion truth = random_motion(random);
    const RigidFit fit = fit_rigid(from_mm, moved(truth, from_mm));
    ASSERT_TRUE(fit.usable()) << fit.reason;
    EXPECT_LT((fit.to_from.matrix() - truth.matrix()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT(fit.rms_mm, 1e-9);
  }
}

TEST(RigidFit, FindsHalfTurnsAndRestExactly) {
  const Points from_mm = random_cube_mm(20, 50.0, 7);
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitZ().eval()})
    for (const double angle_rad : {0.0, std::numbers::pi}) {
      RigidMotion truth = RigidMotion::Identity();
      truth.linear() = Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
      const RigidFit fit = fit_rigid(from_mm, moved(truth, from_mm));
      ASSERT_TRUE(fit.usable()) << fit.reason;
      EXPECT_LT((fit.to_from.matrix() - truth.matrix()).cwiseAbs().maxCoeff(), 1e-9);
    }
}

TEST(RigidFit, HasNoBetterNeighbour) {
  Random random(3);
  Points from_mm = random_cube_mm(30, 50.0, 8);
  Points to_mm = moved(random_motion(random), from_mm);
  for (Eigen::Vector3d& p_mm : to_mm) p_mm += random.in_cube_mm(2.0);
  const RigidFit fit = fit_rigid(from_mm, to_mm);
  ASSERT_TRUE(fit.usable());
  for (int trial = 0; trial < 200; ++trial) {
    RigidMotion nudge = RigidMotion::Identity();
    nudge.linear() = Eigen::AngleAxisd(1e-3, random.direction()).toRotationMatrix();
    nudge.translation() = random.in_cube_mm(0.01);
    double sum_mm2 = 0.0;
    for (std::size_t i = 0; i < from_mm.size(); ++i)
      sum_mm2 += (fit.to_from * (nudge * from_mm[i]) - to_mm[i]).squaredNorm();
    EXPECT_GT(std::sqrt(sum_mm2 / 30.0), fit.rms_mm);
  }
}

TEST(RigidFit, IsNeverAReflection) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Points from_mm = random_cube_mm(25, 50.0, seed);
    Points mirrored_mm = from_mm;
    for (Eigen::Vector3d& p_mm : mirrored_mm) p_mm.x() = -p_mm.x();
    const RigidFit fit = fit_rigid(from_mm, mirrored_mm);
    ASSERT_TRUE(fit.usable()) << fit.reason;
    EXPECT_NEAR(fit.to_from.linear().determinant(), 1.0, 1e-12);
    EXPECT_GT(fit.rms_mm, 1.0);
  }
}

TEST(RigidFit, TurnsAFlatPartOverRatherThanMirrorIt) {
  Points from_mm = random_cube_mm(25, 50.0, 3);
  for (Eigen::Vector3d& p_mm : from_mm) p_mm.z() = 0.0;
  Points mirrored_mm = from_mm;
  for (Eigen::Vector3d& p_mm : mirrored_mm) p_mm.x() = -p_mm.x();
  const RigidFit fit = fit_rigid(from_mm, mirrored_mm);
  ASSERT_TRUE(fit.usable()) << fit.reason;
  EXPECT_NEAR(fit.to_from.linear().determinant(), 1.0, 1e-12);
  EXPECT_LT(fit.rms_mm, 1e-9);
}

TEST(RigidFit, AWeightCountsAsThatManyPairs) {
  Random random(5);
  Points from_mm = random_cube_mm(10, 50.0, 11);
  Points to_mm = from_mm;
  for (Eigen::Vector3d& p_mm : to_mm) p_mm += random.in_cube_mm(1.0);
  std::vector<double> weights(10, 1.0);
  weights[2] = 3.0;
  weights[7] = 0.0;
  Points repeated_from_mm, repeated_to_mm;
  for (std::size_t i = 0; i < 10; ++i)
    for (int n = 0; n < static_cast<int>(weights[i]); ++n) {
      repeated_from_mm.push_back(from_mm[i]);
      repeated_to_mm.push_back(to_mm[i]);
    }
  const RigidFit weighted = fit_rigid(from_mm, to_mm, weights);
  const RigidFit repeated = fit_rigid(repeated_from_mm, repeated_to_mm);
  EXPECT_LT((weighted.to_from.matrix() - repeated.to_from.matrix()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(weighted.rms_mm, repeated.rms_mm, 1e-9);
}

TEST(RigidFit, RefusesPointsOnALineInEitherFrame) {
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d along = random.direction();
    const Eigen::Vector3d start_mm = random.in_cube_mm(1000.0);
    Points line_mm;
    for (int i = 0; i < 8; ++i) line_mm.push_back(start_mm + random.uniform(-50.0, 50.0) * along);
    const Points cube_mm = random_cube_mm(8, 50.0, 12);
    for (const RigidFit& fit :
         {fit_rigid(line_mm, line_mm), fit_rigid(cube_mm, line_mm), fit_rigid(line_mm, cube_mm)}) {
      EXPECT_FALSE(fit.usable());
      EXPECT_NE(fit.reason.find("line"), std::string::npos) << fit.reason;
    }
  }
}

TEST(RigidFit, AcceptsAThinTriangle) {
  const Points from_mm{{0.0, 0.0, 0.0}, {1000.0, 0.0, 0.0}, {500.0, 0.01, 0.0}};
  EXPECT_TRUE(fit_rigid(from_mm, from_mm).usable());
}

TEST(RigidFit, RefusesWhatDoesNotFixAMotion) {
  const Points two_mm{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  EXPECT_NE(fit_rigid(two_mm, two_mm).reason.find("3 needed"), std::string::npos);
  EXPECT_FALSE(fit_rigid({}, {}).usable());
  const Points same_mm(5, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NE(fit_rigid(same_mm, same_mm).reason.find("coincide"), std::string::npos);
  const Points cube_mm = random_cube_mm(5, 50.0, 12);
  const std::vector<double> two_weights{1.0, 0.0, 2.0, 0.0, 0.0};
  EXPECT_FALSE(fit_rigid(cube_mm, cube_mm, two_weights).usable());
  Points broken_mm = cube_mm;
  broken_mm[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(fit_rigid(broken_mm, cube_mm).reason.find("finite"), std::string::npos);
}

TEST(RigidFit, RefusesAMirroredTetrahedronThatManyTurnsFit) {
  const Points from_mm{{1.0, 1.0, 1.0}, {1.0, -1.0, -1.0}, {-1.0, 1.0, -1.0}, {-1.0, -1.0, 1.0}};
  Points inverted_mm;
  for (const Eigen::Vector3d& p_mm : from_mm) inverted_mm.push_back(-p_mm);
  EXPECT_FALSE(fit_rigid(from_mm, inverted_mm).usable());
}

TEST(RigidFit, ThrowsOnBrokenPromises) {
  const Points cube_mm = random_cube_mm(5, 50.0, 12);
  const std::vector<double> negative{1.0, 1.0, -1.0, 1.0, 1.0};
  const std::vector<double> few{1.0};
  EXPECT_THROW((void)fit_rigid(cube_mm, std::span(cube_mm).first(4)), Error);
  EXPECT_THROW((void)fit_rigid(cube_mm, cube_mm, negative), Error);
  EXPECT_THROW((void)fit_rigid(cube_mm, cube_mm, few), Error);
}

}  // namespace
}  // namespace arris
