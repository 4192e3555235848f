// Faces of closed meshes: rims that belong together, what a scanner sees, how thick.
#include "acquisition/solid_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "acquisition/contour_extract.hpp"
#include "fixtures/synthetic/analytic_part.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr double kSharpRad = 0.52;

struct Plate {
  synthetic::PlatePart part;
  TriangleMesh solid;
  std::vector<Contour> loops;
  explicit Plate(double thickness_mm)
      : part([&] {
          synthetic::PlateShape shape = synthetic::asymmetric_plate();
          shape.thickness_mm = thickness_mm;
          return shape;
        }()),
        solid(part.solid_mesh(8.0)) {
    for (const FoundContour& found : mesh_contours(solid, {}).found) loops.push_back(found.contour);
  }
  [[nodiscard]] bool lies_at(const Contour& contour, double z_mm) const {
    return std::all_of(contour.points_mm.begin(), contour.points_mm.end(),
                       [&](const Vector3d& p) { return std::abs(p.z() - z_mm) < 1e-9; });
  }
};

double area_mm2(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += 0.5 * double_area_mm2(mesh, t).norm();
  return sum;
}

TEST(SolidFaces, EachRimHasItsPartnerStraightThroughThePlate) {
  const Plate plate(10.0);
  const SolidFaces faces(plate.solid, kSharpRad);
  int rims = 0;
  for (const Contour& contour : plate.loops) {
    const bool top = plate.lies_at(contour, 0.0), bottom = plate.lies_at(contour, -10.0);
    if (!top && !bottom) continue;  // the border of an outer wall
    ++rims;
    const Contour* partner = faces.partner_of(contour, plate.loops);
    ASSERT_NE(partner, nullptr) << contour.id;
    EXPECT_TRUE(plate.lies_at(*partner, top ? -10.0 : 0.0));
    for (const Vector3d& p : contour.points_mm) {
      const Vector3d through(p.x(), p.y(), top ? -10.0 : 0.0);
      EXPECT_TRUE(std::any_of(partner->points_mm.begin(), partner->points_mm.end(),
                              [&](const Vector3d& q) { return (q - through).norm() < 1e-9; }));
    }
    EXPECT_EQ(faces.partner_of(*partner, plate.loops)->id, contour.id);
  }
  EXPECT_EQ(rims, 2 * plate.part.contour_count());
}

TEST(SolidFaces, OnlyTheFaceOfTheRimIsSeen) {
  const Plate plate(10.0);
  const SolidFaces faces(plate.solid, kSharpRad);
  for (const Contour& contour : plate.loops) {
    if (!plate.lies_at(contour, 0.0)) continue;
    const TriangleMesh seen = faces.mesh_of(faces.visible_with({faces.face_of(contour)}, Vector3d::UnitZ()));
    for (const Vector3d& v : seen.vertices_mm) ASSERT_EQ(v.z(), 0.0);
    EXPECT_NEAR(area_mm2(seen), area_mm2(plate.part.cad_mesh(8.0)), 1e-6);
  }
}

TEST(SolidFaces, ThicknessIsMeasured) {
  for (const double thickness_mm : {2.0, 10.0, 35.0}) {
    const Plate plate(thickness_mm);
    const SolidFaces faces(plate.solid, kSharpRad);
    const auto top = std::find_if(plate.loops.begin(), plate.loops.end(),
                                  [&](const Contour& c) { return plate.lies_at(c, 0.0); });
    const SolidThickness found = faces.thickness_behind(faces.face_of(*top));
    EXPECT_TRUE(found.known);
    EXPECT_NEAR(found.median_mm, thickness_mm, 1e-9);
    EXPECT_NEAR(found.spread_mm, 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace arris
