#include "acquisition/files/read_scan.hpp"

#include <sys/stat.h>

#include <random>

#include "acquisition/files/point_sink.hpp"
#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

std::string error_of_file(const std::filesystem::path& file) {
  return error_of([&] { static_cast<void>(read_scan(file)); });
}

TEST(ReadScan, EachWayAPathCanBeBadHasItsMessage) {
  const TempFolder folder;
  EXPECT_TRUE(says(error_of_file(folder.path() / "none.ply"), "the file does not exist"));
  EXPECT_TRUE(says(error_of_file(folder.path()), "the path is a folder"));
  EXPECT_TRUE(says(error_of_file(folder.write("empty.ply", "")), "the file is empty"));
  EXPECT_TRUE(says(error_of_file("/dev/null"), "the path is not a regular file"));
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  EXPECT_TRUE(says(error_of_file(folder.path() / "pipe"), "the path is not a regular file"));
  EXPECT_TRUE(says(error_of_file(folder.path() / std::string(300, 'a')), "the file cannot be opened"));
}

TEST(ReadScan, UnreadableFile) {
  const TempFolder folder;
  const auto file = folder.write("locked.xyz", "1 2 3\n");
  ::chmod(folder.path().c_str(), 0755);
  ::chmod(file.c_str(), 0);
  const bool root = ::geteuid() == 0;
  if (root) {
    ASSERT_EQ(::seteuid(65534), 0);
  }  // root reads everything: be nobody for a moment
  const std::string line = error_of_file(file);
  if (root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  EXPECT_TRUE(says(line, "the file may not be read"));
}

TEST(ReadScan, NamesThatLie) {
  const TempFolder folder;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n1 2 3\n";
  EXPECT_TRUE(says(error_of_file(folder.write("a.stl", ply)),
                   "found PLY content; needed STL content, as the ending .stl says"));
  EXPECT_TRUE(says(error_of_file(folder.write("a.PLY", "1 2 3\n")), "found text that begins with '1 2 3'"));
  EXPECT_TRUE(
      says(error_of_file(folder.write("a.csv", ply)), "found PLY content; needed delimited text content"));
  EXPECT_TRUE(says(error_of_file(folder.write("a.xyz", std::string(10, '\0'))),
                   "found binary content of no known kind"));
  EXPECT_EQ(read_scan(folder.write("a.scan", ply)).format, "ply ascii") << "an ending that promises nothing";
  EXPECT_EQ(read_scan(folder.write("noending", ply)).format, "ply ascii");
}

TEST(ReadScan, KindsThatAreKnownButNotRead) {
  const std::pair<std::string, const char*> table[] = {{"ASTM-E57 and more", "an E57 file"},
                                                       {"LASF....", "a LAS file"},
                                                       {"ISO-10303-21;\n", "a STEP file"},
                                                       {"PK\x03\x04....", "a ZIP or 3MF file"},
                                                       {"\x1F\x8B....", "a gzip file"},
                                                       {"\xFF\xFE"
                                                        "1",
                                                        "UTF-16 text"}};
  for (const auto& [bytes, kind] : table)
    EXPECT_TRUE(
        says(error_of_bytes(bytes), std::string("files of this kind are not read (scan): found ") + kind));
  EXPECT_TRUE(says(error_of_bytes("v 1 2 3\n", "part.obj"), "found an OBJ file"));
  EXPECT_TRUE(
      says(error_of_bytes(std::string("\0\1\2\3", 4)), "the file is no scan or mesh that can be read"));
}

TEST(ReadScan, UnitIsAppliedAndChecked) {
  const TempFolder folder;
  const auto file = folder.write("a.xyz", "1 2 3\n");
  EXPECT_EQ(read_scan(file, 25.4).cloud.file_mm(0), Eigen::Vector3f(25.4F, 50.8F, 76.2F).cast<double>());
  for (const double to_mm : {0.0, -1.0, std::nan(""), 1e300})
    EXPECT_THROW(static_cast<void>(read_scan(file, to_mm)), Error) << to_mm;
}

TEST(ReadScan, FillsTheScan) {
  const TempFolder folder;
  const Scan scan =
      read_scan(folder.write("a.csv", "# unit: m\nx,y,z,nx,ny,nz\n1,2,3,0,0,1\nnan,2,3,0,0,1"), 1000.0);
  EXPECT_EQ(scan.format, "text comma");
  EXPECT_EQ(scan.unit_hint, "m");
  EXPECT_EQ(scan.dropped_nonfinite, 1U);
  EXPECT_TRUE(scan.cloud.has_normals());
  EXPECT_FALSE(scan.is_mesh());
  EXPECT_EQ(scan.cloud.file_mm(0), Eigen::Vector3d(1000, 2000, 3000));
  EXPECT_EQ(scan.notes.size(), 1U);
}

TEST(Offset, ZeroForAPartNearTheOriginSoThatFloatsStayAsTheyAre) {
  EXPECT_TRUE(files::offset_for({{1000, -1000, 0}, {0, 0, 0}}).isZero(0.0));
  EXPECT_TRUE(files::offset_for({}).isZero(0.0));
}

TEST(Offset, MedianInWholeMillimetresSoThatStraysDoNotMatter) {
  std::vector<Eigen::Vector3d> sample(100, Eigen::Vector3d(6.6e8, 5.6e9 + 0.4, -0.2));
  sample[0] = {0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) sample[static_cast<std::size_t>(1 + axis)][axis] = std::nan("");
  for (int axis = 0; axis < 3; ++axis) sample[static_cast<std::size_t>(4 + axis)][axis] = 1e300;
  const Eigen::Vector3d offset = files::offset_for(sample);
  EXPECT_EQ(offset, Eigen::Vector3d(6.6e8, 5.6e9, 0.0));
  EXPECT_FALSE(std::signbit(offset.z()));
}

/// Law: no point of a part up to 2 m across and up to 10 m from the origin moves by more than 0.0001 mm.
TEST(Offset, PointsStayWhereTheyAre) {
  std::mt19937_64 random(20240);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const double away_mm : {0.0, 500.0, 999.0, 1001.0, 3000.0, 10000.0}) {
    Bytes bytes;
    std::vector<Eigen::Vector3d> truth;
    const int count = 3000;
    bytes.text("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) +
               "\nproperty double x\nproperty double y\nproperty double z\nend_header\n");
    for (int i = 0; i < count; ++i) {
      truth.emplace_back(away_mm + 2000.0 * unit(random) * unit(random), 2000.0 * unit(random) - away_mm,
                         unit(random));
      for (int axis = 0; axis < 3; ++axis) bytes.little(truth.back()[axis]);
    }
    const auto loaded = load(bytes.str());
    double worst_mm = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      worst_mm = std::max(worst_mm, (point_of(loaded, i) - truth[i]).cwiseAbs().maxCoeff());
    EXPECT_LE(worst_mm, 1e-4) << away_mm;
  }
}

/// Law: float32 coordinates are kept bit for bit when they need no offset, and exactly in value when they do.
TEST(Offset, FloatFilesLoseNothing) {
  std::mt19937_64 random(7);
  for (const float away_mm : {0.0F, 10000.0F, -250000.0F}) {
    std::uniform_real_distribution<float> coordinate(away_mm - 700.0F, away_mm + 700.0F);
    Bytes bytes;
    std::vector<Eigen::Vector3f> truth;
    bytes.text(
        "ply\nformat binary_big_endian 1.0\nelement vertex 500\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n");
    for (int i = 0; i < 500; ++i) {
      truth.emplace_back(coordinate(random), coordinate(random), coordinate(random));
      for (int axis = 0; axis < 3; ++axis) bytes.big(truth.back()[axis]);
    }
    const auto loaded = load(bytes.str());
    for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_EQ(point_of(loaded, i), truth[i].cast<double>());
  }
}

}  // namespace
}  // namespace arris::testing
