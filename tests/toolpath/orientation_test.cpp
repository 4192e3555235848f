#include "toolpath/robot/orientation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Ring {
  std::vector<Vector3d> axes, travel;
};

Ring leaning_ring(double lean) {
  Ring ring;
  for (int i = 0; i < 60; ++i) {
    const double a = 6.283185307179586 * i / 60;
    ring.axes.push_back(Vector3d(lean * std::cos(a), lean * std::sin(a), 1.0).normalized());
    ring.travel.emplace_back(-std::sin(a), std::cos(a), 0.0);
  }
  return ring;
}

double turn_rad(const Matrix3d& a, const Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle();
}

TEST(Orientation, EveryFrameIsRightHandedWithZAgainstTheAxis) {
  const Ring ring = leaning_ring(0.5);
  for (Spin spin : {Spin::kFixed, Spin::kTangent, Spin::kLeastTurn}) {
    const std::vector<Matrix3d> frames = tool_frames(ring.axes, ring.travel, spin);
    ASSERT_EQ(frames.size(), ring.axes.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_LT((frames[i].col(2) + ring.axes[i]).norm(), 1e-12);
      EXPECT_LT((frames[i].transpose() * frames[i] - Matrix3d::Identity()).norm(), 1e-12);
      EXPECT_NEAR(frames[i].determinant(), 1.0, 1e-12);
    }
  }
}

TEST(Orientation, LeastTurnTurnsNoMoreThanTheAxis) {
  const Ring ring = leaning_ring(0.5);
  const std::vector<Matrix3d> frames = tool_frames(ring.axes, ring.travel, Spin::kLeastTurn);
  for (std::size_t i = 1; i < frames.size(); ++i)
    EXPECT_NEAR(turn_rad(frames[i - 1], frames[i]), std::acos(ring.axes[i - 1].dot(ring.axes[i])), 1e-9);
}

TEST(Orientation, TangentFollowsTheTravelAndFillsWhereThereIsNone) {
  Ring ring = leaning_ring(0.0);
  ring.travel[0] = ring.travel[59] = Vector3d::UnitZ();  // down, and up again
  ring.travel[30] = Vector3d::Zero();
  const std::vector<Matrix3d> frames = tool_frames(ring.axes, ring.travel, Spin::kTangent);
  EXPECT_LT((frames[10].col(0) - ring.travel[10]).norm(), 1e-12);
  EXPECT_LT((frames[0].col(0) - ring.travel[1]).norm(), 1e-12);
  EXPECT_LT((frames[30].col(0) - ring.travel[29]).norm(), 1e-12);
  EXPECT_LT((frames[59].col(0) - ring.travel[58]).norm(), 1e-12);
}

TEST(Orientation, FixedKeepsOneDirectionEvenIfXIsTaken) {
  std::vector<Vector3d> axes;
  for (int i = 0; i < 20; ++i) axes.push_back(Vector3d(1.0, 0.02 * i, 0.0).normalized());
  const std::vector<Vector3d> travel(20, Vector3d::UnitZ());
  const std::vector<Matrix3d> frames = tool_frames(axes, travel, Spin::kFixed);
  for (const Matrix3d& frame : frames) EXPECT_GT(frame.col(0).y(), 0.8);
  const std::vector<Vector3d> all = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  EXPECT_THROW((void)tool_frames(all, all, Spin::kFixed), Error);
}

TEST(Orientation, OppositeAxesAreHalfATurnAboutX) {
  const std::vector<Vector3d> axes = {Vector3d::UnitZ(), -Vector3d::UnitZ()};
  const std::vector<Matrix3d> frames = tool_frames(axes, axes, Spin::kLeastTurn);
  EXPECT_EQ(frames[0].col(0), frames[1].col(0));
}

TEST(Orientation, NamesAreThoseOfTheRecipe) {
  EXPECT_EQ(spin_from_name("fixed"), Spin::kFixed);
  EXPECT_EQ(spin_from_name("tangent"), Spin::kTangent);
  EXPECT_EQ(spin_from_name("least_turn"), Spin::kLeastTurn);
  EXPECT_THROW((void)spin_from_name("least-turn"), Error);
}

}  // namespace
}  // namespace arris
