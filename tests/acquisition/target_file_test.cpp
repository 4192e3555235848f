#include "acquisition/target_file.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

const std::string kHeader = "id,kind,x,y,z,diameter_mm,sd_mm\n";
const std::string kRows = "A,sphere,1,2,3,38.1,0.02\nB,sphere,400,2,3,38.1,0.02\n";

std::string fault_of(const std::string& text) {
  try {
    (void)read_fixture_targets_csv(text, "t.csv");
  } catch (const Error& error) {
    EXPECT_EQ(exit_code(error.fault()), 3);
    return error.what();
  }
  return "";
}

TEST(TargetFile, ReadsSpheresAndPoints) {
  const auto targets = read_fixture_targets_csv(
      "# fixture 7\n" + kHeader + kRows + "\nC, point, -1.5e2, 300, 40,, 0\r\n", "t");
  ASSERT_EQ(targets.size(), 3U);
  EXPECT_EQ(targets[0].id, "A");
  EXPECT_EQ(targets[0].kind, TargetKind::kSphere);
  EXPECT_EQ(targets[0].diameter_mm, 38.1);
  EXPECT_EQ(targets[2].kind, TargetKind::kPoint);
  EXPECT_EQ(targets[2].place_mm, Eigen::Vector3d(-150, 300, 40));
  EXPECT_EQ(targets[2].sd_mm, 0.0);
}

TEST(TargetFile, ColumnsMayStandInAnyOrder) {
  const auto targets = read_fixture_targets_csv(
      "x,y,z,sd_mm,kind,id\n1,2,3,0.1,point,a\n4,5,6,0.1,point,b\n7,8,0,0.1,point,c\n", "t");
  EXPECT_EQ(targets[1].id, "b");
  EXPECT_EQ(targets[1].place_mm, Eigen::Vector3d(4, 5, 6));
}

TEST(TargetFile, SaysWhatIsWrongAndWhere) {
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(fault_of(text).find(part), std::string::npos) << part << "\n" << fault_of(text);
  };
  expect(kHeader + kRows, "the wrong number of fixture targets");
  expect(kHeader + kRows + "A,sphere,1,2,3,38.1,0.02\n", "a target stands twice (t.csv, line 4)");
  expect(kHeader + kRows + "C,cone,1,2,3,,0.02\n", "unknown kind of target");
  expect(kHeader + kRows + "C,sphere,1,2,3,,0.02\n", "not a number in column diameter_mm");
  expect(kHeader + kRows + "C,sphere,1,2,3,0.5,0.02\n", "5 to 500");
  expect(kHeader + kRows + "C,point,1,2,3,38.1,0.02\n", "a point has no diameter");
  expect(kHeader + kRows + "C,point,1,2,nan,,0.02\n", "not a number in column z");
  expect(kHeader + kRows + "C,point,1,2,3,,\n", "not a number in column sd_mm");
  expect(kHeader + kRows + "C,point,1,2,3\n", "wrong number of fields (t.csv, line 4)");
  expect(kHeader + kRows + ",point,1,2,3,,0\n", "a target has no id");
  expect("id,kind,x,y,z,diameter_mm\n", "no column sd_mm");
  expect("id,kind,x,y,z,radius,sd_mm\n", "unknown column");
  expect("id,id,x,y,z,kind,sd_mm\n", "a column stands twice");
  EXPECT_THROW((void)read_fixture_targets("/nowhere/targets.csv"), Error);
}

TEST(TargetFile, PointsOfTheScannerComeInItsUnit) {
  const auto points = read_scan_targets_csv("id,x,y,z,sd_mm\n17,1,2,3,0.03\n", "t", 25.4);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_TRUE(points[0].place_mm.isApprox(Eigen::Vector3d(25.4, 50.8, 76.2)));
  EXPECT_EQ(points[0].sd_mm, 0.03);
  EXPECT_LT(read_scan_targets_csv("x,y,z\n1,2,3\n", "t", 1.0)[0].sd_mm, 0.0);
  EXPECT_THROW((void)read_scan_targets_csv("x,y,z\n", "t", 1.0), Error);
  EXPECT_THROW((void)read_scan_targets_csv("1,2,3\n", "t", 1.0), Error);
}

}  // namespace
}  // namespace arris
