#include "registration/pose_fitness.hpp"

#include <gtest/gtest.h>

namespace arris {
namespace {

class PoseFitnessOfTwo : public testing::Test {
 protected:
  static PoseCandidate pose(double patient_mm, double shown_ratio, double against_ratio) {
    PoseCandidate made;
    made.misfit = {patient_mm, patient_mm, patient_mm, patient_mm, shown_ratio, against_ratio, 0.0, 0};
    return made;
  }
  PoseFitness fitness_{2.0, 20.0, true};  // spacing, cap
};

TEST_F(PoseFitnessOfTwo, WithoutContradictionsTheMisfitsDecide) {
  EXPECT_NEAR(fitness_.times_worse(pose(6.6, 0.7, 0.0), pose(6.0, 0.7, 0.0)), 1.1, 1e-12);
  EXPECT_NEAR(fitness_.times_worse(pose(6.0, 0.7, 0.0), pose(6.0, 0.7, 0.0)), 1.0, 1e-12);
}

TEST_F(PoseFitnessOfTwo, AFaceThatGoesOnWhereTheDrawingEndsTellsTwoPosesApart) {
  EXPECT_GT(fitness_.times_worse(pose(6.3, 0.7, 0.06), pose(6.0, 0.7, 0.0)), 1.3);
}

TEST_F(PoseFitnessOfTwo, ContradictionsOfTheBetterOneSpeakForTheOther) {
  EXPECT_LT(fitness_.times_worse(pose(6.9, 0.7, 0.0), pose(6.0, 0.7, 0.1)), 0.95);
}

TEST_F(PoseFitnessOfTwo, WhereLittleIsHiddenTheStrictMisfitCounts) {
  PoseCandidate best = pose(6.0, 0.95, 0.0), other = pose(6.1, 0.95, 0.0);
  other.misfit.strict_mm = 9.0;
  EXPECT_NEAR(fitness_.times_worse(other, best), 1.5, 1e-12);
  best.misfit.shown_ratio = 0.7;  // what it leaves may be hidden
  EXPECT_LT(fitness_.times_worse(other, best), 1.1);
}

}  // namespace
}  // namespace arris
