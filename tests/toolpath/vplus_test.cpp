#include "toolpath/robot/vplus.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "acquisition/types/error.hpp"
#include "tests/toolpath/programs.hpp"
#include "toolpath/robot/compare.hpp"
#include "toolpath/robot/euler_zyz.hpp"
#include "toolpath/robot/read_vplus.hpp"

namespace arris {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const Vector3d kNoOffset = Vector3d::Zero();

Matrix3d zyz(double yaw_deg, double pitch_deg, double roll_deg) {
  const double rad = 3.14159265358979323846 / 180.0;
  return (AngleAxisd(yaw_deg * rad, Vector3d::UnitZ()) * AngleAxisd(pitch_deg * rad, Vector3d::UnitY()) *
          AngleAxisd(roll_deg * rad, Vector3d::UnitZ()))
      .toRotationMatrix();
}

double apart_deg(const Matrix3d& a, const Matrix3d& b) {
  return (a - b).norm() / std::sqrt(2.0) * 57.29577951308232;
}

TEST(EulerZyz, GivesTheAnglesBack) {
  for (double yaw : {-179.0, -90.0, 0.5, 180.0})
    for (double pitch : {0.01, 45.0, 90.0, 179.99})
      for (double roll : {-135.25, 0.0, 12.0, 180.0}) {
        const Vector3d found = yaw_pitch_roll_deg(zyz(yaw, pitch, roll), 4);
        EXPECT_LT((found - Vector3d(yaw, pitch, roll)).cwiseAbs().maxCoeff(), 1e-9) << found.transpose();
      }
}

TEST(EulerZyz, RollIsZeroWhereYawAndRollAreOne) {
  for (double yaw : {-170.0, -33.0, 0.0, 120.0})
    for (double roll : {-100.0, 0.0, 45.0}) {
      const Vector3d up = yaw_pitch_roll_deg(zyz(yaw, 0.0, roll), 4);
      const Vector3d down = yaw_pitch_roll_deg(zyz(yaw, 180.0, roll), 4);
      EXPECT_EQ(up.y(), 0.0);
      EXPECT_EQ(up.z(), 0.0);
      EXPECT_EQ(down.y(), 180.0);
      EXPECT_EQ(down.z(), 0.0);
      EXPECT_NEAR(std::remainder(up.x() - (yaw + roll), 360.0), 0.0, 1e-9);
      EXPECT_NEAR(std::remainder(down.x() - (yaw - roll), 360.0), 0.0, 1e-9);
    }
}

TEST(EulerZyz, TurnsAlikeHoweverNearTheLockIs) {
  for (double off_deg = 10.0; off_deg > 1e-14; off_deg *= 0.5)
    for (double pitch : {off_deg, 180.0 - off_deg}) {
      const Matrix3d meant = zyz(77.7, pitch, -141.3);
      const Vector3d found = yaw_pitch_roll_deg(meant, 4);
      EXPECT_LT(apart_deg(zyz(found.x(), found.y(), found.z()), meant), 2e-4) << off_deg;
    }
}

TEST(EulerZyz, StaysInItsRange) {
  const Vector3d found = yaw_pitch_roll_deg(zyz(-179.99999, 90.0, -180.0), 4);
  EXPECT_EQ(found.x(), 180.0);
  EXPECT_EQ(found.z(), 180.0);
}

std::string text_of(const Cell& cell, bool dry_run = false, int rows = 12) {
  ProgramOptions options;
  options.dry_run = dry_run;
  options.result_hash = test::toy_hash("result");
  options.comments = {"Arris test", "part A-1042 \xC3\xA9\n.END"};
  return write_vplus(make_program(test::ring(rows, 60.0, true), kNoOffset, cell, options), test::toy_hash);
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++count;
  return count;
}

TEST(Vplus, StandsStillBeforeEverySignalAndAtTheEnd) {
  const std::string text = text_of(test::some_cell("vplus"));
  EXPECT_NE(text.find("        BREAK\n        SIGNAL 97\n        TIMER 1 = 0\n"
                      "        WAIT SIG(1097) OR (TIMER(1) > 5.000)\n        IF NOT SIG(1097) THEN\n"
                      "            SIGNAL -97\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("        BREAK\n        SIGNAL -97\n        DETACH ()\n.END\n"), std::string::npos);
}

TEST(Vplus, EveryWayOutSwitchesOff) {
  const std::string text = text_of(test::some_cell("vplus"));
  EXPECT_LT(text.find("REACTE ArrisPath.e\n"), text.find("SIGNAL 97\n"));
  EXPECT_NE(text.find(".PROGRAM ArrisPath.e()\n        SIGNAL -97\n"), std::string::npos);
  EXPECT_EQ(count_of(text, "HALT\n"), 2u);
  EXPECT_EQ(count_of(text, "SIGNAL -97\n"), 3u);
  const std::string dry = text_of(test::some_cell("vplus"), true);
  EXPECT_EQ(dry.find("SIGNAL"), std::string::npos);
  EXPECT_NE(dry.find("; DRY RUN"), std::string::npos);
}

TEST(Vplus, SpeedsHaveTheirUnitAndLinesAreShort) {
  Cell cell = test::some_cell("vplus");
  cell.robot_from_work.translation() << -999000.0, 10.0, 5.0;
  cell.robot_from_scan = cell.robot_from_work;
  cell.reach_mm = 1e6;
  std::istringstream lines(text_of(cell));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 120u) << line;
    if (line.find("SPEED ") != std::string::npos && line.find(';') == std::string::npos) {
      EXPECT_NE(line.find(" MMPS ALWAYS"), std::string::npos) << line;
    }
  }
}

TEST(Vplus, CommentsCannotBreakOut) {
  EXPECT_NE(text_of(test::some_cell("vplus")).find("; part A-1042 ?? .END\n"), std::string::npos);
}

TEST(Vplus, LongProgramsAreSplitAndEachPartStatesItsSpeed) {
  Cell cell = test::some_cell("vplus");
  cell.max_points = 10;
  const std::string text = text_of(cell, false, 20);
  EXPECT_NE(text.find("        CALL ArrisPath.1()\n        CALL ArrisPath.2()\n        CALL ArrisPath.3()\n"),
            std::string::npos);
  EXPECT_EQ(count_of(text, "()\n        AUTO LOC p\n        SPEED "), 3u);
  EXPECT_EQ(read_vplus(text, "p.v2").longest_procedure, 10);
}

// Two polylines: the first one closed.
Correction two_rings() {
  Correction correction = test::ring(12, 60.0, true);
  for (const CorrectedPoint& row : test::ring(8, 25.0, false, 2).points) correction.points.push_back(row);
  return correction;
}

TEST(Vplus, ComesToEachPolylineByAnApproachAndLeavesItByADepart) {
  for (const bool dry_run : {false, true}) {
    ProgramOptions options;
    options.dry_run = dry_run;
    const Program program = make_program(two_rings(), kNoOffset, test::some_cell("vplus"), options);
    const std::string text = write_vplus(program, test::toy_hash);
    EXPECT_EQ(count_of(text, "        APPRO wPart:p, 50.0000\n        BREAK\n"), 1u);  // by the joints
    EXPECT_EQ(count_of(text, "        APPROS wPart:p, 50.0000\n        BREAK\n"), 1u);
    EXPECT_EQ(count_of(text, " MMPS ALWAYS\n        DEPARTS 50.0000\n        BREAK\n"), 2u);
    EXPECT_EQ(count_of(text, "        MOVE "), 0u);
    EXPECT_EQ(count_of(text, "        MOVES wPart:p\n"), 13u + 8u);  // the rows and nothing else
    EXPECT_EQ(count_of(text, "        SET p = TRANS("), 13u + 8u);   // none for a clearance
    EXPECT_EQ(differences(program, read_vplus(text, "p.v2"), test::toy_hash), std::vector<std::string>());
  }
}

// Random rows, gimbal lock among them, each with the clearance before and behind it as a path has them.
Program rows_with_clearance(int rows, double clearance_mm) {
  Program program = test::random_program(8, rows, "vplus");
  program.cell.clearance_mm = clearance_mm;
  program.cell.max_points = 4998;  // three moves a row: no part begins with a departure
  std::vector<Event> events;
  for (const Event& event : program.events) {
    const Move* random = std::get_if<Move>(&event);
    if (random == nullptr) continue;
    Move row = *random, clearance = *random;
    row.row = static_cast<std::ptrdiff_t>(events.size() / 3);
    row.zone_mm = clearance.zone_mm = 0.0;
    clearance.work_from_tool.translation() -= clearance_mm * row.work_from_tool.linear().col(2);
    events.insert(events.end(), {clearance, row, clearance});
  }
  program.events = std::move(events);
  return program;
}

TEST(Vplus, TenThousandApproachesAndDeparturesComeBackWithinAThousandth) {
  const Program meant = rows_with_clearance(10000, 50.0);
  const std::string text = write_vplus(meant, test::toy_hash);
  EXPECT_EQ(count_of(text, " APPRO wPart:p, ") + count_of(text, " APPROS wPart:p, "), 10000u);
  EXPECT_EQ(count_of(text, " DEPART 50.") + count_of(text, " DEPARTS 50."), 10000u);
  EXPECT_EQ(differences(meant, read_vplus(text, "p.v2"), test::toy_hash), std::vector<std::string>());
}

// The angles have 4 decimals: far out their rounding moves the place, and a computed pose is written there.
TEST(Vplus, ALongClearanceIsComputedWhereTheAnglesDigitsDoNotReach) {
  const Program meant = rows_with_clearance(2000, 2000.0);
  const std::string text = write_vplus(meant, test::toy_hash);
  const std::size_t departs = count_of(text, " DEPART 2000.") + count_of(text, " DEPARTS 2000.");
  EXPECT_GT(departs, 0u);
  EXPECT_LT(departs, 2000u);
  EXPECT_EQ(differences(meant, read_vplus(text, "p.v2"), test::toy_hash), std::vector<std::string>());
}

TEST(Vplus, AClearanceThatIsNotTheRowMovedBackIsComputed) {
  const auto no_edit = [](Move&) {};
  const auto aside = [](Move& move) { move.work_from_tool.translation().x() += 0.01; };
  const auto higher = [](Move& move) { move.work_from_tool.translation().z() += 0.01; };
  const auto turned = [](Move& move) {
    move.work_from_tool.linear() *= AngleAxisd(1e-4, Vector3d::UnitZ()).toRotationMatrix();
  };
  const auto text_with = [](void (*edit)(Move&)) {
    Program program = make_program(test::ring(12, 60.0, false), kNoOffset, test::some_cell("vplus"), {});
    for (Event& event : program.events)
      if (Move* move = std::get_if<Move>(&event); move != nullptr && move->row < 0) edit(*move);
    std::string text = write_vplus(program, test::toy_hash);
    EXPECT_EQ(differences(program, read_vplus(text, "p.v2"), test::toy_hash), std::vector<std::string>());
    return text;
  };
  EXPECT_EQ(count_of(text_with(no_edit), "APPRO ") + count_of(text_with(no_edit), "DEPARTS "), 2u);
  for (void (*edit)(Move&) : {+aside, +higher, +turned}) {
    const std::string text = text_with(edit);
    EXPECT_EQ(count_of(text, "APPRO ") + count_of(text, "DEPARTS "), 0u);
    EXPECT_EQ(count_of(text, "        MOVE wPart:p\n"), 1u);
    EXPECT_EQ(count_of(text, "        MOVES wPart:p\n"), 12u + 1u);
  }
}

TEST(Vplus, NoPartBeginsWithADepart) {
  Cell cell = test::some_cell("vplus");
  cell.max_points = 14;  // clearance and 13 rows: the last clearance is a part of its own
  const std::string text = text_of(cell);
  const std::size_t part = text.find(".PROGRAM ArrisPath.2()\n        AUTO LOC p\n        SPEED ");
  ASSERT_NE(part, std::string::npos);
  EXPECT_LT(text.find("        SET p = TRANS(", part), text.find("        MOVES wPart:p\n", part));
  EXPECT_EQ(count_of(text, "DEPART"), 0u);
}

TEST(Vplus, AnotherDistanceOrKindOfClearanceIsNoticed) {
  const Program program = make_program(two_rings(), kNoOffset, test::some_cell("vplus"), {});
  const std::string text = write_vplus(program, test::toy_hash);
  const std::pair<const char*, const char*> edits[] = {{"APPRO wPart:p, 50.0000", "APPRO wPart:p, 50.0020"},
                                                       {"APPRO wPart:p, 50.", "APPRO wPart:p, -50."},
                                                       {"APPRO wPart:p", "APPROS wPart:p"},
                                                       {"APPROS wPart:p", "APPRO wPart:p"},
                                                       {"DEPARTS 50.0000", "DEPARTS 50.0020"},
                                                       {"DEPARTS 50.", "DEPARTS -50."},
                                                       {"DEPARTS", "DEPART"}};
  for (const auto& [from, to] : edits) {
    std::string other = text;
    other.replace(other.find(from), std::string(from).size(), to);
    const Reading read = read_vplus(other, "p.v2");
    const auto no_hash = [&](std::string_view) { return read.body_sha256; };
    EXPECT_EQ(differences(program, read, no_hash).size(), 1u) << to;
  }
}

TEST(Vplus, TheFrameCanComeFromTaughtPoints) {
  Cell cell = test::some_cell("vplus");
  cell.work_points = "pa, pb, pc";
  const Program program = make_program(test::ring(12, 60.0, true), kNoOffset, cell, {});
  const std::string text = write_vplus(program, test::toy_hash);
  EXPECT_NE(text.find("SET wPart = FRAME(pa, pb, pc, pa)\n"), std::string::npos);
  EXPECT_TRUE(differences(program, read_vplus(text, "p.v2"), test::toy_hash).empty());
  std::string other = text;
  other.replace(text.find("pb, pc"), 6, "pc, pb");
  const auto found = differences(program, read_vplus(other, "p.v2"), test::toy_hash);
  EXPECT_NE(std::find(found.begin(), found.end(), "the work object through other points"), found.end());
}

TEST(Vplus, AnOutputBehindAMoveThatPassesIsABug) {
  Program program = make_program(test::ring(12, 60.0, true), kNoOffset, test::some_cell("vplus"), {});
  std::get<Move>(program.events[0]).zone_mm = 0.3;
  try {
    (void)write_vplus(program, test::toy_hash);
    FAIL() << "written";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kBug);
  }
}

struct BadCell {
  void (*spoil)(Cell&);
  const char* says;
};
class VplusRefuses : public testing::TestWithParam<BadCell> {};

TEST_P(VplusRefuses, NamingFieldValueAndBound) {
  Cell cell = test::some_cell("vplus");
  GetParam().spoil(cell);
  try {
    (void)text_of(cell);
    FAIL() << GetParam().says;
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kRecipe);
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

const BadCell kBadCells[] = {
    {[](Cell& c) { c.spindle_output = "doSpindle"; }, "cell.spindle_output = \"doSpindle\", need for V+"},
    {[](Cell& c) { c.spindle_output = "1097"; }, "\"1\" to \"999\""},
    {[](Cell& c) { c.spindle_output = "-97"; }, "\"1\" to \"999\""},
    {[](Cell& c) { c.spindle_output = "097"; }, "\"1\" to \"999\""},
    {[](Cell& c) { c.spindle_ready = "97"; }, "\"1001\" to \"1999\""},
    {[](Cell& c) { c.program_name = "ArrisPorthole1"; }, "need at most 15 characters"},
    {[](Cell& c) { c.tool_name = "tSpindleOfTheArm"; }, "need a V+ name"},
    {[](Cell& c) { c.work_name = "Frame"; }, "that V+ and the program leave free"},
    {[](Cell& c) { c.work_name = "p"; }, "that V+ and the program leave free"},
    {[](Cell& c) { c.tool_name = "null"; }, "leave free"},
    {[](Cell& c) { c.work_name = "TSPINDLE"; }, "that no other field has"},
    {[](Cell& c) { c.work_points = "pa, pb"; }, "need three taught points"},
    {[](Cell& c) { c.work_points = "pa, pb, pa"; }, "that no other field has"},
    {[](Cell& c) { c.work_points = "pa, pb, pc, pd"; }, "need a V+ name"},
    {[](Cell& c) { c.robot_number = 0; }, "cell.robot_number"},
    {[](Cell& c) { c.turn_speed_ratio = 0.0; }, "cell.turn_speed_ratio"}};

INSTANTIATE_TEST_SUITE_P(Vplus, VplusRefuses, testing::ValuesIn(kBadCells));

}  // namespace
}  // namespace arris
