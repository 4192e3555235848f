#include "acquisition/files/file_info.hpp"

#include <limits>
#include <random>

#include "acquisition/files/sha256.hpp"
#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

TEST(FileInfo, DescribesACloud) {
  const TempFolder folder;
  std::string bytes = "# made by hand\nx,y,z,red,quality\n";
  for (int i = 0; i < 50; ++i)
    for (int k = 0; k < 40; ++k)
      bytes += std::to_string(i * 2) + "," + std::to_string(5000000 + k * 2) + ",-1,255,0.5\n";
  bytes += "nan,0,0,0,0\n";
  const FileInfo info = inspect_file(folder.write("a.csv", bytes));
  EXPECT_EQ(info.format, "text comma");
  EXPECT_EQ(info.bytes, bytes.size());
  EXPECT_EQ(info.sha256, sha256_hex(bytes));
  EXPECT_EQ(info.points, 2001U);
  EXPECT_EQ(info.finite, 2000U);
  EXPECT_EQ(info.triangles, 0U);
  EXPECT_FALSE(info.has_normals);
  EXPECT_TRUE(info.has_colours);
  EXPECT_EQ(info.extra_names, (std::vector<std::string>{"red", "quality"}));
  EXPECT_EQ(info.box_min, Eigen::Vector3d(0, 5000000, -1));
  EXPECT_EQ(info.box_max, Eigen::Vector3d(98, 5000078, -1));
  EXPECT_EQ(info.extent(), Eigen::Vector3d(98, 78, 0));
  EXPECT_EQ(info.spacing, 2.0);
  EXPECT_EQ(info.unit_hint, "");
  EXPECT_EQ(info.unit_guess, "mm");
}

TEST(FileInfo, DescribesAMesh) {
  const TempFolder folder;
  const FileInfo info = inspect_file(folder.write(
      "a.off", "OFF # units: inch\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n2 0 0\n3 0 1 2\n3 0 1 3\n3 1 1 2\n"));
  EXPECT_EQ(info.triangles, 3U);
  EXPECT_EQ(info.flat_triangles, 2U);
  EXPECT_EQ(info.spacing, 0.0);
  EXPECT_EQ(info.unit_hint, "inch");
  EXPECT_EQ(info.unit_guess, "") << "a hint leaves nothing to guess";
}

TEST(FileInfo, ThrowsAsTheReaders) {
  EXPECT_TRUE(
      says(error_of([] { static_cast<void>(inspect_file("/none/such.ply")); }), "the file does not exist"));
}

TEST(FileInfo, GuessesOnlyWhereUsualPartsLie) {
  EXPECT_EQ(guess_unit(1200.0), "mm");
  EXPECT_EQ(guess_unit(1.2), "m");
  EXPECT_EQ(guess_unit(12.0), "");
  EXPECT_EQ(guess_unit(0.0), "");
}

/// Law: the same as looking at every pair, for the same points.
TEST(Spacing, AgreesWithBruteForce) {
  std::mt19937_64 random(31);
  for (const std::size_t count : {2UL, 3UL, 100UL, 3000UL}) {
    for (const float thickness : {0.0F, 5.0F, 300.0F}) {
      std::uniform_real_distribution<float> unit(0.0F, 1.0F);
      std::vector<Eigen::Vector3f> points;
      for (std::size_t i = 0; i < count; ++i)
        points.emplace_back(100.0F * unit(random), thickness * unit(random), 400.0F * unit(random));
      points.front() = {1e6F, 0, 0};  // a stray
      std::vector<double> distances;
      for (std::size_t i = 0; i < count; i += count / 255 + 1) {
        float best = std::numeric_limits<float>::infinity();
        for (std::size_t k = 0; k < count; ++k)
          if (k != i) best = std::min(best, (points[k] - points[i]).squaredNorm());
        distances.push_back(std::sqrt(static_cast<double>(best)));
      }
      std::sort(distances.begin(), distances.end());
      EXPECT_EQ(estimate_spacing(points), distances[distances.size() / 2]) << count;
    }
  }
}

TEST(Spacing, OfFewOrEqualPoints) {
  EXPECT_EQ(estimate_spacing({}), 0.0);
  const std::vector<Eigen::Vector3f> equal(1000, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(estimate_spacing({equal.data(), 1}), 0.0);
  EXPECT_EQ(estimate_spacing(equal), 0.0);
}

}  // namespace
}  // namespace arris::testing
