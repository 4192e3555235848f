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
  EXPECT_EQ(problem_of("[frames]\nrobot_from_scan = { xyz_mm = [0, 0, 0] }\n"),
            "frames.robot_from_scan.quat_wxyz is missing (cell.toml, [frames.robot_from_scan]): needed 4 "
            "numbers; next: add "
            "it: scanner's frame in the robot's base: unit quaternion, w first");
  EXPECT_EQ(problem_of("[frames]\nrobot_from_scan = { xyz_mm = [0, 0, 0], quat_wxyz = [1, 1, 0, 0] }\n"),
            "frames.robot_from_scan.quat_wxyz is no rotation: found length 1.414214; needed a quaternion of "
            "length 1 "
            "(cell.toml)");
  EXPECT_EQ(problem_of(kFrames + "[robot]\nzone = 1\n"),
            "unknown key robot.zone (cell.toml:4): next: did you mean robot.zone_mm?");
  EXPECT_NE(problem_of(kFrames + "scan_reference = \"targets\"\n").find("is not in this version yet"),
            std::string::npos);
  EXPECT_NE(problem_of(kFrames + "[tool]\nname = \"my tool\"\n").find("printable ASCII"), std::string::npos);
}

TEST(Cell, FixturesAreGood) {
  const std::filesystem::path fixtures = std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures";
  for (const char* name : {"example", "fe/porthole", "fe/nosecone", "fe/sheet"})
    EXPECT_NO_THROW((void)read_cell(fixtures / name / "cell.toml")) << name;
}

}  // namespace
}  // namespace arris
