#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "acquisition/contour_extract.hpp"
#include "acquisition/files/weld.hpp"
#include "fixtures/synthetic/analytic_part.hpp"
#include "tests/geometry/meshes.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

using synthetic::PlatePart;
using testing::Random;

/// Directed edges that one triangle has and no other runs back along: the border, without the code under
/// test.
std::vector<std::pair<std::int32_t, std::int32_t>> one_face_edges(const TriangleMesh& mesh) {
  std::set<std::pair<std::int32_t, std::int32_t>> directed;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) directed.emplace(t[k], t[(k + 1) % 3]);
  std::vector<std::pair<std::int32_t, std::int32_t>> border;
  for (const auto& [a, b] : directed)
    if (directed.count({b, a}) == 0) border.emplace_back(a, b);
  return border;
}

/// The sheet as a solid of the given thickness.
TriangleMesh thickened(const TriangleMesh& sheet, double thickness_mm) {
  TriangleMesh solid = sheet;
  const auto below = static_cast<std::int32_t>(sheet.vertices_mm.size());
  for (const Eigen::Vector3d& v_mm : sheet.vertices_mm)
    solid.vertices_mm.push_back(v_mm - Eigen::Vector3d(0.0, 0.0, thickness_mm));
  for (const auto& [a, b, c] : sheet.triangles) solid.triangles.push_back({a + below, c + below, b + below});
  for (const auto& [a, b] : one_face_edges(sheet)) {
    solid.triangles.push_back({b, a, a + below});
    solid.triangles.push_back({b, a + below, b + below});
  }
  return solid;
}

double true_length_mm(const synthetic::Part& part, int contour) {
  const auto curve_mm = part.nominal_curve(contour, 0.5);
  double length = 0.0;
  for (std::size_t i = 0; i < curve_mm.size(); ++i)
    length += (curve_mm[(i + 1) % curve_mm.size()] - curve_mm[i]).norm();
  return length;
}

std::size_t loops_of_length(const ContourSet& set, double length_mm) {
  return static_cast<std::size_t>(std::count_if(
      set.found.begin(), set.found.end(),
      [&](const FoundContour& found) { return std::abs(found.length_mm / length_mm - 1.0) < 0.01; }));
}

/// Loops as sets of points: independent of where a loop begins and of the order of the loops.
std::multiset<std::set<std::array<double, 3>>> loops_of(const ContourSet& set) {
  std::multiset<std::set<std::array<double, 3>>> loops;
  for (const FoundContour& found : set.found) {
    std::set<std::array<double, 3>> points;
    for (const Eigen::Vector3d& p_mm : found.contour.points_mm) points.insert({p_mm.x(), p_mm.y(), p_mm.z()});
    loops.insert(std::move(points));
  }
  return loops;
}

/// Material on the left: a step to the left of the contour's middle chords meets a triangle.
void expect_material_on_the_left(const Contour& contour, const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < contour.points_mm.size(); ++i) {
    const Eigen::Vector3d& a_mm = contour.points_mm[i];
    const Eigen::Vector3d& b_mm = contour.points_mm[(i + 1) % contour.points_mm.size()];
    const bool found = std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
      for (std::size_t k = 0; k < 3; ++k)
        if (mesh.vertices_mm[static_cast<std::size_t>(t[k])] == a_mm &&
            mesh.vertices_mm[static_cast<std::size_t>(t[(k + 1) % 3])] == b_mm)
          return true;
      return false;
    });
    EXPECT_TRUE(found) << "no triangle runs along chord " << i;
  }
}

TEST(MeshContours, OfAnOpenPlateAreItsOutlineAndItsHoles) {
  const PlatePart part(synthetic::asymmetric_plate());
  const TriangleMesh mesh = part.mesh(6.0, false);
  const ContourSet set = mesh_contours(mesh, {});
  ASSERT_EQ(set.found.size(), static_cast<std::size_t>(part.contour_count()));
  EXPECT_TRUE(set.notes.empty());
  for (int c = 0; c < part.contour_count(); ++c)
    EXPECT_EQ(loops_of_length(set, true_length_mm(part, c)), 1U) << c;
  std::size_t points = 0;
  for (const FoundContour& found : set.found) {
    EXPECT_TRUE(found.contour.closed);
    EXPECT_EQ(found.contour.source, "boundary");
    EXPECT_EQ(found.closing_gap_mm, 0.0);
    points += found.contour.points_mm.size();
    for (const Eigen::Vector3d& n : found.contour.normals)
      EXPECT_LT((n - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  }
  EXPECT_EQ(points, one_face_edges(mesh).size());
  for (std::size_t c = 0; c < set.found.size(); ++c) {
    EXPECT_EQ(set.found[c].contour.id, static_cast<int>(c) + 1);
    EXPECT_LE(set.found[c].length_mm, set.found[c > 0 ? c - 1 : 0].length_mm);
  }
}

TEST(MeshContours, KeepTheMaterialOnTheLeft) {
  const PlatePart part(synthetic::asymmetric_plate());
  const TriangleMesh mesh = part.mesh(12.0, false);
  for (const FoundContour& found : mesh_contours(mesh, {}).found)
    expect_material_on_the_left(found.contour, mesh);
}

TEST(MeshContours, OfASolidPlateAreTwoRimsAHoleTwoOutlinesAndFourSides) {
  const PlatePart part(synthetic::asymmetric_plate());
  const ContourSet set = mesh_contours(thickened(part.mesh(6.0, false), 3.0), {});
  const int holes = part.contour_count() - 1;
  EXPECT_EQ(set.found.size(), static_cast<std::size_t>(2 * holes + 2 + 4));
  EXPECT_TRUE(set.notes.empty());
  for (int c = 0; c < part.contour_count(); ++c)
    EXPECT_EQ(loops_of_length(set, true_length_mm(part, c)), 2U) << c;
  for (const FoundContour& found : set.found) {
    EXPECT_EQ(found.contour.source, "sharp edge");
    // Rims and outlines belong to the faces, not to the walls.
    const double z_mm = found.contour.points_mm[0].z();
    const bool flat = std::all_of(found.contour.points_mm.begin(), found.contour.points_mm.end(),
                                  [&](const Eigen::Vector3d& p_mm) { return p_mm.z() == z_mm; });
    EXPECT_NEAR(found.contour.normals[0].z(), !flat ? 0.0 : z_mm == 0.0 ? 1.0 : -1.0, 1e-12);
  }
}

TEST(MeshContours, OfABoxAreItsSixFaces) {
  const ContourSet set = mesh_contours(testing::box_mesh({10.0, 20.0, 30.0}), {});
  EXPECT_EQ(set.found.size(), 6U);
  for (const double length_mm : {120.0, 160.0, 200.0}) EXPECT_EQ(loops_of_length(set, length_mm), 2U);
  ContourOptions blunt;
  blunt.sharp_edge_rad = 1.7;
  EXPECT_TRUE(mesh_contours(testing::box_mesh({10.0, 20.0, 30.0}), blunt).found.empty());
}

TEST(MeshContours, OfALongRodAreTheRimsOfItsEnds) {
  // The round wall is far larger than the ends, and yet the rims are theirs.
  TriangleMesh rod;
  rod.vertices_mm = {{0.0, 0.0, 0.0}, {0.0, 0.0, 200.0}};
  for (int k = 0; k < 48; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k / 2) / 24.0;
    rod.vertices_mm.emplace_back(5.0 * std::cos(angle), 5.0 * std::sin(angle), k % 2 == 0 ? 0.0 : 200.0);
  }
  for (std::int32_t k = 0; k < 24; ++k) {
    const std::int32_t a = 2 + 2 * k, b = 2 + 2 * ((k + 1) % 24);
    rod.triangles.insert(rod.triangles.end(),
                         {{0, b, a}, {1, a + 1, b + 1}, {a, b, b + 1}, {a, b + 1, a + 1}});
  }
  const ContourSet set = mesh_contours(rod, {});
  ASSERT_EQ(set.found.size(), 2U);
  for (const FoundContour& found : set.found) {
    EXPECT_NEAR(found.min_bend_radius_mm, 5.0, 0.01);
    const double outwards = found.contour.points_mm[0].z() > 100.0 ? 1.0 : -1.0;
    for (const Eigen::Vector3d& n : found.contour.normals) EXPECT_NEAR(n.z(), outwards, 1e-12);
  }
}

TEST(MeshContours, OfASmoothClosedMeshAreNone) {
  EXPECT_TRUE(mesh_contours(testing::sphere_mesh(50.0, 4), {}).found.empty());
  EXPECT_TRUE(mesh_contours({}, {}).found.empty());
}

TEST(MeshContours, OfHolesThatTouchAtAVertexStayApart) {
  TriangleMesh mesh = testing::sheet_mesh(40.0, 8);
  const auto cell = [](int i, int j) { return static_cast<std::size_t>(2 * (8 * j + i)); };
  std::set<std::size_t> gone{cell(3, 3), cell(3, 3) + 1, cell(4, 4), cell(4, 4) + 1};
  TriangleMesh holed{mesh.vertices_mm, {}};
  TriangleMesh pieces{mesh.vertices_mm, {}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    (gone.count(t) > 0 ? pieces : holed).triangles.push_back(mesh.triangles[t]);
  const ContourSet holes = mesh_contours(holed, {});
  EXPECT_EQ(holes.found.size(), 3U);
  EXPECT_EQ(loops_of_length(holes, 40.0), 2U);
  const ContourSet islands = mesh_contours(pieces, {});
  EXPECT_EQ(islands.found.size(), 2U);
  EXPECT_EQ(loops_of_length(islands, 40.0), 2U);
}

TEST(MeshContours, NameCrowdedEdges) {
  TriangleMesh box = testing::box_mesh({10.0, 10.0, 10.0});
  box.triangles.push_back(box.triangles[0]);
  const ContourSet doubled = mesh_contours(box, {});
  ASSERT_EQ(doubled.notes.size(), 1U);
  EXPECT_EQ(doubled.notes[0].substr(0, 8), "3 edges ");
  // A rib on a sheet: its own border is a contour, the line where it stands is none.
  TriangleMesh sheet = testing::sheet_mesh(30.0, 6);
  const auto top = static_cast<std::int32_t>(sheet.vertices_mm.size());
  sheet.vertices_mm.emplace_back(0.0, -5.0, 10.0);
  const std::int32_t middle = 3 * 7 + 3;
  sheet.triangles.push_back({middle - 7, middle, top});
  const ContourSet ribbed = mesh_contours(sheet, {});
  EXPECT_EQ(ribbed.notes.size(), 1U);
  EXPECT_EQ(ribbed.found.size(), 2U);
  EXPECT_EQ(loops_of_length(ribbed, 240.0), 1U);
}

TEST(MeshContours, TakeACrackForNoContour) {
  // A box whose top face has a corner more on one edge than the side face below it.
  TriangleMesh box = testing::box_mesh({10.0, 20.0, 30.0});
  const auto middle = static_cast<std::int32_t>(box.vertices_mm.size());
  box.vertices_mm.emplace_back(0.0, -20.0, 30.0);  // on the edge from corner 4 to corner 5
  box.triangles[2] = {4, middle, 6};
  box.triangles.push_back({middle, 5, 6});
  const ContourSet set = mesh_contours(box, {});
  EXPECT_EQ(set.found.size(), 6U);
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_NE(set.notes[0].find("1 cracks"), std::string::npos) << set.notes[0];
}

TEST(MeshContours, IgnoreTrianglesThatAreFlatToALine) {
  // The same box, the crack closed by a triangle without area: its normal says nothing.
  TriangleMesh box = testing::box_mesh({10.0, 20.0, 30.0});
  const auto middle = static_cast<std::int32_t>(box.vertices_mm.size());
  box.vertices_mm.emplace_back(0.0, -20.0, 30.0);
  box.triangles[2] = {4, middle, 6};
  box.triangles.push_back({middle, 5, 6});
  box.triangles.push_back({5, middle, 4});
  const ContourSet set = mesh_contours(box, {});
  EXPECT_EQ(set.found.size(), 6U);
  EXPECT_TRUE(set.notes.empty());
}

TEST(MeshContours, DoNotDependOnTheOrderOfTheTriangles) {
  const PlatePart part(synthetic::asymmetric_plate());
  for (TriangleMesh mesh : {part.mesh(8.0, false), thickened(part.mesh(8.0, false), 3.0)}) {
    const auto expected = loops_of(mesh_contours(mesh, {}));
    Random random(2);
    for (std::size_t i = mesh.triangles.size() - 1; i > 0; --i)
      std::swap(mesh.triangles[i],
                mesh.triangles[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i + 1)))]);
    for (auto& t : mesh.triangles)
      std::rotate(t.begin(), t.begin() + static_cast<int>(random.uniform(0.0, 3.0)), t.end());
    EXPECT_EQ(loops_of(mesh_contours(mesh, {})), expected);
  }
}

TEST(MeshContours, OfAWeldedSoupAreThoseOfTheMesh) {
  const PlatePart part(synthetic::asymmetric_plate());
  const TriangleMesh mesh = part.mesh(8.0, false);
  std::vector<Eigen::Vector3d> corners_mm;
  for (const auto& t : mesh.triangles)
    for (const std::int32_t v : t) corners_mm.push_back(mesh.vertices_mm[static_cast<std::size_t>(v)]);
  TriangleMesh soup{corners_mm, {}};
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangles.size()); ++t)
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  EXPECT_EQ(mesh_contours(soup, {}).found.size(), mesh.triangles.size());
  files::Welder<double> welder(corners_mm.size());
  std::vector<std::int32_t> index(corners_mm.size());
  welder.add(corners_mm, index.data());
  TriangleMesh welded{welder.points(), {}};
  for (std::size_t i = 0; i < index.size(); i += 3)
    welded.triangles.push_back({index[i], index[i + 1], index[i + 2]});
  EXPECT_EQ(loops_of(mesh_contours(welded, {})), loops_of(mesh_contours(mesh, {})));
}

TEST(MeshContours, MeasureTheSmallestBend) {
  for (const double corner_mm : {15.0, 30.0, 45.0}) {
    synthetic::PlateShape shape;
    shape.holes = {{Eigen::Vector2d::Zero(), 80.0, 60.0, corner_mm, 0.3}};
    const PlatePart part(shape);
    for (const TriangleMesh& mesh : {part.cad_mesh(15.0), part.mesh(4.0, false)}) {
      const ContourSet set = mesh_contours(mesh, {});
      ASSERT_EQ(set.found.size(), 2U);
      EXPECT_NEAR(set.found[1].min_bend_radius_mm / corner_mm, 1.0, 0.2) << corner_mm;
    }
  }
}

TEST(MeshContours, HaveNoBendAtASharpCorner) {
  for (const FoundContour& found : mesh_contours(testing::box_mesh({10.0, 20.0, 30.0}), {}).found)
    EXPECT_EQ(found.min_bend_radius_mm, 0.0);
}

TEST(MeshContours, SeeASmallBendBetweenLongSides) {
  // A fan over a long rectangle whose corners, rounded to 2 mm, have four chords each.
  TriangleMesh mesh;
  mesh.vertices_mm.emplace_back(0.0, 0.0, 0.0);
  for (int corner = 0; corner < 4; ++corner)
    for (int k = 0; k <= 4; ++k) {
      const double angle = (corner + 0.25 * k) * 0.5 * std::numbers::pi;
      mesh.vertices_mm.emplace_back((corner == 0 || corner == 3 ? 148.0 : -148.0) + 2.0 * std::cos(angle),
                                    (corner < 2 ? 48.0 : -48.0) + 2.0 * std::sin(angle), 0.0);
    }
  for (std::int32_t i = 0; i < 20; ++i) mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % 20});
  const ContourSet set = mesh_contours(mesh, {});
  ASSERT_EQ(set.found.size(), 1U);
  EXPECT_NEAR(set.found[0].min_bend_radius_mm, 2.0, 0.4);
}

TEST(ScanMeshContours, NameAHoleThatWasFilled) {
  const PlatePart part(synthetic::asymmetric_plate());
  const TriangleMesh mesh = part.mesh(4.0, false);
  Scan scan;
  for (const Eigen::Vector3d& v_mm : mesh.vertices_mm) scan.cloud.points_mm.push_back(v_mm.cast<float>());
  scan.triangles = mesh.triangles;
  const ContourSet open = scan_mesh_contours(scan, {});
  ASSERT_EQ(open.found.size(), static_cast<std::size_t>(part.contour_count()));
  EXPECT_TRUE(open.notes.empty());
  for (const FoundContour& found : open.found) EXPECT_TRUE(found.note.empty()) << found.note;
  // Close the opening with a fan from one point of its rim.
  std::map<std::int32_t, std::int32_t> next;
  for (const auto& [a, b] : one_face_edges(mesh)) next[a] = b;
  const Eigen::Vector3d start_mm = open.found[1].contour.points_mm[0];
  std::int32_t start = -1;
  for (const auto& [a, b] : next)
    if ((mesh.vertices_mm[static_cast<std::size_t>(a)] - start_mm).norm() < 1e-3) start = a;
  ASSERT_GE(start, 0);
  for (std::int32_t a = next[start]; next[a] != start; a = next[a])
    scan.triangles.push_back({start, next[a], a});
  const ContourSet filled = scan_mesh_contours(scan, {});
  ASSERT_EQ(filled.found.size(), open.found.size());
  ASSERT_EQ(filled.notes.size(), 1U);
  EXPECT_NE(filled.notes[0].find("outsized triangles fill holes"), std::string::npos);
  for (std::size_t c = 0; c < filled.found.size(); ++c) {
    EXPECT_NEAR(filled.found[c].length_mm / open.found[c].length_mm, 1.0, 0.03);
    EXPECT_EQ(filled.found[c].note.substr(0, 11), c == 1 ? "filled hole" : "") << c;
  }
}

}  // namespace
}  // namespace arris
