#include "toolpath/robot/program.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"
#include "tests/toolpath/programs.hpp"
#include "toolpath/robot/rapid.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using test::ring;
using test::some_cell;

const Vector3d kNoOffset = Vector3d::Zero();

std::vector<Move> moves_of(const Program& program) {
  std::vector<Move> moves;
  for (const Event& event : program.events)
    if (const auto* move = std::get_if<Move>(&event)) moves.push_back(*move);
  return moves;
}

TEST(Program, GoesToClearanceSwitchesOnWaitsCutsClosesAndSwitchesOff) {
  const Correction correction = ring(72, 60.0, true);
  const Cell cell = some_cell();
  const Program program = make_program(correction, kNoOffset, cell, {});
  ASSERT_EQ(program.events.size(), 1u + 2u + 72u + 1u + 1u + 1u);
  EXPECT_TRUE(std::get<Move>(program.events[0]).joint);
  EXPECT_TRUE(std::get<SetOutput>(program.events[1]).on);
  EXPECT_EQ(std::get<WaitInput>(program.events[2]).off, cell.spindle_output);
  EXPECT_FALSE(std::get<SetOutput>(program.events.back()).on);
  const std::vector<Move> moves = moves_of(program);
  EXPECT_EQ(moves[73].row, 0);  // back to the first row
  EXPECT_LT((moves[73].work_from_tool.translation() - moves[1].work_from_tool.translation()).norm(), 1e-12);
  for (std::size_t i : {0u, 1u, 73u, 74u}) EXPECT_EQ(moves[i].zone_mm, 0.0) << i;
  EXPECT_EQ(moves[5].zone_mm, 0.3);
}

TEST(Program, TipsAndAxesAreWhereTheCellPutsThem) {
  const Correction correction = ring(30, 60.0, false);
  const Cell cell = some_cell();
  const Vector3d offset_mm(100.0, -50.0, 7.0);
  const std::vector<Move> moves = moves_of(make_program(correction, offset_mm, cell, {}));
  ASSERT_EQ(moves.size(), 32u);
  for (std::size_t i = 0; i < 30; ++i) {
    const RigidMotion robot_from_tool = cell.robot_from_work * moves[i + 1].work_from_tool;
    const Vector3d tip_mm = cell.robot_from_scan * (correction.points[i].point.tip_mm + offset_mm);
    EXPECT_LT((robot_from_tool.translation() - tip_mm).norm(), 1e-9);
    EXPECT_LT(
        (robot_from_tool.linear().col(2) + cell.robot_from_scan.linear() * correction.points[i].point.axis)
            .norm(),
        1e-12);
    EXPECT_NEAR(robot_from_tool.linear().determinant(), 1.0, 1e-12);
  }
}

TEST(Program, TheDryRunIsTheSamePathOffThePartSlowerAndSwitchesNothing) {
  const Cell cell = some_cell();
  Correction correction = ring(40, 60.0, true);
  correction.points[3].point.feed_mm_s = 7.0;
  ProgramOptions options;
  const Program cut = make_program(correction, kNoOffset, cell, options);
  options.dry_run = true;
  const Program dry = make_program(correction, kNoOffset, cell, options);
  EXPECT_EQ(dry.name, "ArrisPathDry");
  const std::vector<Move> meant = moves_of(cut), shown = moves_of(dry);
  EXPECT_EQ(dry.events.size(), shown.size());
  ASSERT_EQ(meant.size(), shown.size());
  EXPECT_EQ(meant[4].speed_mm_s, 7.0);
  for (std::size_t i = 0; i < meant.size(); ++i) {
    const Vector3d lift_mm = shown[i].work_from_tool.translation() - meant[i].work_from_tool.translation();
    EXPECT_LT((lift_mm + cell.dry_run_offset_mm * meant[i].work_from_tool.linear().col(2)).norm(), 1e-9);
    EXPECT_NEAR((shown[i].work_from_tool.linear() - meant[i].work_from_tool.linear()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(shown[i].speed_mm_s, 0.5 * meant[i].speed_mm_s, 1e-12);
  }
}

TEST(Program, ZonesStayBelowHalfAStep) {
  Correction correction = ring(40, 60.0, false);
  correction.points[11].point.tip_mm = correction.points[10].point.tip_mm + Vector3d(0.2, 0.0, 0.0);
  correction.points[21].point.tip_mm = correction.points[20].point.tip_mm;  // a row twice
  const std::vector<Move> moves = moves_of(make_program(correction, kNoOffset, some_cell(), {}));
  EXPECT_EQ(moves[11].zone_mm, 0.075);
  EXPECT_EQ(moves[12].zone_mm, 0.075);
  EXPECT_EQ(moves[21].zone_mm, 0.0);
  for (std::size_t i = 1; i + 1 < moves.size(); ++i) {
    const double step_mm =
        (moves[i + 1].work_from_tool.translation() - moves[i].work_from_tool.translation()).norm();
    EXPECT_LE(moves[i].zone_mm, 0.5 * step_mm + 1e-12);
  }
}

TEST(Program, AirMovesGoAtTheApproachSpeed) {
  Correction correction = ring(10, 60.0, false);
  correction.points[9].air_move = true;
  const std::vector<Move> moves = moves_of(make_program(correction, kNoOffset, some_cell(), {}));
  EXPECT_EQ(moves[9].speed_mm_s, 20.0);
  EXPECT_EQ(moves[10].speed_mm_s, 100.0);
}

TEST(Program, IsNotMadeOfARefusedCorrectionNorBeyondReach) {
  Correction refused = ring(10, 60.0, false);
  refused.reasons.push_back("too far");
  EXPECT_THROW((void)make_program(refused, kNoOffset, some_cell(), {}), Error);
  try {
    (void)make_program(ring(10, 60.0, false), Vector3d(665171.0, 5648298.0, 0.0), some_cell(), {});
    FAIL() << "made";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kRecipe);
    EXPECT_NE(std::string(error.what()).find("leaves the robot's reach"), std::string::npos) << error.what();
  }
}

struct BadCell {
  void (*spoil)(Cell&);
  const char* says;
};
class CellRefuses : public testing::TestWithParam<BadCell> {};

TEST_P(CellRefuses, NamingFieldValueAndBound) {
  Cell cell = some_cell();
  GetParam().spoil(cell);
  try {
    const Program program = make_program(ring(5, 60.0, false), kNoOffset, cell, {});
    (void)write_rapid(program, test::toy_hash);
    FAIL() << GetParam().says;
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kRecipe);
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

const BadCell kBadCells[] = {
    {[](Cell& c) { c.tool_mass_kg = 0.0; }, "cell.tool_mass_kg = 0.000000, need > 0"},
    {[](Cell& c) { c.cut_speed_mm_s = std::nan(""); }, "cell.cut_speed_mm_s = not finite"},
    {[](Cell& c) { c.zone_mm = -1.0; }, "cell.zone_mm"},
    {[](Cell& c) { c.dry_run_speed_ratio = 1.5; }, "cell.dry_run_speed_ratio"},
    {[](Cell& c) { c.dry_run_offset_mm = 0.0; }, "cell.dry_run_offset_mm"},
    {[](Cell& c) { c.clearance_mm = 0.0; }, "cell.clearance_mm"},
    {[](Cell& c) { c.ready_timeout_s = 0.0; }, "cell.ready_timeout_s"},
    {[](Cell& c) { c.max_points = 1; }, "cell.max_points"},
    {[](Cell& c) { c.robot_from_scan.linear() *= 2.0; }, "cell.robot_from_scan = not a rotation"},
    {[](Cell& c) { c.tool_name = ""; }, "cell.tool_name"},
    {[](Cell& c) { c.tool_name = "t\xC3\xB6ol"; }, "cell.tool_name"},
    {[](Cell& c) { c.work_name = "MoveL"; }, "that RAPID and the program leave free"},
    {[](Cell& c) { c.work_name = "P12"; }, "that RAPID and the program leave free"},
    {[](Cell& c) { c.work_name = "1part"; }, "need a RAPID name"},
    {[](Cell& c) { c.work_name = "TSPINDLE"; }, "that no other field has"},
    {[](Cell& c) { c.tool_name = "tool0"; }, "leave free"},
    {[](Cell& c) { c.spindle_output.clear(); }, "cell.spindle_ready"}};

INSTANTIATE_TEST_SUITE_P(Program, CellRefuses, testing::ValuesIn(kBadCells));

TEST(Rapid, WritesTheSameBytesAndHashesItself) {
  const Program program = make_program(ring(12, 60.0, true), kNoOffset, some_cell(), {});
  const std::string text = write_rapid(program, test::toy_hash);
  EXPECT_EQ(text, write_rapid(program, test::toy_hash));
  const std::size_t digits = text.find("  ! body_sha256 = ") + 18;
  EXPECT_EQ(text.substr(digits, 64), test::toy_hash(text.substr(0, digits) + text.substr(digits + 64)));
  for (char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
  EXPECT_EQ(text.find('E', text.find("robtarget")), text.find("9E9", text.find("robtarget")) + 1);
}

TEST(Rapid, CommentsCannotBreakOut) {
  ProgramOptions options;
  options.comments = {"part\nENDMODULE \xC3\xA9"};
  const std::string text =
      write_rapid(make_program(ring(3, 60.0, false), kNoOffset, some_cell(), options), test::toy_hash);
  EXPECT_NE(text.find("  ! part ENDMODULE ??\n"), std::string::npos);
}

TEST(Rapid, LongProgramsAreSplit) {
  Cell cell = some_cell();
  cell.max_points = 10;
  const std::string text =
      write_rapid(make_program(ring(20, 60.0, true), kNoOffset, cell, {}), test::toy_hash);
  EXPECT_NE(text.find("    part1;\n    part2;\n    part3;\n  ERROR\n    SetDO doSpindle,0;\n    RAISE;\n"),
            std::string::npos);
  EXPECT_NE(text.find("  PROC part3()\n"), std::string::npos);
}

}  // namespace
}  // namespace arris
