#include "acquisition/files/read_scan.hpp"
#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

struct Facet {
  Eigen::Vector3f a, b, c;
};

const std::vector<Facet> kTwoFacets = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};

std::string binary(const std::string& title, const std::vector<Facet>& facets) {
  Bytes bytes;
  std::string header = title;
  header.resize(80, ' ');
  bytes.text(header).little(static_cast<std::uint32_t>(facets.size()));
  for (const Facet& facet : facets) {
    for (int i = 0; i < 3; ++i) bytes.little(0.0F);
    for (const Eigen::Vector3f* p : {&facet.a, &facet.b, &facet.c})
      for (int axis = 0; axis < 3; ++axis) bytes.little((*p)[axis]);
    bytes.little<std::uint16_t>(0);
  }
  return bytes.str();
}

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\nendfacet\n";

TEST(ReadStl, BinaryWhoseHeaderBeginsWithSolid) {
  const auto loaded = load(binary("solid part exported by somebody", kTwoFacets), "part.stl");
  EXPECT_EQ(loaded.format, "stl binary");
  EXPECT_EQ(loaded.points(), 4U) << "corners that are equal bit for bit are one point";
  const std::vector<std::array<std::int32_t, 3>> truth = {{0, 1, 2}, {1, 3, 2}};
  EXPECT_EQ(loaded.triangles, truth);
  EXPECT_EQ(point_of(loaded, 3), Eigen::Vector3d(1, 1, 0));
}

TEST(ReadStl, NegativeZeroIsZeroAndTheSmallestStepIsNot) {
  const float tiny = std::nextafter(1.0F, 2.0F);
  const auto loaded =
      load(binary("", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{-0.F, 0, 0}, {tiny, 0, 0}, {0, 1, -0.F}}}));
  EXPECT_EQ(loaded.points(), 4U);
}

TEST(ReadStl, UnitInTheBinaryHeader) {
  EXPECT_EQ(load(binary("exported, units = inch", kTwoFacets)).unit_hint, "inch");
}

TEST(ReadStl, AsciiNamelessCrLfExponentsAndMixedCase) {
  const std::string bytes =
      "solid\r\n  FACET NORMAL 0.000000e+000 0 1\r\n outer loop\r\n vertex 1.5e-007 0 0\r\n vertex 1.0E+002 "
      "0 0\r\n"
      "Vertex 0 -1e0 +3\r\n endloop\r\n endfacet\r\nEndSolid\r\n";
  const auto loaded = load(bytes, "part.STL", true);
  EXPECT_EQ(loaded.format, "stl ascii");
  EXPECT_EQ(point_of(loaded, 0), Eigen::Vector3d(1.5e-7, 0, 0));
  EXPECT_EQ(point_of(loaded, 1), Eigen::Vector3d(100, 0, 0));
  EXPECT_EQ(point_of(loaded, 2), Eigen::Vector3d(0, -1, 3));
}

TEST(ReadStl, AsciiSeveralSolidsOneOfThemEmpty) {
  const auto loaded = load("\n solid a facet\n" + kFacet + "endsolid a\nsolid\tb\nendsolid b\nsolid c\n" +
                           kFacet + "endsolid");
  EXPECT_EQ(loaded.triangles.size(), 2U);
  EXPECT_EQ(loaded.points(), 3U);
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_TRUE(says(loaded.notes[0], "3 solids"));
}

TEST(ReadStl, AsciiOnOneLineAndWithCrAlone) {
  std::string bytes = "solid x\n" + kFacet + "endsolid x\n";
  std::string one_line = bytes;
  std::replace(one_line.begin() + 8, one_line.end(), '\n', ' ');
  EXPECT_EQ(load(one_line).triangles.size(), 1U);
  std::replace(bytes.begin(), bytes.end(), '\n', '\r');
  EXPECT_EQ(load(bytes).triangles.size(), 1U);
}

TEST(ReadStl, MeshLosesDegenerateTrianglesAndUnusedVertices) {
  const TempFolder folder;
  std::vector<Facet> facets = kTwoFacets;
  facets.push_back({{5, 5, 5}, {5, 5, 5}, {6, 6, 6}});
  facets.push_back({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const TriangleMesh mesh = read_mesh(folder.write("part.stl", binary("", facets)), 25.4);
  EXPECT_EQ(mesh.triangles.size(), 2U);
  ASSERT_EQ(mesh.vertices_mm.size(), 4U);
  EXPECT_EQ(mesh.vertices_mm[1], Eigen::Vector3d(25.4, 0, 0));
}

TEST(ReadStl, ScanKeepsTrianglesAndMeshRefusesNan) {
  const TempFolder folder;
  std::vector<Facet> facets = kTwoFacets;
  facets[1].b.x() = std::nanf("");
  const auto file = folder.write("part.stl", binary("", facets));
  const Scan scan = read_scan(file);
  EXPECT_EQ(scan.dropped_nonfinite, 1U);
  EXPECT_EQ(scan.triangles.size(), 1U);
  EXPECT_TRUE(says(error_of([&] { static_cast<void>(read_mesh(file)); }),
                   "triangles of the mesh use points that are not finite"));
}

TEST(ReadStl, SaysWhatIsWrong) {
  const std::string whole = binary("solid x", kTwoFacets);
  EXPECT_TRUE(says(error_of_bytes(whole.substr(0, 183), "part.stl"), "the binary STL file ends early"));
  EXPECT_TRUE(says(error_of_bytes(whole + std::string(3, '\0'), "part.stl"),
                   "the binary STL file is longer than it says"));
  EXPECT_TRUE(says(error_of_bytes(std::string(20, '\1'), "part.stl"), "the binary STL file ends early"));
  EXPECT_TRUE(says(error_of_bytes(binary("", {}), "part.stl"), "the file holds no points"));
  EXPECT_TRUE(says(error_of_bytes("solid x\nendsolid x\n", "part.stl"), "the file holds no points"));
  EXPECT_TRUE(says(error_of_bytes("solid x\n" + kFacet, "part.stl"), "the STL file ends early"));
  EXPECT_TRUE(
      says(error_of_bytes("solid x\n" + kFacet.substr(0, 60), "part.stl"), "the STL file ends early"));
  EXPECT_TRUE(
      says(error_of_bytes("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", "part.stl"),
           "the ASCII STL file breaks its grammar (part.stl, line 4): found 'zero'; needed a number"));
  EXPECT_TRUE(
      says(error_of_bytes("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n", "part.stl"),
           "breaks its grammar (part.stl, line 5): found 'endloop'; needed 'vertex'"));
}

TEST(ReadStl, MeshFilesWithoutASurface) {
  const TempFolder folder;
  const auto flat = folder.write("flat.stl", binary("", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}));
  EXPECT_TRUE(
      says(error_of([&] { static_cast<void>(read_mesh(flat)); }), "no triangle of the mesh has an area"));
  const auto cloud = folder.write("cloud.xyz", "1 2 3\n4 5 6\n");
  EXPECT_TRUE(says(error_of([&] { static_cast<void>(read_mesh(cloud)); }), "the file holds no triangles"));
}

}  // namespace
}  // namespace arris::testing
