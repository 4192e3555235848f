#include "acquisition/geometry/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

using testing::Random;
using Boxes = std::vector<Eigen::AlignedBox3d>;

Boxes random_boxes(int count, double spread_mm, double size_mm, unsigned seed) {
  Random random(seed);
  Boxes boxes;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d middle_mm = random.in_cube_mm(spread_mm);
    const Eigen::Vector3d half_mm = random.in_cube_mm(size_mm).cwiseAbs();
    boxes.emplace_back(middle_mm - half_mm, middle_mm + half_mm);
  }
  return boxes;
}

/// The items looked at when the limit never shrinks, sorted.
std::vector<std::int32_t> looked_at(const BoxTree& tree, const Eigen::Vector3d& query_mm, double limit_mm) {
  std::vector<std::int32_t> items;
  tree.search(query_mm, limit_mm * limit_mm, [&](std::int32_t item) {
    items.push_back(item);
    return limit_mm * limit_mm;
  });
  std::sort(items.begin(), items.end());
  return items;
}

void expect_none_hidden(const Boxes& boxes, double reach_mm, unsigned seed) {
  const BoxTree tree(boxes);
  Random random(seed);
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  if (!boxes.empty()) centre_mm = boxes.front().center();
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d query_mm = centre_mm + random.in_cube_mm(reach_mm);
    const double limit_mm = i % 5 == 0 ? 1e30 : random.uniform(0.0, reach_mm);
    const std::vector<std::int32_t> items = looked_at(tree, query_mm, limit_mm);
    EXPECT_EQ(std::adjacent_find(items.begin(), items.end()), items.end()) << "an item twice";
    for (std::size_t b = 0; b < boxes.size(); ++b)
      if (std::sqrt(boxes[b].squaredExteriorDistance(query_mm)) <= limit_mm) {
        EXPECT_TRUE(std::binary_search(items.begin(), items.end(), static_cast<std::int32_t>(b))) << b;
      }
  }
}

TEST(BoxTree, HidesNoItemWithinTheLimit) {
  for (const int count : {0, 1, 2, 3, 4, 5, 17, 400, 1025, 3000})
    expect_none_hidden(random_boxes(count, 100.0, 8.0, 1 + static_cast<unsigned>(count)), 300.0, 2);
}

TEST(BoxTree, HidesNoneFarFromTheOriginNorFarFromTheQuery) {
  Boxes boxes = random_boxes(300, 50.0, 1e-4, 3);
  for (Eigen::AlignedBox3d& box : boxes) box.translate(Eigen::Vector3d(1e6, -2e6, 3e6));
  expect_none_hidden(boxes, 80.0, 4);
  expect_none_hidden(boxes, 1e9, 5);
}

TEST(BoxTree, TakesBoxesThatNoSplitPartsAndOnesOfEverySize) {
  expect_none_hidden(Boxes(300, Eigen::AlignedBox3d(Eigen::Vector3d::Zero())), 1.0, 6);
  Boxes halving;  // each cut by area parts off one box: the deepest tree there is
  for (int i = 0; i < 900; ++i)
    halving.emplace_back(Eigen::Vector3d::Constant(std::ldexp(1.0, -i)),
                         Eigen::Vector3d::Constant(std::ldexp(1.5, -i)));
  expect_none_hidden(halving, 2.0, 7);
  const Boxes once = halving;
  for (int copy = 0; copy < 3; ++copy) halving.insert(halving.end(), once.begin(), once.end());
  expect_none_hidden(halving, 2.0, 8);
  expect_none_hidden(Boxes(3000, Eigen::AlignedBox3d(Eigen::Vector3d::Zero())), 1.0, 9);
}

TEST(BoxTree, LooksAtTheItemsThatLieExactlyAtTheLimit) {
  const Boxes boxes = {Eigen::AlignedBox3d(Eigen::Vector3d(3.0, 0.0, 0.0)),
                       Eigen::AlignedBox3d(Eigen::Vector3d(0.0, -3.0, 0.0)),
                       Eigen::AlignedBox3d(Eigen::Vector3d(0.0, 0.0, 3.1))};
  EXPECT_EQ(looked_at(BoxTree(boxes), Eigen::Vector3d::Zero(), 3.0), (std::vector<std::int32_t>{0, 1}));
}

TEST(BoxTree, IsTheSameForAnyThreadCount) {
  const Boxes boxes = random_boxes(20000, 100.0, 1.0, 10);
  const BoxTree one(boxes, 1);
  for (const int threads : {2, 8}) {
    const BoxTree many(boxes, threads);
    ASSERT_EQ(many.nodes().size(), one.nodes().size());
    EXPECT_EQ(std::memcmp(many.nodes().data(), one.nodes().data(), one.nodes().size_bytes()), 0);
    EXPECT_TRUE(std::equal(many.item_at().begin(), many.item_at().end(), one.item_at().begin()));
  }
}

TEST(BoxTree, LooksAtFewWhenTheLimitShrinks) {
  const Boxes boxes = random_boxes(20000, 100.0, 0.0, 8);
  const BoxTree tree(boxes);
  Random random(9);
  int looks = 0;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d query_mm = random.in_cube_mm(100.0);
    double best2_mm2 = 1e60;
    tree.search(query_mm, best2_mm2, [&](std::int32_t item) {
      ++looks;
      return best2_mm2 =
                 std::min(best2_mm2, boxes[static_cast<std::size_t>(item)].squaredExteriorDistance(query_mm));
    });
  }
  EXPECT_LT(looks, 20 * 1000);
}

}  // namespace
}  // namespace arris
