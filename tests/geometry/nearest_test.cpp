#include "acquisition/geometry/nearest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "acquisition/types/error.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

using testing::random_cube_mm;

// The twin: every point, sorted by distance, then by index.
std::vector<Neighbour> by_brute_force(const std::vector<Eigen::Vector3d>& points_mm,
                                      const Eigen::Vector3d& query_mm) {
  std::vector<Neighbour> all;
  for (std::size_t i = 0; i < points_mm.size(); ++i)
    all.push_back({static_cast<std::int32_t>(i), (points_mm[i] - query_mm).squaredNorm()});
  std::sort(all.begin(), all.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.distance2_mm2 != b.distance2_mm2 ? a.distance2_mm2 < b.distance2_mm2 : a.index < b.index;
  });
  return all;
}

// Sets that are easy, flat, on a lattice full of ties, doubled, and far from the origin.
std::vector<std::vector<Eigen::Vector3d>> point_sets() {
  std::vector<std::vector<Eigen::Vector3d>> sets{random_cube_mm(700, 50.0, 1)};
  sets.push_back(random_cube_mm(500, 50.0, 2));
  for (Eigen::Vector3d& p_mm : sets.back()) p_mm.z() = 0.0;
  sets.emplace_back();
  for (int x = 0; x < 9; ++x)
    for (int y = 0; y < 9; ++y)
      for (int z = 0; z < 9; ++z) sets.back().emplace_back(x, y, z);
  sets.push_back(sets.front());
  sets.back().insert(sets.back().end(), sets.front().begin(), sets.front().end());
  sets.push_back(random_cube_mm(300, 50.0, 3));
  for (Eigen::Vector3d& p_mm : sets.back()) p_mm += Eigen::Vector3d(4e5, -5e6, 1e4);
  sets.emplace_back(40, Eigen::Vector3d(1.0, 2.0, 3.0));
  sets.push_back({Eigen::Vector3d(1.0, 2.0, 3.0)});
  return sets;
}

std::vector<Eigen::Vector3d> queries_for(const std::vector<Eigen::Vector3d>& points_mm) {
  std::vector<Eigen::Vector3d> queries_mm = random_cube_mm(60, 60.0, 9);
  for (Eigen::Vector3d& q_mm : queries_mm) q_mm += points_mm.front();
  for (std::size_t i = 0; i < points_mm.size(); i += 11) queries_mm.push_back(points_mm[i]);
  for (int i = 0; i < 20; ++i)
    queries_mm.emplace_back(0.5 * i, 4.5, 0.25 * i);  // halfway between lattice points
  return queries_mm;
}

TEST(Nearest, IsTheBruteForceAnswerTiesByIndex) {
  for (const auto& points_mm : point_sets()) {
    const NearestPoints tree(points_mm);
    for (const Eigen::Vector3d& query_mm : queries_for(points_mm)) {
      const Neighbour twin = by_brute_force(points_mm, query_mm).front();
      const Neighbour found = tree.nearest(query_mm);
      EXPECT_EQ(found.distance2_mm2, twin.distance2_mm2);
      EXPECT_EQ(found.index, twin.index);
    }
  }
}

TEST(Nearest, KAreTheBruteForceAnswerInOrder) {
  std::vector<Neighbour> found;
  for (const auto& points_mm : point_sets()) {
    const NearestPoints tree(points_mm);
    for (const Eigen::Vector3d& query_mm : queries_for(points_mm)) {
      const std::vector<Neighbour> twin = by_brute_force(points_mm, query_mm);
      for (const int k : {1, 2, 7, 30}) {
        tree.nearest_k(query_mm, k, found);
        ASSERT_EQ(found.size(), std::min<std::size_t>(static_cast<std::size_t>(k), points_mm.size()));
        for (std::size_t i = 0; i < found.size(); ++i) {
          EXPECT_EQ(found[i].distance2_mm2, twin[i].distance2_mm2);
          EXPECT_EQ(found[i].index, twin[i].index);
        }
      }
    }
  }
}

TEST(Nearest, WithinARadiusIsTheBruteForceAnswerBorderIncluded) {
  std::vector<Neighbour> found;
  for (const auto& points_mm : point_sets()) {
    const NearestPoints tree(points_mm);
    for (const Eigen::Vector3d& query_mm : queries_for(points_mm)) {
      std::vector<Neighbour> twin = by_brute_force(points_mm, query_mm);
      for (const double radius_mm : {0.0, 1.0, 2.0, 12.5}) {
        tree.within(query_mm, radius_mm, found);
        const auto beyond = std::find_if(twin.begin(), twin.end(), [&](const Neighbour& n) {
          return n.distance2_mm2 > radius_mm * radius_mm;
        });
        ASSERT_EQ(found.size(), static_cast<std::size_t>(beyond - twin.begin()));
        for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].index, twin[i].index);
      }
    }
  }
}

TEST(Nearest, AnswersNothingWhenThereIsNothing) {
  const NearestPoints tree({});
  std::vector<Neighbour> found{{3, 1.0}};
  EXPECT_EQ(tree.size(), 0U);
  EXPECT_EQ(tree.nearest(Eigen::Vector3d::Zero()).index, -1);
  tree.nearest_k(Eigen::Vector3d::Zero(), 3, found);
  EXPECT_TRUE(found.empty());
  tree.within(Eigen::Vector3d::Zero(), 1e9, found);
  EXPECT_TRUE(found.empty());
}

TEST(Nearest, RefusesNonsense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector3d> points_mm{Eigen::Vector3d::Zero(), Eigen::Vector3d(nan, 0.0, 0.0)};
  EXPECT_THROW(NearestPoints{points_mm}, Error);
  const NearestPoints tree{std::span<const Eigen::Vector3d>(points_mm).first(1)};
  std::vector<Neighbour> found;
  EXPECT_EQ(tree.nearest(Eigen::Vector3d(nan, 0.0, 0.0)).index, -1);
  tree.nearest_k(Eigen::Vector3d::Zero(), 0, found);
  EXPECT_TRUE(found.empty());
  tree.within(Eigen::Vector3d::Zero(), -1.0, found);
  EXPECT_TRUE(found.empty());
}

TEST(Nearest, KeepsItsOwnCopyOfThePoints) {
  auto points_mm = std::make_unique<std::vector<Eigen::Vector3d>>(random_cube_mm(200, 10.0, 4));
  const std::vector<Eigen::Vector3d> same_mm = *points_mm;
  NearestPoints tree(*points_mm);
  std::fill(points_mm->begin(), points_mm->end(), Eigen::Vector3d::Zero());
  points_mm.reset();
  const NearestPoints moved = std::move(tree);
  for (std::size_t i = 0; i < same_mm.size(); ++i)
    EXPECT_EQ(moved.nearest(same_mm[i]).index, static_cast<std::int32_t>(i));
}

}  // namespace
}  // namespace arris
