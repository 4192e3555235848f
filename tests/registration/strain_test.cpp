// The mean strain along the contour, on the face and at the mid-surface, against the solved shape.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

/// Lengthening of the opening's rim at a depth below the face, from the truth alone.
double true_strain(const synthetic::Part& part, double depth_mm) {
  const std::vector<synthetic::EdgePoint> edge = part.edge(0, 0.5);
  double nominal_mm = 0.0, real_mm = 0.0;
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const synthetic::EdgePoint &a = edge[i], &b = edge[(i + 1) % edge.size()];
    nominal_mm +=
        ((b.nominal_mm - depth_mm * b.nominal_normal) - (a.nominal_mm - depth_mm * a.nominal_normal)).norm();
    real_mm += ((b.true_mm - depth_mm * b.true_normal) - (a.true_mm - depth_mm * a.true_normal)).norm();
  }
  return real_mm / nominal_mm - 1.0;
}

Registration registered(const synthetic::Part& part, const synthetic::ScanOptions& scanning,
                        double mid_depth_mm) {
  scenes::Trial trial = scenes::trial_of(part, scanning, 5);
  const CadModel cad = scenes::cad_of(part);
  RegistrationOptions options;
  options.mid_depth_mm = mid_depth_mm;
  return register_part(cad, trial.scan, options);
}

TEST(Strain, SheetOverASupportStretchesItsFaceAndNotItsMiddle) {
  const synthetic::FePart part = scenes::fe("sheet");
  const double depth_mm = 0.5 * part.thickness_mm();
  synthetic::ScanOptions scanning;
  scanning.points = 12000;
  const Registration found = registered(part, scanning, depth_mm);
  ASSERT_TRUE(found.usable());
  EXPECT_NEAR(found.face_strain_ratio, true_strain(part, 0.0), found.strain_limit_ratio);
  EXPECT_NEAR(found.mean_strain_ratio, true_strain(part, depth_mm), found.strain_limit_ratio);
  const double bending = true_strain(part, 0.0) - true_strain(part, depth_mm);
  EXPECT_NEAR(found.face_strain_ratio - found.mean_strain_ratio, bending, 0.15 * std::abs(bending));
}

TEST(Strain, ThickBentPlateGrowsOnItsFaceAlone) {
  synthetic::PlateShape shape = synthetic::plate_with_circle();
  shape.thickness_mm = 10.0;
  shape.bend_curvature_per_mm = 1.0 / 1200.0;
  const synthetic::PlatePart part(shape);
  const Registration found = registered(part, {}, 5.0);
  ASSERT_TRUE(found.usable());
  const double bending = true_strain(part, 0.0) - true_strain(part, 5.0);
  EXPECT_GT(bending, 0.001);
  EXPECT_NEAR(found.face_strain_ratio - found.mean_strain_ratio, bending, 0.15 * bending);
  EXPECT_NEAR(found.mean_strain_ratio, 0.0, found.strain_limit_ratio);
}

}  // namespace
}  // namespace arris
