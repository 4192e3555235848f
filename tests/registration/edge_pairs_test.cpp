#include "registration/edge_pairs.hpp"

#include <gtest/gtest.h>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

TEST(EdgePairs, NoHintChangesAnAnswerAndNearIsWhatHasAPair) {
  const CadModel cad = scenes::cad_of(scenes::fe("bracket"), {0, 1, 2, 3});
  const Eigen::Vector3d middle_mm = cad.contours[0].point_mm(0.0);
  synthetic::Random random(11);
  EdgePair last;
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d p_mm =
        middle_mm + 60.0 * Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform()) -
        Eigen::Vector3d::Constant(30.0);
    const EdgePair plain = pair_edge(cad, p_mm, 20.0), hinted = pair_edge(cad, p_mm, 20.0, last);
    EXPECT_EQ(hinted.contour, plain.contour);
    EXPECT_EQ(hinted.foot.segment, plain.foot.segment);
    EXPECT_EQ(hinted.across_mm, plain.across_mm);
    EXPECT_EQ(hinted.normal_mm, plain.normal_mm);
    EXPECT_EQ(near_contours(cad, p_mm, 20.0), plain.contour >= 0);
    found += plain.contour >= 0;
    if (plain.contour >= 0) last = plain;  // of another place: far off as a hint
  }
  EXPECT_GT(found, 100);
  EXPECT_LT(found, 990);
}

}  // namespace
}  // namespace arris
