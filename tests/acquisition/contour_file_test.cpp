#include "acquisition/contour_file.hpp"

#include <gtest/gtest.h>

#include "tests/acquisition/files/file_bytes.hpp"

namespace arris {
namespace {

using testing::error_of;
using testing::TempFolder;

std::vector<Contour> read(const std::string& text, double to_mm = 1.0) {
  return read_contours_csv(text, "edge.csv", to_mm);
}

std::string refusal_of(const std::string& text) {
  return error_of([&] { (void)read(text); });
}

const std::string kHeader = "x,y,z,nx,ny,nz,path,closed\n";
const std::string kTriangle = "0,0,0,0,0,1,1,1\n2,0,0,0,0,1,1,1\n0,2,0,0,0,1,1,1\n";

TEST(ContourFile, ReadsEachPathAsAContour) {
  const auto contours = read("# two contours\n" + kHeader + kTriangle +
                             "\n5,0,0,0,0,-1,7,0\r\n# between\n6,0,0.5,0,0,-1,7,0\r\n");
  ASSERT_EQ(contours.size(), 2U);
  EXPECT_EQ(contours[0].id, 1);
  EXPECT_TRUE(contours[0].closed);
  EXPECT_EQ(contours[0].source, "file");
  EXPECT_EQ(contours[0].points_mm[2], Eigen::Vector3d(0, 2, 0));
  EXPECT_EQ(contours[0].normals[2], Eigen::Vector3d::UnitZ());
  EXPECT_EQ(contours[1].id, 7);
  EXPECT_FALSE(contours[1].closed);
  EXPECT_EQ(contours[1].points_mm[1], Eigen::Vector3d(6, 0, 0.5));
}

TEST(ContourFile, TakesColumnsInAnyOrderAndUnit) {
  const auto contours = read("closed;Y;X;z\n1;0;0;0\n1;0;1,5;0\n1;2;0;0\n", 25.4);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_EQ(contours[0].points_mm[1], Eigen::Vector3d(1.5 * 25.4, 0, 0));
  EXPECT_TRUE(contours[0].normals.empty());
}

TEST(ContourFile, ARepeatedLastPointClosesAndIsDropped) {
  const std::string corner = "0,0,0\n", others = "1,0,0\n0,1,0\n";
  const auto repeated = read("x,y,z\n" + corner + others + corner);
  EXPECT_TRUE(repeated[0].closed);
  EXPECT_EQ(repeated[0].points_mm.size(), 3U);
  EXPECT_FALSE(read("x,y,z\n" + corner + others)[0].closed);
  const auto said = read(kHeader + kTriangle + "0,0,0,0,0,1,1,1\n");
  EXPECT_EQ(said[0].points_mm.size(), 3U);
  EXPECT_EQ(said[0].normals.size(), 3U);
}

TEST(ContourFile, TakesAToolPathAndOtherLineEnds) {
  EXPECT_EQ(read("index,x,y,z,nx,ny,nz,feed_mm_s\n1,0,0,0,0,0,1,20\n2,1,0,0,0,0,1,20\n").size(), 1U);
  EXPECT_EQ(read("\xEF\xBB\xBFx,y,z\r0,0,0\r1,0,0\r")[0].points_mm.size(), 2U);
}

TEST(ContourFile, SurvivesWritingAndReading) {
  std::vector<Contour> written(2);
  written[0].closed = true;
  written[0].points_mm = {{0.1, -0.0000001, 3}, {1e4, 0.333333, 0}, {-7, 8, 9}};
  written[0].normals.assign(3, Eigen::Vector3d(0.6, 0.0, 0.8));
  written[1].points_mm = {{1, 2, 3}, {4, 5, 6}};
  written[1].normals.assign(2, Eigen::Vector3d(1, -2, 2) / 3.0);
  const std::string text = contours_csv(written, "two\nlines");
  EXPECT_EQ(text.find("-0.000000"), std::string::npos);
  const auto back = read(text);
  ASSERT_EQ(back.size(), 2U);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(back[c].id, static_cast<int>(c) + 1);
    EXPECT_EQ(back[c].closed, written[c].closed);
    for (std::size_t i = 0; i < written[c].points_mm.size(); ++i) {
      EXPECT_LT((back[c].points_mm[i] - written[c].points_mm[i]).norm(), 1e-6);
      EXPECT_LT((back[c].normals[i] - written[c].normals[i]).norm(), 1e-8);
    }
  }
  written[1].normals.clear();
  EXPECT_TRUE(read(contours_csv(written, ""))[0].normals.empty());
}

TEST(ContourFile, ReadsTheExamplesContour) {
  const auto contours =
      read_contours(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/example/contour.csv", 1.0);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_TRUE(contours[0].closed);
  EXPECT_EQ(contours[0].normals.size(), contours[0].points_mm.size());
}

TEST(ContourFile, RefusesWithPlaceAndReason) {
  EXPECT_EQ(refusal_of("x,y,z\n0,0,0\n0,zero,0\n"),
            "not a number in column y (edge.csv, line 3): found 'zero'; needed a number; next: correct the "
            "line, or export the contour again");
  const std::pair<const char*, std::string> cases[] = {
      {"holds no points", "# nothing\n"},
      {"holds no points", kHeader},
      {"has no header", "0,0,0,0,0,1\n"},
      {"lacks a column (edge.csv, line 1): found no column z", "x,y\n1,2\n"},
      {"no column nz", "x,y,z,nx,ny\n1,2,3,0,0\n"},
      {"unknown column (edge.csv, line 2): found 'clsed'", "#\nx,y,z,clsed\n1,2,3,1\n"},
      {"unknown column (edge.csv, line 1): found ''", "x,y,z,\n1,2,3,\n"},
      {"stands twice", "x,y,z,x\n1,2,3,1\n"},
      {"wrong number of fields (edge.csv, line 2): found 2; needed 3", "x,y,z\n1,2\n"},
      {"not a finite number in column z", "x,y,z\n1,2,nan\n"},
      {"not a finite number in column z", "x,y,z\n1,2,1e999\n"},
      {"not a number in column z", "x,y,z\n1,2,\n"},
      {"not a whole number in column path", "x,y,z,path\n1,2,3,1.5\n"},
      {"not a yes or no", "x,y,z,closed\n1,2,3,2\n"},
      {"no unit vector (edge.csv, line 2): found length 0", "x,y,z,nx,ny,nz\n1,2,3,0,0,0\n"},
      {"no unit vector", "x,y,z,nx,ny,nz\n1,2,3,0,0,1.02\n"},
      {"closed changes", "x,y,z,closed\n1,2,3,1\n1,2,4,0\n"},
      {"taken up again", "x,y,z,path\n1,2,3,1\n1,2,4,1\n1,2,3,2\n1,2,5,2\n1,2,3,1\n"},
      {"too short (edge.csv, line 2): found 1 points; needed 2", "x,y,z\n1,2,3\n"},
      {"found 2 points; needed 3 for a closed one", "x,y,z,closed\n1,2,3,1\n2,2,3,1\n"}};
  for (const auto& [expected, text] : cases)
    EXPECT_NE(refusal_of(text).find(expected), std::string::npos) << expected << " / " << refusal_of(text);
}

TEST(ContourFile, RefusesAMissingAndAnEmptyFile) {
  const TempFolder folder;
  EXPECT_NE(error_of([&] { (void)read_contours(folder.path() / "none.csv", 1.0); }), "");
  EXPECT_NE(error_of([&] { (void)read_contours(folder.write("empty.csv", ""), 1.0); }), "");
}

}  // namespace
}  // namespace arris
