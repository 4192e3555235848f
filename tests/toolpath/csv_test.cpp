#include "toolpath/formats/csv.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"

namespace arris {
namespace {

std::string refusal(const std::string& text) {
  try {
    (void)read_path_csv(text, "p.csv");
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInput);
    return error.what();
  }
  return "accepted";
}

const std::string kHead = "x,y,z,nx,ny,nz\n";

TEST(PathCsv, ReadsTheStandardHeader) {
  const PathCsv csv =
      read_path_csv("# a comment\n" + kHead + "1,2,3,0,0,1\r\n\n-4.5,5e0,+6,0,0.6,0.8\n", "p.csv");
  ASSERT_EQ(csv.path.points.size(), 2u);
  EXPECT_EQ(csv.path.points[1].tip_mm, Eigen::Vector3d(-4.5, 5.0, 6.0));
  EXPECT_LT((csv.path.points[1].axis - Eigen::Vector3d(0.0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_FALSE(csv.path.has_path_column);
  EXPECT_EQ(csv.path.source, "p.csv");
  EXPECT_TRUE(csv.notes.empty());
}

TEST(PathCsv, ReadsColumnsInAnyOrderAndCase) {
  const PathCsv csv = read_path_csv(
      "\xEF\xBB\xBF"
      "feed_mm_s, Path, X,y,z, NX,ny,nz,closed\n"
      "12.5,3,1,2,3,0,0,1,1\n12.5,3,2,2,3,0,0,1,1\n9,1,7,2,3,1,0,0,0\n",
      "p.csv");
  ASSERT_EQ(csv.path.points.size(), 3u);
  EXPECT_EQ(csv.path.points[0].feed_mm_s, 12.5);
  EXPECT_EQ(csv.path.points[0].path, 3);
  EXPECT_TRUE(csv.path.points[0].closed);
  EXPECT_EQ(csv.path.points[2].path, 1);
  const std::vector<PathRange> ranges = polylines(csv.path);
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_TRUE(ranges[0].closed);
  EXPECT_EQ(ranges[1].begin, 2u);
}

TEST(PathCsv, ReadsFilesWithoutHeaderAsTheyAreFound) {
  const PathCsv csv = read_path_csv(
      " Line 1,,,,,,\n Line 2,,,,,,\n1,78.9,0,23.7,0,1,0\n2,78.7,0,21.2,0,1,0\n"
      " Line 3,,,,,,\n7,1,0,21.2,0,1,0\n",
      "p.csv");
  ASSERT_EQ(csv.path.points.size(), 3u);
  EXPECT_EQ(csv.path.points[0].tip_mm, Eigen::Vector3d(78.9, 0.0, 23.7));
  EXPECT_EQ(csv.path.index, (std::vector<long>{1, 2, 7}));
  EXPECT_EQ(polylines(csv.path).size(), 2u);
  ASSERT_EQ(csv.notes.size(), 1u);
  EXPECT_EQ(csv.notes[0], "3 separator lines, read as 2 polylines");
  EXPECT_EQ(read_path_csv("1,2,3,0,0,1\n", "p.csv").path.points[0].tip_mm.z(), 3.0);
}

TEST(PathCsv, BringsAxesToLengthOneWithinOnePercent) {
  const PathCsv csv = read_path_csv(kHead + "0,0,0,0,0,1.009\n0,0,0,0,0,0.99995\n", "p.csv");
  EXPECT_EQ(csv.path.points[0].axis.z(), 1.0);
  ASSERT_EQ(csv.notes.size(), 1u);
  EXPECT_EQ(csv.notes[0].substr(0, 6), "1 axes");
}

struct Refused {
  const char* text;
  const char* says;
};

class PathCsvRefuses : public testing::TestWithParam<Refused> {};

TEST_P(PathCsvRefuses, WithTheLineAndTheReason) {
  const std::string line = refusal(GetParam().text);
  EXPECT_NE(line.find(GetParam().says), std::string::npos) << line;
}

const Refused kRefused[] = {
    {"", "the tool path file is empty (p.csv)"},
    {" \n\n", "empty"},
    {"x,y,z,nx,ny,nz\n", "the tool path has no rows"},
    {"# only\n", "no rows"},
    {"x,y,z,nx,ny,nz,fed_mm_s\n", "p.csv, line 1): found 'fed_mm_s'"},
    {"x,y,z,nx,ny,nz,fed_mm_s\n", "did you mean 'feed_mm_s'?"},
    {"x,y,z,nx,ny\n", "no column 'nz'"},
    {"x,y,z,nx,ny,nz,x\n", "a column stands twice"},
    {"x;y;z;nx;ny;nz\n", "not separated by commas"},
    {"x,y,z,nx,ny,nz\n1,2,3,0,0\n", "line 2): found 5; needed 6"},
    {"x,y,z,nx,ny,nz\n1,2,3,0,0,1\n1,2,abc,0,0,1\n", "column z (p.csv, line 3): found 'abc'"},
    {"x,y,z,nx,ny,nz\n1,2,nan,0,0,1\n", "not a finite number in column z"},
    {"x,y,z,nx,ny,nz\n1,2,1e999,0,0,1\n", "column z"},
    {"x,y,z,nx,ny,nz\n1,2,inf,0,0,1\n", "not a finite number"},
    {"x,y,z,nx,ny,nz\n1,2,3,0,,1\n", "not a number in column ny"},
    {"x,y,z,nx,ny,nz\n1,2,3,0,0,1.02\n", "not a unit vector"},
    {"x,y,z,nx,ny,nz\n1,2,3,0,0,0\n", "length 0.0"},
    {"x,y,z,nx,ny,nz,path\n1,2,3,0,0,1,1.5\n", "not a whole number in column path"},
    {"x,y,z,nx,ny,nz,path\n1,2,3,0,0,1,1\n1,2,3,0,0,1,2\n1,2,3,0,0,1,1\n", "polyline 1 is taken up again"},
    {"x,y,z,nx,ny,nz,closed\n1,2,3,0,0,1,2\n", "0 or 1"},
    {"x,y,z,nx,ny,nz,closed\n1,2,3,0,0,1,1\n1,2,3,0,0,1,0\n", "closed changes within polyline 1"},
    {"x,y,z,nx,ny,nz,feed_mm_s\n1,2,3,0,0,1,-2\n", "a negative feed"},
    {"1,2,3,0,0\n", "without a header"},
    {"hello\n", "unknown column"},
    {"# result_hash = ab\nx,y,z,nx,ny,nz\n", "corrected already"},
    {"x,y,z,nx,ny,nz,shift_mm\n", "corrected already"}};

INSTANTIATE_TEST_SUITE_P(PathCsv, PathCsvRefuses, testing::ValuesIn(kRefused));

Correction carried(const ToolPath& nominal) {
  Correction correction;
  for (const PathPoint& row : nominal.points) {
    CorrectedPoint point;
    point.point = row;
    point.shift_mm = 1.25;
    point.shift_normal_mm = -1e-9;
    point.sd_axis_rad = 0.001;
    correction.points.push_back(point);
  }
  correction.points.back().from_data = true;
  return correction;
}

TEST(CorrectedCsv, KeepsColumnsOrderAndNumberAndAddsTheOffset) {
  const ToolPath nominal =
      read_path_csv("path,nx,ny,nz,x,y,z\n4,0,0,1,1,2,3\n4,0,-1,0,0.0000001,0,-0.0000001\n", "p.csv").path;
  const std::string text =
      write_corrected_csv(nominal, carried(nominal), Eigen::Vector3d(1000.0, 0.0, 0.0), "abc123");
  EXPECT_EQ(
      text,
      "# result_hash = abc123\n"
      "path,nx,ny,nz,x,y,z,shift_mm,shift_normal_mm,shift_across_mm,sd_normal_mm,sd_across_mm,sd_along_mm,"
      "sd_axis_deg,source\n"
      "4,0.000000,0.000000,1.000000,1001.000000,2.000000,3.000000,1.250000,0.000000,0.000000,0.000000,0."
      "000000,"
      "0.000000,0.057296,prior\n"
      "4,0.000000,-1.000000,0.000000,1000.000000,0.000000,0.000000,1.250000,0.000000,0.000000,0.000000,0."
      "000000,"
      "0.000000,0.057296,data\n");
}

TEST(CorrectedCsv, IsRefusedAsANominalPath) {
  const ToolPath nominal = read_path_csv(kHead + "1,2,3,0,0,1\n", "p.csv").path;
  EXPECT_NE(refusal(write_corrected_csv(nominal, carried(nominal), Eigen::Vector3d::Zero(), "ab"))
                .find("corrected"),
            std::string::npos);
}

TEST(CorrectedCsv, IsNotWrittenOfARefusedOrForeignCorrection) {
  const ToolPath nominal = read_path_csv(kHead + "1,2,3,0,0,1\n", "p.csv").path;
  Correction refused = carried(nominal);
  refused.reasons.push_back("too far");
  EXPECT_THROW((void)write_corrected_csv(nominal, refused, Eigen::Vector3d::Zero(), "ab"), Error);
  EXPECT_THROW((void)write_corrected_csv(ToolPath{}, carried(nominal), Eigen::Vector3d::Zero(), "ab"), Error);
}

TEST(PathCsv, WrittenAndReadAgainIsThePath) {
  const std::string text =
      "index,x,y,z,nx,ny,nz,feed_mm_s,closed\n"
      "5,1.000000,-2.500000,3.000000,0.000000,0.000000,1.000000,12.000000,1\n"
      "6,1.100000,-2.500000,3.000000,0.000000,0.000000,1.000000,12.000000,1\n";
  EXPECT_EQ(write_path_csv(read_path_csv(text, "p.csv").path), text);
  const std::string lines = " a,,,,,\n1,2,3,0,0,1\n b,,,,,\n1,2,4,0,0,1\n";
  const ToolPath two = read_path_csv(lines, "p.csv").path;
  EXPECT_EQ(polylines(read_path_csv(write_path_csv(two), "q.csv").path).size(), 2u);
}

TEST(FixedText, NeverWritesMinusZeroOrExponents) {
  EXPECT_EQ(fixed_text(-0.0004, 3), "0.000");
  EXPECT_EQ(fixed_text(-0.0, 0), "0");
  EXPECT_EQ(fixed_text(-0.0006, 3), "-0.001");
  EXPECT_EQ(fixed_text(1e15, 1), "1000000000000000.0");
  EXPECT_EQ(fixed_text(1e-12, 4), "0.0000");
  EXPECT_THROW((void)fixed_text(std::nan(""), 3), Error);
}

}  // namespace
}  // namespace arris
