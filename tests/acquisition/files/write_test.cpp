#include <Eigen/Geometry>
#include <random>
#include <sstream>

#include "acquisition/files/read_scan.hpp"
#include "acquisition/files/write_ply.hpp"
#include "acquisition/files/write_stl.hpp"
#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

PointCloud some_cloud(std::size_t count, double away_mm) {
  PointCloud cloud;
  cloud.offset_mm = Eigen::Vector3d::Constant(away_mm);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> coordinate(-500.0F, 500.0F);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points_mm.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    cloud.normals.emplace_back(0.0F, 0.6F, 0.8F);
  }
  return cloud;
}

std::string ply_of(const PointCloud& cloud, const PlyExtras& extras = {}) {
  std::ostringstream out;
  write_ply(out, cloud, extras);
  return out.str();
}

/// Law: what is written is what is read, to the last bit of float32 about whatever offset.
TEST(WritePly, ReadingBackGivesTheSame) {
  const TempFolder folder;
  for (const double away_mm : {0.0, 12345.0, 5.6e9}) {
    const PointCloud cloud = some_cloud(10000, away_mm);
    std::vector<float> deviation(cloud.size(), 0.25F);
    std::vector<std::array<std::uint8_t, 3>> rgb(cloud.size(), {1, 2, 3});
    const std::vector<std::array<std::int32_t, 3>> triangles = {{0, 1, 2}, {9999, 5, 7}};
    PlyExtras extras;
    extras.deviation_mm = deviation;
    extras.rgb = rgb;
    extras.triangles = triangles;
    extras.comments = {"result_hash 0123", "two\nlines"};
    const auto file = folder.write("a.ply", ply_of(cloud, extras));
    const Scan scan = read_scan(file);
    ASSERT_EQ(scan.cloud.size(), cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
      ASSERT_LT((scan.cloud.file_mm(i) - cloud.file_mm(i)).norm(), 1e-4) << away_mm;
    EXPECT_EQ(scan.triangles, triangles);
    EXPECT_EQ(scan.unit_hint, "mm");
    EXPECT_TRUE(scan.cloud.has_normals());
    EXPECT_EQ(load(content_of(file)).extra_names,
              (std::vector<std::string>{"deviation_mm", "red", "green", "blue"}));
    if (away_mm == 0.0) {
      EXPECT_EQ(scan.cloud.points_mm, cloud.points_mm);
      EXPECT_EQ(scan.cloud.normals, cloud.normals);
    }
  }
}

TEST(WritePly, TheBytesThemselves) {
  PointCloud cloud;
  cloud.points_mm = {{1.0F, 2.0F, 3.0F}};
  const float deviation = 0.5F;
  PlyExtras extras;
  extras.deviation_mm = {&deviation, 1};
  Bytes truth;
  truth.text(
      "ply\nformat binary_little_endian 1.0\ncomment units mm\nelement vertex 1\nproperty float x\nproperty "
      "float y\n"
      "property float z\nproperty float deviation_mm\nend_header\n");
  truth.little(1.0F).little(2.0F).little(3.0F).little(0.5F);
  EXPECT_EQ(ply_of(cloud, extras), truth.str());
}

TEST(WritePly, RefusesWhatDoesNotFitTogether) {
  const PointCloud cloud = some_cloud(3, 0.0);
  const std::vector<float> two(2);
  PlyExtras extras;
  extras.deviation_mm = two;
  EXPECT_THROW(ply_of(cloud, extras), Error);
  const std::vector<std::array<std::int32_t, 3>> outside = {{0, 1, 3}};
  extras = {};
  extras.triangles = outside;
  EXPECT_THROW(ply_of(cloud, extras), Error);
}

TriangleMesh some_mesh() {
  TriangleMesh mesh;
  mesh.vertices_mm = {{0, 0, 0.1}, {10, 0, 0}, {10, 10, 0}, {0, 10, 1.0 / 3.0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(WritePly, MeshKeepsDoubles) {
  const TempFolder folder;
  std::ostringstream out;
  write_ply(out, some_mesh());
  const TriangleMesh mesh = read_mesh(folder.write("a.ply", out.str()));
  EXPECT_EQ(mesh.vertices_mm, some_mesh().vertices_mm);
  EXPECT_EQ(mesh.triangles, some_mesh().triangles);
}

TEST(WriteStl, ReadingBackGivesTheMeshInFloat32) {
  const TempFolder folder;
  std::ostringstream out;
  write_stl(out, some_mesh(), std::string(200, 'x'));
  EXPECT_EQ(out.str().size(), 84U + 2 * 50);
  EXPECT_NE(out.str().substr(0, 5), "solid");
  const TriangleMesh mesh = read_mesh(folder.write("a.stl", out.str()));
  ASSERT_EQ(mesh.vertices_mm.size(), 4U);
  EXPECT_EQ(mesh.triangles, some_mesh().triangles);
  EXPECT_EQ(mesh.vertices_mm[3].z(), static_cast<double>(1.0F / 3.0F));
  float normal_z = 0.0F;
  std::memcpy(&normal_z, out.str().data() + 84 + 8, 4);
  EXPECT_GT(normal_z, 0.99F);
}

TEST(WriteStl, RefusesIndicesOutsideTheMesh) {
  TriangleMesh mesh = some_mesh();
  mesh.triangles[0][1] = -1;
  std::ostringstream out;
  EXPECT_THROW(write_stl(out, mesh), Error);
}

}  // namespace
}  // namespace arris::testing
