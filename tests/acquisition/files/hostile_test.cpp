#include <Eigen/Geometry>
#include <limits>
#include <random>
#include <sstream>

#include "acquisition/files/write_stl.hpp"
#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

struct Sample {
  const char* name;
  std::string bytes;
  bool counted;  ///< the format says how many points there are, so a part of it can never pass as a whole
};

std::string binary_ply(bool little) {
  Bytes bytes;
  bytes.text(
      std::string("ply\nformat binary_") + (little ? "little" : "big") +
      "_endian 1.0\ncomment unit: mm\nelement vertex 4\nproperty float x\nproperty double y\nproperty short "
      "z\n"
      "property list uchar float w\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n");
  const auto put = [&](auto value) {
    if (little)
      bytes.little(value);
    else
      bytes.big(value);
  };
  for (int i = 0; i < 4; ++i) {
    put(static_cast<float>(i));
    put(0.5 * i);
    put(static_cast<std::int16_t>(i * i));
    put(std::uint8_t{1});
    put(1.0F);
  }
  for (int face = 0; face < 2; ++face) {
    put(std::uint8_t{3});
    for (int corner = 0; corner < 3; ++corner) put(static_cast<std::int32_t>(corner + face));
  }
  return bytes.str();
}

std::vector<Sample> samples() {
  TriangleMesh mesh;
  mesh.vertices_mm = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 10, 5}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  std::ostringstream stl;
  write_stl(stl, mesh);
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const std::string pcd =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";
  Bytes raw;
  for (const float v : {1.F, 2.F, 3.F, 4.F, 5.F, 6.F}) raw.little(v);
  Bytes packed;
  packed.little<std::uint32_t>(25).little<std::uint32_t>(24).text(std::string(1, '\x17') + raw.str());
  return {
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 1\n4 0 "
       "1 3 2\n",
       true},
      {"b.ply", binary_ply(true), true},
      {"c.ply", binary_ply(false), true},
      {"a.stl", stl.str(), true},
      {"b.stl", "solid a\n" + facet + facet + "endsolid a\n", true},
      {"a.pcd", pcd + "ascii\n1 2 3\n4 5 6\n", true},
      {"b.pcd", pcd + "binary\n" + raw.str(), true},
      {"c.pcd", pcd + "binary_compressed\n" + packed.str(), true},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", true},
      {"a.pts", "2\n1 2 3 4\n5 6 7 8\n", true},
      {"a.xyz", "# x y z\n1.5 2.5 3.5\n4 5 6\n7 8 9\n", false},
      {"a.csv", "x;y;z;nx;ny;nz\n1,5;2;3;0;0;1\n4;5;6;0;1;0\n", false},
  };
}

/// Reads without an ending of the name to help, so that every reader may be tried; true when it was accepted.
bool reads(const std::string& bytes, const std::string& name, files::Loaded* result = nullptr) {
  try {
    files::Loaded loaded = load(bytes, name, name[0] == 'b');
    for (const auto& triangle : loaded.triangles)
      for (const std::int32_t corner : triangle) EXPECT_LT(static_cast<std::size_t>(corner), loaded.points());
    EXPECT_GT(loaded.points(), 0U);
    EXPECT_TRUE(loaded.normals.empty() || loaded.normals.size() == loaded.points());
    for (std::size_t i = 0; i < loaded.points(); ++i) EXPECT_TRUE(point_of(loaded, i).allFinite());
    EXPECT_LE(loaded.points() * sizeof(Eigen::Vector3d), 90 * 8 * bytes.size());
    if (result != nullptr) *result = std::move(loaded);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInput);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return false;
  }
}

TEST(Hostile, WholeSamplesAreRead) {
  for (const Sample& sample : samples()) EXPECT_TRUE(reads(sample.bytes, sample.name)) << sample.name;
}

TEST(Hostile, CutAtEveryByteNeverGivesAnotherNumberOfPoints) {
  for (const Sample& sample : samples()) {
    files::Loaded whole;
    ASSERT_TRUE(reads(sample.bytes, sample.name, &whole));
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
      const std::string cut = sample.bytes.substr(0, size);
      files::Loaded part;
      if (!reads(cut, sample.name, &part) || !sample.counted) continue;
      EXPECT_EQ(part.points(), whole.points()) << sample.name << " cut at " << size;
      EXPECT_EQ(part.triangles, whole.triangles) << sample.name << " cut at " << size;
    }
  }
}

std::string mutated(std::string bytes, std::mt19937_64& random) {
  const int changes = 1 + static_cast<int>(random() % 4);
  for (int i = 0; i < changes && !bytes.empty(); ++i) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
        break;
      case 2:
        bytes.erase(at, 1 + random() % 4);
        break;
      case 3:
        bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 12));
        break;
      case 4:
        bytes[at] = "0123456789-+.eE \n\r\t,;#"[random() % 22];
        break;
      default:
        bytes.insert(at, "9999999999");
    }
  }
  return bytes;
}

TEST(Hostile, MutatedFilesAreReadOrRefused) {
  std::mt19937_64 random(97);
  for (const Sample& sample : samples()) {
    for (int i = 0; i < 3000; ++i) {
      const std::string bytes = mutated(sample.bytes, random);
      reads(bytes, i % 2 == 0 ? sample.name : "scan");
      if (HasFailure()) FAIL() << sample.name << " round " << i;
    }
  }
}

TEST(Hostile, RandomBytesAreRefused) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes(random() % 300, ' ');
    for (char& c : bytes) c = static_cast<char>(random());
    bytes += '\0';
    reads(bytes, "scan");
  }
}

/// A file may ask for much and be small: nothing larger than a small multiple of its size is allocated.
class LimitedMemory {
 public:
  static std::size_t resident_peak_kib() {
    std::ifstream status("/proc/self/status");
    std::string word;
    while (status >> word)
      if (word == "VmPeak:") {
        std::size_t kib = 0;
        status >> kib;
        return kib;
      }
    return 0;
  }
};

TEST(Hostile, HugeAnnouncementsAllocateNothing) {
  const std::size_t before_kib = LimitedMemory::resident_peak_kib();
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string tail(100, '1');
  for (const char* count : {"4000000000", "1000000000000", "9223372036854775807", "18446744073709551615"}) {
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
      const std::string front = std::string("ply\nformat ") + format + " 1.0\n";
      EXPECT_FALSE(reads(front + "element vertex " + count + "\n" + xyz + "end_header\n" + tail, "a.ply"));
      EXPECT_FALSE(reads(
          front + "element vertex " + count + "\n" + xyz + "property list uint int a\nend_header\n" + tail,
          "a.ply"));
      EXPECT_FALSE(reads(front + "element vertex 1\n" + xyz + "element face " + count +
                             "\nproperty list uchar int vertex_indices\nend_header\n1 1 1\n" + tail,
                         "a.ply"));
    }
    EXPECT_FALSE(reads(std::string("OFF\n") + count + " 1 1\n" + tail, "a.off"));
    EXPECT_FALSE(reads(std::string(count) + "\n1 2 3\n", "a.pts"));
    for (const char* data : {"ascii", "binary", "binary_compressed"})
      EXPECT_FALSE(
          reads(std::string("VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS ") +
                    count + "\nDATA " + data + "\n" + tail,
                "a.pcd"));
  }
  EXPECT_LT(LimitedMemory::resident_peak_kib(), before_kib + 64 * 1024);
}

TEST(Hostile, ElementsWithoutPropertiesTakeNoTime) {
  const std::string xyz =
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_TRUE(reads("ply\nformat ascii 1.0\nelement none 18446744073709551615\n" + xyz + "1 2 3\n", "a.ply"));
  EXPECT_TRUE(reads("ply\nformat binary_little_endian 1.0\nelement none 18446744073709551615\n" + xyz +
                        std::string(12, '\1'),
                    "a.ply"));
}

TEST(Hostile, MessagesStayOneLineAndShort) {
  const std::string line =
      error_of_bytes("x,y,z\n1,2,3\n4,\x01\x1B[31m" + std::string(10000, 'z') + "\n", "a.csv");
  EXPECT_LT(line.size(), 400U);
  EXPECT_EQ(line.find('\x1B'), std::string::npos);
}

}  // namespace
}  // namespace arris::testing
