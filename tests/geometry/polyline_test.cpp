#include "acquisition/geometry/polyline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "acquisition/types/error.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

using testing::Random;

Contour random_contour(int count, bool closed, unsigned seed) {
  Random random(seed);
  Contour contour;
  contour.id = 7;
  contour.closed = closed;
  contour.source = "test";
  Eigen::Vector3d here_mm = Eigen::Vector3d::Zero();
  for (int i = 0; i < count; ++i) {
    contour.points_mm.push_back(here_mm);
    contour.normals.push_back(random.direction());
    if (i % 9 != 8) here_mm += random.in_cube_mm(3.0);  // every ninth point is doubled
  }
  return contour;
}

Contour circle(double radius_mm, int count, bool closed = true) {
  Contour contour;
  contour.closed = closed;
  const Eigen::Vector3d u = Eigen::Vector3d(1.0, 2.0, -1.0).normalized();
  const Eigen::Vector3d v = u.unitOrthogonal();
  for (int i = 0; i < count; ++i) {
    const double turn_rad = 2.0 * std::numbers::pi * i / count;
    contour.points_mm.push_back(Eigen::Vector3d(500.0, -200.0, 90.0) +
                                radius_mm * (std::cos(turn_rad) * u + std::sin(turn_rad) * v));
    contour.normals.push_back(u.cross(v));
  }
  return contour;
}

double brute_distance_mm(const Contour& contour, const Eigen::Vector3d& q_mm) {
  double best_mm = std::numeric_limits<double>::infinity();
  const std::size_t count = contour.points_mm.size();
  for (std::size_t i = 0; i + (contour.closed ? 0 : 1) < count; ++i) {
    const Eigen::Vector3d start_mm = contour.points_mm[i];
    const Eigen::Vector3d chord_mm = contour.points_mm[(i + 1) % count] - start_mm;
    const double ratio = chord_mm.isZero(0.0)
                             ? 0.0
                             : std::clamp(chord_mm.dot(q_mm - start_mm) / chord_mm.squaredNorm(), 0.0, 1.0);
    best_mm = std::min(best_mm, (start_mm + ratio * chord_mm - q_mm).norm());
  }
  return best_mm;
}

TEST(Curve, NearestIsTheBruteForceAnswer) {
  for (const bool closed : {false, true})
    for (const int count : {2, 3, 5, 17, 400}) {
      const Contour contour = random_contour(count, closed && count > 2, static_cast<unsigned>(count));
      const Curve curve(contour);
      Random random(2);
      for (int i = 0; i < 500; ++i) {
        const Eigen::Vector3d q_mm = random.in_cube_mm(60.0);
        const CurveFoot foot = curve.nearest(q_mm);
        EXPECT_NEAR(foot.distance_mm, brute_distance_mm(contour, q_mm), 1e-12);
        EXPECT_NEAR((foot.foot_mm - q_mm).norm(), foot.distance_mm, 1e-12);
        EXPECT_LT((curve.point_mm(foot.arc_mm) - foot.foot_mm).norm(), 1e-10);
        EXPECT_GE(foot.arc_mm, 0.0);
        EXPECT_TRUE(foot.arc_mm < curve.length_mm() || !curve.closed());
      }
    }
}

TEST(Curve, NearestWithinIsTheSameFootOrNone) {
  const Curve curve(random_contour(400, true, 3));
  Random random(4);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d q_mm = random.in_cube_mm(60.0);
    const CurveFoot any = curve.nearest(q_mm), near = curve.nearest_within(q_mm, 8.0);
    const CurveFoot hinted = curve.nearest_within(q_mm, 8.0, (i * 7) % 399);  // whatever the hint is
    EXPECT_EQ(hinted.segment, near.segment);
    EXPECT_EQ(hinted.arc_mm, near.arc_mm);
    EXPECT_EQ(hinted.distance_mm, near.distance_mm);
    EXPECT_EQ(curve.is_within(q_mm, 8.0), any.distance_mm < 8.0);
    EXPECT_GE(curve.to_segment_mm((i * 7) % 399, q_mm), any.distance_mm);
    EXPECT_EQ(curve.to_segment_mm(any.segment, q_mm), any.distance_mm);
    if (any.distance_mm < 8.0) {
      ++found;
      EXPECT_EQ(near.segment, any.segment);
      EXPECT_EQ(near.arc_mm, any.arc_mm);
      EXPECT_EQ(near.distance_mm, any.distance_mm);
    } else {
      EXPECT_EQ(near.segment, -1);
      EXPECT_EQ(near.distance_mm, 8.0);
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_LT(found, 1990);
}

TEST(Curve, LengthIsTheContours) {
  for (const bool closed : {false, true})
    for (const int count : {2, 3, 40}) {
      const Contour contour = random_contour(count, closed, 3);
      EXPECT_NEAR(Curve(contour).length_mm(), length_mm(contour), 1e-10);
    }
}

TEST(Curve, ArcOfAPointLeadsBackToThePoint) {
  for (const bool closed : {false, true}) {
    const Contour contour = random_contour(60, closed, 4);
    const Curve curve(contour);
    for (int i = 0; i < 60; ++i)
      EXPECT_LT(
          (curve.point_mm(curve.arc_of_point_mm(i)) - contour.points_mm[static_cast<std::size_t>(i)]).norm(),
          1e-12);
  }
}

TEST(Curve, WrapIsPeriodicWhenClosedAndClampsWhenOpen) {
  Random random(5);
  const Curve closed(random_contour(50, true, 5));
  const Curve open(random_contour(50, false, 5));
  for (int i = 0; i < 2000; ++i) {
    const double s_mm = random.uniform(-1e4, 1e4);
    const double wrapped_mm = closed.wrap_mm(s_mm);
    EXPECT_GE(wrapped_mm, 0.0);
    EXPECT_LT(wrapped_mm, closed.length_mm());
    EXPECT_EQ(closed.wrap_mm(wrapped_mm), wrapped_mm);
    EXPECT_NEAR(std::remainder(s_mm - wrapped_mm, closed.length_mm()), 0.0, 1e-9);
    EXPECT_EQ(open.wrap_mm(s_mm), std::clamp(s_mm, 0.0, open.length_mm()));
  }
  EXPECT_EQ(closed.wrap_mm(-1e-18), 0.0);
  EXPECT_EQ(closed.wrap_mm(closed.length_mm()), 0.0);
}

TEST(Curve, WayBetweenTwoPointsLeadsThereAndIsTheShortest) {
  Random random(6);
  for (const bool is_closed : {false, true}) {
    const Curve curve(random_contour(50, is_closed, 6));
    const double length = curve.length_mm();
    for (int i = 0; i < 2000; ++i) {
      const double a_mm = random.uniform(0.0, length), b_mm = random.uniform(0.0, length);
      const double way_mm = curve.arc_between_mm(a_mm, b_mm);
      EXPECT_NEAR(curve.wrap_mm(a_mm + way_mm), b_mm, 1e-9);
      EXPECT_NEAR(curve.arc_between_mm(b_mm, a_mm), -way_mm, 1e-9);
      if (is_closed)
        EXPECT_LE(std::abs(way_mm), 0.5 * length + 1e-12);
      else
        EXPECT_EQ(way_mm, b_mm - a_mm);
    }
  }
}

TEST(Curve, TangentIsTheChordAndNormalIsBetweenItsEnds) {
  const Contour contour = random_contour(40, true, 7);
  const Curve curve(contour);
  Random random(8);
  for (int i = 0; i < 500; ++i) {
    const double s_mm = random.uniform(0.0, curve.length_mm() - 1e-6);
    EXPECT_NEAR(curve.tangent(s_mm).norm(), 1.0, 1e-12);
    EXPECT_NEAR(curve.normal(s_mm).norm(), 1.0, 1e-12);
    const Eigen::Vector3d step_mm = curve.point_mm(s_mm + 1e-7) - curve.point_mm(s_mm);
    if (step_mm.norm() < 0.999e-7) continue;  // across a corner
    EXPECT_LT((step_mm.normalized() - curve.tangent(s_mm)).norm(), 1e-5);
  }
  EXPECT_LT((curve.normal(0.0) - contour.normals.front()).norm(), 1e-12);
  Contour bare = contour;
  bare.normals.clear();
  EXPECT_EQ(Curve(bare).normal(1.0), Eigen::Vector3d::Zero());
}

TEST(Curve, RefusesWhatHasNoLength) {
  Contour contour;
  EXPECT_THROW(Curve{contour}, Error);
  contour.points_mm.assign(1, Eigen::Vector3d::Ones());
  EXPECT_THROW(Curve{contour}, Error);
  contour.points_mm.assign(4, Eigen::Vector3d::Ones());
  contour.closed = true;
  EXPECT_THROW(Curve{contour}, Error);
  contour.points_mm[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Curve{contour}, Error);
  Contour wrong = random_contour(5, false, 1);
  wrong.normals.pop_back();
  EXPECT_THROW(Curve{wrong}, Error);
  EXPECT_THROW((void)Curve(random_contour(5, false, 1)).nearest(Eigen::Vector3d::Constant(std::nan(""))),
               Error);
}

TEST(Resample, StepsAreEqualAndNoLongerThanAsked) {
  for (const bool closed : {false, true})
    for (const double step_mm : {0.05, 0.7, 1e6}) {
      const Contour contour = random_contour(50, closed, 9);
      const Curve curve(contour);
      const Contour even = resample(contour, step_mm);
      EXPECT_EQ(even.closed, closed);
      EXPECT_EQ(even.id, contour.id);
      EXPECT_EQ(even.source, contour.source);
      ASSERT_EQ(even.normals.size(), even.points_mm.size());
      EXPECT_EQ(even.points_mm.front(), contour.points_mm.front());
      const Eigen::Vector3d& end_mm = closed ? even.points_mm.back() : contour.points_mm.back();
      EXPECT_LT((even.points_mm.back() - end_mm).norm(), 1e-12);
      const double steps = static_cast<double>(even.points_mm.size()) - (closed ? 0.0 : 1.0);
      EXPECT_LE(curve.length_mm() / steps, step_mm * (1.0 + 1e-9));
      for (std::size_t i = 0; i < even.points_mm.size(); ++i)
        EXPECT_LT(
            (curve.point_mm(curve.length_mm() * static_cast<double>(i) / steps - (closed ? 0.0 : 1e-12)) -
             even.points_mm[i])
                .norm(),
            1e-9);
    }
}

TEST(Resample, KeepsTheCountWhenTheStepFitsExactly) {
  Contour line;
  line.points_mm = {{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}};
  EXPECT_EQ(resample(line, 0.1).points_mm.size(), 4U);
  EXPECT_THROW((void)resample(line, 0.0), Error);
}

TEST(BendRadius, IsTheRadiusOfACircle) {
  for (const double radius_mm : {3.0, 150.0, 4000.0})
    for (const double window_rad : {0.05, 0.5, 2.0, 10.0})
      for (const double found_mm : bend_radius_mm(circle(radius_mm, 400), window_rad * radius_mm))
        EXPECT_NEAR(found_mm / radius_mm, 1.0, 1e-6) << window_rad;
}

TEST(BendRadius, OfAStraightLineIsEndless) {
  Contour line;
  for (int i = 0; i < 50; ++i)
    line.points_mm.push_back(Eigen::Vector3d(100.0, 20.0, 3.0) + 0.7 * i * Eigen::Vector3d(0.6, 0.48, 0.64));
  for (const double radius_mm : bend_radius_mm(line, 5.0)) EXPECT_GT(radius_mm, 1e8);
  line.points_mm = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  for (const double radius_mm : bend_radius_mm(line, 5.0)) EXPECT_EQ(radius_mm, 1e9);
}

TEST(BendRadius, SurvivesNoiseThatThreePointsWouldNot) {
  Contour contour = circle(150.0, 900);
  Random random(11);
  for (Eigen::Vector3d& p_mm : contour.points_mm)
    p_mm += 0.05 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  for (const double radius_mm : bend_radius_mm(contour, 25.0)) EXPECT_NEAR(radius_mm, 150.0, 20.0);
}

TEST(BendRadius, TellsTheCornersOfASlotFromItsSides) {
  Contour slot;  // straights of 100 mm given by their ends, half circles of 10 mm given by 60 points
  slot.closed = true;
  for (const double side : {1.0, -1.0})
    for (int i = 0; i <= 60; ++i) {
      const double turn_rad = std::numbers::pi * (i / 60.0 - 0.5);
      slot.points_mm.emplace_back(side * (50.0 + 10.0 * std::cos(turn_rad)), side * 10.0 * std::sin(turn_rad),
                                  0.0);
    }
  const std::vector<double> radii_mm = bend_radius_mm(slot, 4.0);
  EXPECT_NEAR(radii_mm[30], 10.0, 1e-6);
  EXPECT_GT(radii_mm[0], 11.0);  // where the straight begins: half of the window is straight
  const std::vector<double> even_mm = bend_radius_mm(resample(slot, 1.0), 4.0);
  EXPECT_NEAR(*std::min_element(even_mm.begin(), even_mm.end()), 10.0, 0.1);
  EXPECT_GT(*std::max_element(even_mm.begin(), even_mm.end()), 1e6);
}

TEST(BendRadius, RefusesANegativeWindow) {
  EXPECT_THROW((void)bend_radius_mm(circle(1.0, 10), 0.0), Error);
}

}  // namespace
}  // namespace arris
