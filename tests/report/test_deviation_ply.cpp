#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "report/colour_map.hpp"
#include "report/write_deviation_ply.hpp"
#include "sample_record.hpp"

namespace arris::report {
namespace {

// A reader of its own: only what the header of this one kind says.
struct Vertex {
  double x = 0, y = 0, z = 0;
  float deviation = 0;
  Rgb colour;
};
struct Ply {
  std::vector<std::string> comments, properties;
  std::vector<Vertex> vertices;
};

template <class Number>
Number take(const std::string& bytes, std::size_t& at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);  // the machines we test on are little endian
  at += sizeof value;
  return value;
}

Ply read_ply(const std::string& bytes) {
  Ply ply;
  const std::string kEnd = "end_header\n";
  std::size_t at = bytes.find(kEnd) + kEnd.size(), count = 0;
  std::istringstream header(bytes.substr(0, at));
  bool wide = false;
  for (std::string line; std::getline(header, line);) {
    if (line.rfind("comment ", 0) == 0) ply.comments.push_back(line.substr(8));
    if (line.rfind("property ", 0) == 0) ply.properties.push_back(line.substr(9));
    if (line.rfind("element vertex ", 0) == 0) count = std::stoul(line.substr(15));
    if (line == "property double x") wide = true;
  }
  for (std::size_t i = 0; i < count; ++i) {
    Vertex v;
    for (double* coordinate : {&v.x, &v.y, &v.z})
      *coordinate = wide ? take<double>(bytes, at) : static_cast<double>(take<float>(bytes, at));
    v.deviation = take<float>(bytes, at);
    for (std::uint8_t* part : {&v.colour.red, &v.colour.green, &v.colour.blue})
      *part = take<std::uint8_t>(bytes, at);
    ply.vertices.push_back(v);
  }
  EXPECT_EQ(at, bytes.size());
  return ply;
}

TEST(DeviationPly, ReadsBackWithOffsetInDouble) {
  const RunRecord record = test::sample_record();
  const Ply ply = read_ply(write_deviation_ply(record));
  EXPECT_EQ(ply.properties,
            (std::vector<std::string>{"double x", "double y", "double z", "float deviation_mm", "uchar red",
                                      "uchar green", "uchar blue"}));
  ASSERT_EQ(ply.vertices.size(), record.cloud.size());
  const ColourMap map = colour_map_for(record.deviation_mm, record.surface_profile_mm);
  for (std::size_t i = 0; i < ply.vertices.size(); ++i) {
    const Vertex& v = ply.vertices[i];
    ASSERT_EQ(Eigen::Vector3d(v.x, v.y, v.z), record.cloud.file_mm(i));
    if (std::isnan(record.deviation_mm[i])) {
      EXPECT_TRUE(std::isnan(v.deviation));
      EXPECT_EQ(v.colour, ColourMap::no_data());
    } else {
      EXPECT_NEAR(v.deviation, record.deviation_mm[i], 1e-6);
      EXPECT_EQ(v.colour, map.colour(static_cast<double>(v.deviation)));
    }
  }
}

TEST(DeviationPly, FloatWithoutOffsetAndCommentsTell) {
  RunRecord record = test::sample_record();
  record.cloud.offset_mm.setZero();
  record.part_number = "evil\nelement vertex 3";
  const Ply ply = read_ply(write_deviation_ply(record));
  EXPECT_EQ(ply.properties[0], "float x");
  std::string all;
  for (const std::string& comment : ply.comments) all += comment + "\n";
  for (const std::string& word :
       {record.result_hash, std::string("unit mm"), std::string("positive = outside the material")})
    EXPECT_NE(all.find(word), std::string::npos) << all;
  EXPECT_EQ(ply.vertices.size(), record.cloud.size());
}

TEST(DeviationPly, WithoutDeviationsAllIsNoData) {
  const Ply ply = read_ply(write_deviation_ply(test::barely_started_record()));
  for (const Vertex& v : ply.vertices) ASSERT_TRUE(std::isnan(v.deviation));
  EXPECT_TRUE(read_ply(write_deviation_ply(RunRecord{})).vertices.empty());
}

}  // namespace
}  // namespace arris::report
