#include "tests/acquisition/files/file_bytes.hpp"

namespace arris::testing {
namespace {

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string ascii(const std::string& elements, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}

std::string little(const std::string& elements) {
  return "ply\nformat binary_little_endian 1.0\n" + elements + "end_header\n";
}

TEST(ReadPly, AsciiPointsNormalsAndColours) {
  const auto loaded =
      load(ascii("comment made by hand\nelement vertex 2\n" + kXyz +
                     "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n",
                 "1 2.5 -3e1 0 0 1 255\n4 5 6 0 -2 0 0\n"));
  EXPECT_EQ(loaded.format, "ply ascii");
  ASSERT_EQ(loaded.points(), 2U);
  EXPECT_EQ(point_of(loaded, 0), Eigen::Vector3d(1, 2.5, -30));
  EXPECT_EQ(point_of(loaded, 1), Eigen::Vector3d(4, 5, 6));
  ASSERT_EQ(loaded.normals.size(), 2U);
  EXPECT_EQ(loaded.normals[1], Eigen::Vector3f(0, -1, 0));
  EXPECT_EQ(loaded.extra_names, std::vector<std::string>{"red"});
}

TEST(ReadPly, EveryScalarTypeInBothByteOrders) {
  const std::string elements =
      "element vertex 1\nproperty int8 a\nproperty uchar b\nproperty short x\nproperty uint16 c\nproperty "
      "int y\n"
      "property uint32 d\nproperty float32 e\nproperty float64 z\n";
  const std::string front = "ply\nformat binary_";
  Bytes small;
  small.text(front + "little_endian 1.0\n" + elements + "end_header\n");
  small.little<std::int8_t>(-1).little<std::uint8_t>(200).little<std::int16_t>(-300).little<std::uint16_t>(7);
  small.little<std::int32_t>(70000).little<std::uint32_t>(9).little(1.5F).little(0.1);
  Bytes large;
  large.text(front + "big_endian 1.0\n" + elements + "end_header\n");
  large.big<std::int8_t>(-1).big<std::uint8_t>(200).big<std::int16_t>(-300).big<std::uint16_t>(7);
  large.big<std::int32_t>(70000).big<std::uint32_t>(9).big(1.5F).big(0.1);
  for (const Bytes* bytes : {&small, &large}) {
    const auto loaded = load(bytes->str(), "scan.ply", true);
    EXPECT_EQ(point_of(loaded, 0), Eigen::Vector3d(-300, 70000, 0.1));
  }
}

TEST(ReadPly, EveryTypeNameCanBeACoordinate) {
  for (const char* type :
       {"char", "int8",   "uchar", "uint8", "short", "int16",  "ushort", "uint16",  "int",    "int32",
        "uint", "uint32", "long",  "int64", "ulong", "uint64", "float",  "float32", "double", "float64"}) {
    std::string elements = "element vertex 1\n";
    for (const char* axis : {" x\n", " y\n", " z\n"}) elements += std::string("property ") + type + axis;
    const auto loaded = load(ascii(elements, "1 2 3\n"));
    EXPECT_EQ(point_of(loaded, 0), Eigen::Vector3d(1, 2, 3)) << type;
  }
}

TEST(ReadPly, BodyWhoseFirstByteIsALineEnd) {
  // 0x0A 0x0A 0x0A 0x0A is a float; it must not be taken for a blank line after the header.
  Bytes bytes;
  bytes.text(little("element vertex 1\n" + kXyz)).text("\n\n\n\n").little(2.0F).little(3.0F);
  const auto loaded = load(bytes.str());
  EXPECT_EQ(point_of(loaded, 0).y(), 2.0);
  EXPECT_LT(point_of(loaded, 0).x(), 1e-30);
}

TEST(ReadPly, HeaderWithCrLfThenBinary) {
  Bytes bytes;
  bytes.text("ply\r\nformat binary_little_endian 1.0\r\ncomment  \r\nelement vertex 1 \r\n");
  bytes.text("property float x\r\nproperty float y\t\r\nproperty float z\r\nend_header\r\n");
  bytes.text("\n\n\n\n").little(2.0F).little(3.0F);
  EXPECT_EQ(point_of(load(bytes.str()), 0).z(), 3.0);
}

TEST(ReadPly, HeaderWithCrAloneThenBinary) {
  Bytes bytes;
  bytes.text("ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty float x\rproperty float y\r");
  bytes.text("property float z\rend_header\r").text("\n\n\n\n").little(2.0F).little(3.0F);
  EXPECT_EQ(point_of(load(bytes.str()), 0).y(), 2.0);
}

TEST(ReadPly, AsciiWithCrAlone) {
  std::string bytes = ascii("element vertex 2\n" + kXyz, "1 2 3\n4 5 6\n");
  std::replace(bytes.begin(), bytes.end(), '\n', '\r');
  EXPECT_EQ(point_of(load(bytes), 1), Eigen::Vector3d(4, 5, 6));
}

TEST(ReadPly, CommentsAnywhereAndUnknownHeaderLines) {
  const auto loaded = load(
      "ply\ncomment one\nformat ascii 1.0\ncomment length unit = meters\nelement vertex 1\ncomment two\n"
      "property float x\nobj_info three\nproperty float y\nproperty float z\nwritten by "
      "somebody\nend_header\n1 2 3\n");
  EXPECT_EQ(loaded.unit_hint, "m");
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_TRUE(says(loaded.notes[0], "written by somebody"));
}

TEST(ReadPly, UnknownElementsAndListsBeforeTheVertices) {
  const std::string elements =
      "element camera 2\nproperty float f\nproperty list uchar short tags\nelement vertex 1\n" + kXyz +
      "element other 1\nproperty double w\n";
  const auto text = load(ascii(elements, "1.5 2 7 8\n2.5 0\n1 2 3\n9\n"));
  EXPECT_EQ(point_of(text, 0), Eigen::Vector3d(1, 2, 3));
  Bytes bytes;
  bytes.text(little(elements))
      .little(1.5F)
      .little<std::uint8_t>(2)
      .little<std::int16_t>(7)
      .little<std::int16_t>(8);
  bytes.little(2.5F).little<std::uint8_t>(0).little(1.0F).little(2.0F).little(3.0F).little(9.0);
  EXPECT_EQ(point_of(load(bytes.str()), 0), Eigen::Vector3d(1, 2, 3));
}

TEST(ReadPly, ListsOnTheVertex) {
  const std::string elements =
      "element vertex 2\nproperty list int float w\n" + kXyz + "property list uchar uchar tags\n";
  const auto text = load(ascii(elements, "2 0.5 0.5 1 2 3 1 9\n0 4 5 6 0\n"));
  Bytes bytes;
  bytes.text(little(elements)).little<std::int32_t>(2).little(0.5F).little(0.5F);
  bytes.little(1.0F).little(2.0F).little(3.0F).little<std::uint8_t>(1).little<std::uint8_t>(9);
  bytes.little<std::int32_t>(0).little(4.0F).little(5.0F).little(6.0F).little<std::uint8_t>(0);
  for (const auto& loaded : {text, load(bytes.str())}) {
    ASSERT_EQ(loaded.points(), 2U);
    EXPECT_EQ(point_of(loaded, 0), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(point_of(loaded, 1), Eigen::Vector3d(4, 5, 6));
  }
}

TEST(ReadPly, ListAfterTheCoordinatesInAscii) {
  const auto loaded =
      load(ascii("element vertex 2\n" + kXyz + "property list uchar int tags\n", "1 2 3 2 8 9\n4 5 6 0\n"));
  EXPECT_EQ(point_of(loaded, 1), Eigen::Vector3d(4, 5, 6));
}

TEST(ReadPly, FacesBecomeFans) {
  const std::string elements = "element vertex 4\n" + kXyz +
                               "element face 3\nproperty uchar flag\n"
                               "property list uchar uint vertex_index\nproperty float area\n";
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const auto loaded = load(ascii(elements, points + "7 4 0 1 2 3 0.5\n7 3 3 2 1 1\n7 2 0 1 0\n"));
  const std::vector<std::array<std::int32_t, 3>> truth = {{0, 1, 2}, {0, 2, 3}, {3, 2, 1}};
  EXPECT_EQ(loaded.triangles, truth);
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_TRUE(says(loaded.notes[0], "1 of 3 faces"));
}

TEST(ReadPly, FacesOfEveryIndexTypeInBinary) {
  for (const auto& [type, size] :
       {std::pair{"uchar", 1}, {"short", 2}, {"int", 4}, {"uint", 4}, {"double", 8}}) {
    Bytes bytes;
    bytes.text(little("element vertex 3\n" + kXyz + "element face 1\nproperty list ushort " + type +
                      " vertex_indices\n"));
    for (const float v : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) bytes.little(v);
    bytes.little<std::uint16_t>(3);
    for (const int corner : {2, 0, 1}) {
      if (size == 1) bytes.little(static_cast<std::uint8_t>(corner));
      if (size == 2) bytes.little(static_cast<std::int16_t>(corner));
      if (size == 4) bytes.little(corner);
      if (size == 8) bytes.little(static_cast<double>(corner));
    }
    const auto loaded = load(bytes.str());
    ASSERT_EQ(loaded.triangles.size(), 1U) << type;
    EXPECT_EQ(loaded.triangles[0], (std::array<std::int32_t, 3>{2, 0, 1})) << type;
  }
}

TEST(ReadPly, ZeroFacesAndTextAfterTheEnd) {
  const auto loaded =
      load(ascii("element vertex 1\n" + kXyz + "element face 0\nproperty list uchar int vertex_indices\n",
                 "1 2 3\n\nbye\n"));
  EXPECT_TRUE(loaded.triangles.empty());
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_TRUE(says(loaded.notes[0], "after the last PLY element"));
}

TEST(ReadPly, DropsPointsThatAreNotFiniteAndTheirTriangles) {
  const auto loaded =
      load(ascii("element vertex 4\n" + kXyz + "element face 2\nproperty list uchar int vertex_indices\n",
                 "nan 0 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 1 2 3\n"));
  EXPECT_EQ(loaded.nonfinite, 1U);
  EXPECT_EQ(loaded.points(), 3U);
  ASSERT_EQ(loaded.triangles.size(), 1U);
  EXPECT_EQ(loaded.triangles[0], (std::array<std::int32_t, 3>{0, 1, 2}));
}

TEST(ReadPly, NormalsThatAreMostlyMissingAreNotUsed) {
  const std::string elements =
      "element vertex 3\n" + kXyz + "property float nx\nproperty float ny\nproperty float nz\n";
  const auto few = load(ascii(elements, "1 2 3 0 0 0\n1 2 4 0 0 1\n1 2 5 0 0 1\n"));
  EXPECT_EQ(few.normals.size(), 3U);
  EXPECT_TRUE(few.normals[0].isZero());
  EXPECT_TRUE(says(few.notes.at(0), "no normal at 1 of 3 points"));
  const auto most = load(ascii(elements, "1 2 3 nan nan nan\n1 2 4 0 0 0\n1 2 5 0 0 1\n"));
  EXPECT_TRUE(most.normals.empty());
  EXPECT_TRUE(says(most.notes.at(0), "normals not used: 2 of 3"));
}

struct Bad {
  std::string bytes;
  const char* message;
};

TEST(ReadPly, SaysWhatIsWrong) {
  const std::string vertex = "element vertex 1\n" + kXyz;
  const std::string face = vertex + "element face 1\nproperty list uchar int vertex_indices\n";
  const Bad table[] = {
      {"ply\nformat ascii 1.0\nelement vertex 1\n", "the PLY header ends early"},
      {"ply\n" + vertex + "end_header\n1 2 3\n", "the PLY header names no format"},
      {"ply\nformat binary_middle_endian 1.0\n" + vertex + "end_header\n", "the PLY format is not known"},
      {ascii("element vertex\n", ""), "a PLY element has no usable count"},
      {ascii("element vertex -1\n", ""), "a PLY element has no usable count"},
      {ascii("element vertex 99999999999999999999999\n", ""), "a PLY element has no usable count"},
      {ascii("property float x\n", ""), "a PLY property stands before any element"},
      {ascii("element vertex 1\nproperty float\n", ""), "a PLY property is cut short"},
      {ascii("element vertex 1\nproperty list uchar int\n", ""), "a PLY property is cut short"},
      {ascii("element vertex 1\nproperty half x\n", ""), "a PLY property has an unknown type"},
      {ascii("element vertex 1\nproperty list float int x\n", ""),
       "a PLY list is counted by a floating type"},
      {ascii("element point 1\n" + kXyz, "1 2 3\n"), "the PLY file has no vertices"},
      {ascii("element vertex 1\nproperty float x\nproperty float y\n", "1 2\n"),
       "the PLY vertices have no coordinates"},
      {ascii("element vertex 2\n" + kXyz, "1 2 3\n"), "the PLY file ends early"},
      {ascii("element vertex 18446744073709551615\n" + kXyz, "1 2 3\n"), "the PLY file ends early"},
      {ascii("element vertex 0\n" + kXyz, ""), "the file holds no points"},
      {ascii(vertex, "1 2 x\n"), "is not a row of numbers"},
      {ascii(vertex, "1 2     \n"), "is not a row of numbers"},
      {ascii(vertex, "nan 2 3\n"), "no point of the file is finite"},
      {ascii(face, "1 2 3\n3 0 0 1\n"), "a face uses a point that does not exist"},
      {ascii(face, "1 2 3\n3 0 0 -1\n"), "a face uses a point that does not exist"},
      {ascii(face, "1 2 3\n3 0 0\n"), "a PLY row does not hold what the header announces"},
      {ascii(face, "1 2 3\n"), "the PLY file ends early"},
      {little(vertex) + "12345678901", "the PLY file ends early"},
      {little("element vertex 4294967295\n" + kXyz) + "123456789012", "the PLY file ends early"},
      {little(face) + "123456789012" + "\x03", "the PLY file ends early"},
      {little(vertex + "element face 1\nproperty list char int vertex_indices\n") + "123456789012" + "\xFF",
       "a PLY list has a negative length"},
  };
  for (const Bad& bad : table) EXPECT_TRUE(says(error_of_bytes(bad.bytes, "part.ply"), bad.message));
  EXPECT_TRUE(says(error_of_bytes(std::string("\0\1\2\3", 4), "part.ply"), "this is no PLY file"));
}

TEST(ReadPly, ErrorsNameTheLine) {
  const std::string line =
      error_of_bytes(ascii("element vertex 3\n" + kXyz, "1 2 3\n4 5 6\n7 oops 9\n"), "part.ply");
  EXPECT_EQ(line,
            "a row is not a row of numbers (part.ply, line 10): found '7 oops 9'; needed 3 columns with "
            "numbers for "
            "x, y, z; next: put # before lines that are no points, or export again");
}

}  // namespace
}  // namespace arris::testing
