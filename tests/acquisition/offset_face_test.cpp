// Faces moved through a sheet: closed forms on a plane and on a cylinder shell.
#include "acquisition/offset_face.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquisition/contour_extract.hpp"
#include "acquisition/types/error.hpp"
#include "fixtures/synthetic/analytic_part.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr double kCreaseRad = 0.52;
constexpr double kRadiusMm = 100.0;
constexpr double kMovedMm = 0.003;  // of a vertex from its closed form, 10 mm away

/// A point of the plane rolled up, at a height above the cylinder.
Vector3d rolled(double x_mm, double y_mm, double height_mm) {
  const double r_mm = kRadiusMm + height_mm, phi = x_mm / kRadiusMm;
  return {r_mm * std::sin(phi), y_mm, r_mm * std::cos(phi)};
}

/// A plate with openings whose uneven mesh, fans at the rims included, is rolled onto a cylinder.
struct Shell {
  TriangleMesh flat, drawn;
  Shell() {
    synthetic::PlateShape shape = synthetic::asymmetric_plate();
    flat = synthetic::PlatePart(shape).cad_mesh(8.0);
    drawn = flat;
    for (Vector3d& v : drawn.vertices_mm) v = rolled(v.x(), v.y(), 0.0);
  }
  [[nodiscard]] double worst_mm(const OffsetFace& face, double height_mm) const {
    double worst = 0.0;
    for (std::size_t v = 0; v < flat.vertices_mm.size(); ++v) {
      const Vector3d& p = flat.vertices_mm[v];
      worst = std::max(worst, (face.mesh.vertices_mm[v] - rolled(p.x(), p.y(), height_mm)).norm());
    }
    return worst;
  }
};

std::vector<Contour> loops_of(const TriangleMesh& mesh) {
  std::vector<Contour> loops;
  for (const FoundContour& found : mesh_contours(mesh, {}).found) loops.push_back(found.contour);
  return loops;
}

TEST(OffsetFace, CylinderShellMovesToItsClosedFormRimsIncluded) {
  const Shell shell;
  for (const double height_mm : {10.0, -10.0, 5.0, -5.0}) {
    const OffsetFace face = offset_face(shell.drawn, height_mm, kCreaseRad);
    EXPECT_LT(shell.worst_mm(face, height_mm), kMovedMm) << height_mm;
  }
}

TEST(OffsetFace, ThereAndBackIsTheSameFace) {
  const Shell shell;
  const OffsetFace there = offset_face(shell.drawn, 10.0, kCreaseRad);
  EXPECT_LT(shell.worst_mm(offset_face(there.mesh, -10.0, kCreaseRad), 0.0), kMovedMm);
}

TEST(OffsetFace, ThicknessBeyondTheBendRadiusIsRefused) {
  const Shell shell;
  for (const double height_mm : {-95.0, -100.0, -130.0}) {
    try {
      (void)offset_face(shell.drawn, height_mm, kCreaseRad);
      FAIL() << height_mm;
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::kInput);
      EXPECT_NE(std::string(error.what()).find("thicker than its drawing can be bent"), std::string::npos);
    }
  }
  EXPECT_NO_THROW((void)offset_face(shell.drawn, 130.0, kCreaseRad));  // outwards there is room
}

TEST(OffsetFace, LoopsKeepTheirRimAndTheirMaterialOnTheLeft) {
  const Shell shell;
  const std::vector<Contour> drawn = loops_of(shell.drawn);
  const OffsetFace far = turned(offset_face(shell.drawn, -10.0, kCreaseRad));
  const std::vector<Contour> moved = contours_on(far, shell.drawn, drawn);
  const std::vector<Contour> found = loops_of(far.mesh);  // the same loops, searched for on the moved mesh
  ASSERT_EQ(moved.size(), found.size());
  for (const Contour& contour : moved) {
    bool same = false;
    for (const Contour& other : found) {
      const auto at = std::find(other.points_mm.begin(), other.points_mm.end(), contour.points_mm[0]);
      if (at == other.points_mm.end()) continue;
      same = other.points_mm.size() == contour.points_mm.size();
      const auto first = static_cast<std::size_t>(at - other.points_mm.begin());
      for (std::size_t i = 0; same && i < contour.points_mm.size(); ++i)
        same = other.points_mm[(first + i) % contour.points_mm.size()] == contour.points_mm[i];
    }
    EXPECT_TRUE(same) << "contour " << contour.id;
    for (const Vector3d& n : contour.normals) EXPECT_NEAR(n.norm(), 1.0, 1e-9);
    const Vector3d& p = contour.points_mm[0];
    EXPECT_LT(contour.normals[0].dot(Vector3d(p.x(), 0.0, p.z())), 0.0);  // inwards: out of the far face
  }
}

TEST(OffsetFace, RoofKeepsItsFlatsAndNormalsAtTheCrease) {
  TriangleMesh roof;  // two flats that meet at 90 degrees: no quadric there
  for (const double y : {0.0, 10.0, 20.0})
    for (const double x : {-20.0, -10.0, 0.0, 10.0, 20.0}) roof.vertices_mm.emplace_back(x, y, -std::abs(x));
  for (std::int32_t j = 0; j < 2; ++j)
    for (std::int32_t i = 0; i < 4; ++i) {
      const std::int32_t a = 5 * j + i;
      roof.triangles.push_back({a, a + 1, a + 6});
      roof.triangles.push_back({a, a + 6, a + 5});
    }
  const std::vector<Vector3d> normals = sheet_normals(roof, kCreaseRad);
  EXPECT_LT((normals[0] - Vector3d(-1, 0, 1).normalized()).norm(), 1e-12);
  EXPECT_LT((normals[7] - Vector3d::UnitZ()).norm(), 1e-12);
}

}  // namespace
}  // namespace arris
