#include "registration/shape_about.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

/// A flat plate with an opening and the field's nodes on it.
struct Plate {
  CadModel cad = scenes::cad_of(synthetic::PlatePart(synthetic::plate_with_rounded_rectangle()));
  SurfaceBasis basis{place_nodes({&cad.contours[0]}, band_cells(cad, 60.0, 12.0), 30.0)};

  /// The shape of a field f at a place of the opening's edge (inside_mm = 0) or inside the material.
  LocalShape at(double arc_mm, double inside_mm,
                const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& f) const {
    std::vector<Eigen::Vector3d> shift_mm;
    for (const Eigen::Vector3d& p : basis.nodes().points_mm) shift_mm.push_back(f(p));
    const Eigen::Vector3d foot_mm = place(arc_mm, inside_mm);
    return shape_about(cad, basis, foot_mm, basis.row(foot_mm, Eigen::Vector3d::UnitZ()), shift_mm);
  }
  Eigen::Vector3d place(double arc_mm, double inside_mm) const {
    return cad.contours[0].point_mm(arc_mm) + inside_mm * cad.inward(0, arc_mm);
  }
};

TEST(ShapeAbout, ATurnedPlateTurnsAsItDoesAtEveryEdge) {
  const Plate plate;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
  for (double arc_mm = 0.0; arc_mm < plate.cad.contours[0].length_mm(); arc_mm += 17.0)
    for (const double inside_mm : {0.0, 5.0, 25.0}) {
      const Eigen::Vector3d foot_mm = plate.place(arc_mm, inside_mm);
      const LocalShape shape = plate.at(
          arc_mm, inside_mm, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return turn * p - p; });
      const BasisRow row = plate.basis.row(foot_mm, Eigen::Vector3d::UnitZ());
      EXPECT_NEAR((shape.rotation(row) - turn).norm(), 0.0, 1e-9) << arc_mm << " " << inside_mm;
    }
}

TEST(ShapeAbout, ABentPlatesAxisIsThatOfThePlaceWithinHalfTheRing) {
  // z = c y^2 / 2: the slope across is c y. A ring cut in half by the edge tells that of its middle, at most
  // half its radius of 12 mm inside.
  const Plate plate;
  constexpr double kBendPerMm = 5e-4, kHalfRingMm = 6.0;
  for (double arc_mm = 0.0; arc_mm < plate.cad.contours[0].length_mm(); arc_mm += 17.0)
    for (const double inside_mm : {0.0, 25.0}) {
      const double y_mm = plate.place(arc_mm, inside_mm).y();
      const LocalShape shape = plate.at(arc_mm, inside_mm, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
        return {0.0, 0.0, 0.5 * kBendPerMm * p.y() * p.y()};
      });
      const double slope = -shape.normal.y() / shape.normal.z();
      EXPECT_NEAR(slope, kBendPerMm * y_mm, kBendPerMm * (inside_mm == 0.0 ? kHalfRingMm : 0.2)) << arc_mm;
    }
}

}  // namespace
}  // namespace arris
