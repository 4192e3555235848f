#include "registration/deviation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

class DeviationOfPlate : public testing::Test {
 protected:
  synthetic::PlatePart part_{synthetic::plate_with_circle(60.0)};  // flat, 400 x 300 mm, hole about (15, -10)
  SurfaceQuery surface_{part_.cad_mesh(20.0)};
};

TEST_F(DeviationOfPlate, HasTheSignAndSizeOfTheHeightOverThePlate) {
  const std::vector<Eigen::Vector3f> points = {
      {-150, 100, 0.3F}, {-150, 100, -0.7F}, {180, -140, 2.0F}, {-100, 0, 0}};
  synthetic::Random random(1);
  for (int i = 0; i < 5; ++i) {
    const RigidMotion motion =
        i == 0 ? RigidMotion::Identity() : scenes::disturbance(random, {0, 0, 0}, 2.0, 100.0);
    std::vector<Eigen::Vector3f> scan;
    for (const Eigen::Vector3f& p : points) scan.push_back((motion * p.cast<double>()).cast<float>());
    const std::vector<float> deviation = signed_deviation_mm(surface_, motion, scan, 10.0, 1);
    for (std::size_t k = 0; k < points.size(); ++k) EXPECT_NEAR(deviation[k], points[k].z(), 1e-4) << k;
  }
}

TEST_F(DeviationOfPlate, SaysNothingBeyondBordersAndBeyondReach) {
  const std::vector<Eigen::Vector3f> points = {
      {15, -10, 0}, {15, 46, 0.1F}, {205, 0, 0.1F}, {-150, 100, 12.0F}};
  for (const float d : signed_deviation_mm(surface_, RigidMotion::Identity(), points, 10.0, 1))
    EXPECT_TRUE(std::isnan(d)) << d;
  EXPECT_TRUE(signed_deviation_mm(surface_, RigidMotion::Identity(), {}, 10.0, 1).empty());
}

TEST_F(DeviationOfPlate, SameBytesForAnyThreadCount) {
  synthetic::Random random(4);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20000; ++i)
    points.emplace_back(static_cast<float>(random.uniform(-220, 220)),
                        static_cast<float>(random.uniform(-170, 170)), static_cast<float>(random.normal()));
  const RigidMotion motion = scenes::disturbance(random, {0, 0, 0}, 0.02, 0.1);
  const std::vector<float> one = signed_deviation_mm(surface_, motion, points, 10.0, 1);
  for (const int threads : {2, 8}) {
    const std::vector<float> many = signed_deviation_mm(surface_, motion, points, 10.0, threads);
    EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(float)), 0);
  }
}

}  // namespace
}  // namespace arris
