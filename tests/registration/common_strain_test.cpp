#include "registration/common_strain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/registration/sheet_plate.hpp"

namespace arris {
namespace {

/// A plate that no point was seen of: the priors, a weak pull to its place, and what strain does to it.
struct UnseenPlate : scenes::SheetPlate {
  Eigen::MatrixXd moves() const {
    SurfaceSystem system = priors(unmoved, prior);
    system.add_to_nodes(1e-6);
    return moves_by_common_strain(ground.sheet, unmoved, prior, system.dense().inverse());
  }
  std::vector<Eigen::Vector3d> shift_mm(const Eigen::VectorXd& column) const {
    std::vector<Eigen::Vector3d> shift;
    for (Eigen::Index j = 0; j < column.size(); j += 3) shift.emplace_back(column.segment<3>(j));
    return shift;
  }
};

TEST(CommonStrain, AnUnseenPlateStrainsAlikeEverywhereByThreeTimesItsPrior) {
  const UnseenPlate plate;
  const Eigen::MatrixXd moves = plate.moves();
  ASSERT_EQ(moves.cols(), 6);
  Eigen::Matrix3d second_moments = Eigen::Matrix3d::Zero();  // of strains 11, 12, 22
  for (Eigen::Index k = 0; k < moves.cols(); ++k) {
    const std::vector<Eigen::Vector3d> shift_mm = plate.shift_mm(moves.col(k));
    const Eigen::Vector3d first = plate.ground.sheet.front().mid_strain(shift_mm, 0.0);
    second_moments += first * first.transpose();
    for (const SheetCell& cell : plate.ground.sheet) {  // all frames are the same on a flat plate
      ASSERT_NEAR((cell.row().t1 - plate.ground.sheet.front().row().t1).norm(), 0.0, 1e-9);
      EXPECT_NEAR((cell.mid_strain(shift_mm, 0.0) - first).norm(), 0.0, 0.01 * plate.prior.strain_ratio);
    }
  }
  const double sd = 3.0 * plate.prior.strain_ratio;
  const Eigen::Matrix3d wanted = (sd * sd * Eigen::Vector3d(1.0, 0.5, 1.0)).asDiagonal();
  EXPECT_NEAR((second_moments - wanted).norm(), 0.0, 0.02 * sd * sd);
}

TEST(CommonStrain, WhatIsHeldDoesNotMove) {
  const UnseenPlate plate;
  SurfaceSystem held = plate.priors(plate.unmoved, plate.prior);
  held.add_to_nodes(1e12);
  const Eigen::MatrixXd moves =
      moves_by_common_strain(plate.ground.sheet, plate.unmoved, plate.prior, held.dense().inverse());
  EXPECT_LT(moves.cwiseAbs().maxCoeff(), 1e-3 * plate.moves().cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace arris
