#include "cli/cell.hpp"

#include <gtest/gtest.h>

#include "tests/cli/run_arris.hpp"

namespace arris {
namespace {

const std::string kFrames =
    "[frames]\nrobot_from_scan = { xyz_mm = [850, 0, 400], quat_wxyz = [0, 0, 0, 1] }\n";

std::string problem_of(const std::string& text) {
  const CellRead read = parse_cell("cell.toml", text);
  return read.problems.empty() ? std::string() : to_line(read.problems.front());
}

TEST(Cell, ReadsFramesToolAndRobot) {
  const CellRead read =
      parse_cell("cell.toml", kFrames +
                                  "[tool]\nname = \"tBrush\"\nxyz_mm = [0, 0, 180]\n"
                                  "[robot]\nturn_speed_deg_s = 90\nspindle_ready = \"\"\n[gpio]\nchip = 3\n");
  ASSERT_TRUE(read.problems.empty()) << to_line(read.problems.front());
  EXPECT_TRUE(
      (read.cell.robot_from_scan * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(849, 0, 400), 1e-12));
  EXPECT_EQ(read.cell.tool_name, "tBrush");
  EXPECT_EQ(read.cell.flange_from_tool.translation().z(), 180.0);
  EXPECT_NEAR(read.cell.turn_speed_rad_s, 1.5707963267948966, 1e-15);
  EXPECT_TRUE(read.cell.spindle_ready.empty());
}

TEST(Cell, DefaultsAreThoseOfTheRoom) {
  const Cell read = parse_cell("cell.toml", kFrames).cell, room;
  EXPECT_EQ(read.tool_name, room.tool_name);
  EXPECT_EQ(read.tool_centre_mm, room.tool_centre_mm);
  EXPECT_NEAR(read.turn_speed_rad_s, room.turn_speed_rad_s, 1e-8);
  EXPECT_TRUE(read.robot_from_work.isApprox(room.robot_from_work));
  EXPECT_TRUE(read.flange_from_tool.isApprox(room.flange_from_tool));
}

TEST(Cell, PrintedDefaultsPassWhenTheFramesAreFilled) {
  std::string text = print_cell(CellFile());
  EXPECT_EQ(parse_cell("c.toml", text).problems.size(), 2u);  // both halves of robot_from_scan
  text.replace(text.find("xyz_mm = []"), 11, "xyz_mm = [1, 2, 3]");
  text.replace(text.find("quat_wxyz = []"), 14, "quat_wxyz = [1, 0, 0, 0]");
  const CellRead read = parse_cell("c.toml", text);
  EXPECT_TRUE(read.problems.empty()) << to_line(read.problems.front());
}

TEST(Cell, EveryKeyKeepsTheLawsOfTheTable) {
  CellFile file;
  std::set<std::string> names;
  for (const Key& key : cell_keys(file)) {
    EXPECT_TRUE(names.insert(key.name).second) << key.name;
    EXPECT_FALSE(key.about.empty()) << key.name;
    const std::string value = value_text(key);
    if (!value.empty() && !key.required) {
      EXPECT_FALSE(check_value(key)) << key.name;
    }
  }
}

TEST(Cell, MessagesNameWhatWhereFoundNeeded) {
  EXPECT_EQ(
      problem_of("[frames]\nrobot_from_scan = { xyz_mm = [0, 0, 0] }\n"),
      "frames.robot_from_scan.quat_wxyz is missing (cell.toml, [frames.robot_from_scan]): found no such "
      "key; needed 4 "
      "numbers; next: add "
      "it: scanner's frame in the robot's base: unit quaternion, w first");
  EXPECT_EQ(problem_of("[frames]\nrobot_from_scan = { xyz_mm = [0, 0, 0], quat_wxyz = [1, 1, 0, 0] }\n"),
            "frames.robot_from_scan.quat_wxyz is no rotation (cell.toml): found length 1.414214; needed a "
            "quaternion of length 1; next: correct it in the cell");
  EXPECT_EQ(problem_of(kFrames + "[robot]\nzone = 1\n"),
            "unknown key robot.zone (cell.toml:4): found the whole number 1; needed a key that arris knows; "
            "next: did you mean robot.zone_mm?");
  EXPECT_NE(problem_of(kFrames + "[tool]\nname = \"my tool\"\n").find("printable ASCII"), std::string::npos);
}

const std::string kTargets =
    "id,kind,x,y,z,diameter_mm,sd_mm\nA,sphere,0,0,0,38.1,0.02\nB,sphere,400,0,50,38.1,0.02\n";

/// What is wrong with a cell whose list of targets holds these rows.
std::string problem_with_targets(const std::string& rows, const std::string& frames = "") {
  const testing::TestFolder folder;
  folder.write("targets.csv", kTargets + rows);
  const CellRead read = parse_cell(folder.path() / "cell.toml",
                                   "[frames]\nscan_reference = \"targets\"\nreferences = \"targets.csv\"\n"
                                   "references_max_residual_mm = 0.3\n" +
                                       frames);
  if (!read.problems.empty()) return to_line(read.problems.front());
  EXPECT_GE(read.cell.targets.size(), 3U);
  EXPECT_EQ(read.cell.targets[1].place_mm, Eigen::Vector3d(400, 0, 50));
  EXPECT_EQ(read.cell.targets_max_residual_mm, 0.3);
  return "";
}

TEST(Cell, TargetsTakeThePlaceOfTheScannersFrame) {
  const auto expect = [](const std::string& problem, const std::string& part) {
    EXPECT_NE(problem.find(part), std::string::npos) << problem;
  };
  EXPECT_EQ(problem_with_targets("C,sphere,100,300,20,38.1,0.02\n"), "");
  expect(problem_of("[frames]\nscan_reference = \"targets\"\n"), "frames.references is missing");
  expect(problem_of("[frames]\nscan_reference = \"targets\"\nreferences = \"nowhere.csv\"\n"), "nowhere.csv");
  expect(problem_with_targets(""), "the wrong number of fixture targets");
  expect(problem_with_targets("C,sphere,800,0,100,38.1,0.02\n"), "nearly on a line");
  expect(problem_with_targets("C,sphere,200,300,25,38.1,0.02\n"), "A for B");
  expect(problem_with_targets("C,sphere,1,1,1,38.1,0.02\n"), "only 1.732 mm apart");
  expect(problem_with_targets("C,sphere,100,300,20,38.1,0.02\n",
                              "robot_from_scan = { xyz_mm = [0, 0, 0], quat_wxyz = [1, 0, 0, 0] }\n"),
         "given beside the targets");
}

TEST(Cell, OfTargetsPrintsAsItIsRead) {
  const testing::TestFolder folder;
  folder.write("targets.csv", kTargets + "C,point,100,300,20,,0.02\n");
  const CellRead read = parse_cell(folder.path() / "cell.toml",
                                   "[frames]\nscan_reference = \"targets\"\nreferences = \"targets.csv\"\n");
  ASSERT_TRUE(read.problems.empty());
  const std::string text = print_cell(read.file, folder.path());
  const CellRead again = parse_cell(folder.path() / "again.toml", text);
  ASSERT_TRUE(again.problems.empty()) << to_line(again.problems.front()) << text;
  EXPECT_EQ(again.cell.targets.size(), 3U);
}

TEST(Cell, FixturesAreGood) {
  const std::filesystem::path fixtures = std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures";
  for (const char* name : {"example", "fe/porthole", "fe/nosecone", "fe/sheet"})
    EXPECT_NO_THROW((void)read_cell(fixtures / name / "cell.toml")) << name;
}

}  // namespace
}  // namespace arris
