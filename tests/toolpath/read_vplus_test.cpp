#include "toolpath/robot/read_vplus.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

// A program as people write them by hand: taught frame, APPROS and DEPARTS, no hash.
const std::string kByHand =
    ".PROGRAM deburr1()\n"
    "; result_hash = 12ab\n"
    "        AUTO LOC here.1\n"
    "\n"
    "        SELECT ROBOT = 1\n"
    "        ATTACH ()\n"
    "        SET spindle = TRANS(0, 0, 180, 0, 0, 0)\n"
    "        TOOL spindle\n"
    "        SET part = FRAME(pa, pb, pc, pa)\n"
    "        SET here.1 = TRANS(10, 0, 2.5, 0, 180, 0)\n"
    "        SPEED 100 MMPS ALWAYS\n"
    "        APPRO part:here.1, 50\n"
    "        BREAK\n"
    "        SIGNAL 97\n"
    "        TIMER 1 = 0\n"
    "        WAIT SIG(1097) OR (TIMER(1) > 5)\n"
    "        IF NOT SIG(1097) THEN\n"
    "            SIGNAL -97\n"
    "            TYPE \"spindle not ready\"\n"
    "            HALT\n"
    "        END\n"
    "        SPEED 20, 10 MMPS ALWAYS ; cut\n"
    "        MOVES part:here.1\n"
    "        MOVES part:TRANS(20, 5, 0, 90, 90, 0)\n"
    "        BREAK\n"
    "        DEPARTS 50\n"
    "        BREAK\n"
    "        SIGNAL -97\n"
    "        DETACH ()\n"
    ".END\n";

std::string edited(const std::string& from, const std::string& to) {
  std::string text = kByHand;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void expect_pose(const ReadMove& move, std::array<double, 3> xyz_mm, std::array<double, 4> quat_wxyz) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(move.pose.xyz_mm[i], xyz_mm[i], 1e-12) << i;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(move.pose.quat_wxyz[i], quat_wxyz[i], 1e-12) << i;
}

TEST(ReadVplus, ReadsWhatTheControllerWouldDo) {
  const Reading read = read_vplus(kByHand, "hand.v2");
  EXPECT_EQ(read.name, "deburr1");
  EXPECT_EQ(read.result_hash, "12ab");
  EXPECT_EQ(read.hashed_text, kByHand);
  EXPECT_EQ(read.robot, 1);
  ASSERT_EQ(read.events.size(), 7u);
  const auto& first = std::get<ReadMove>(read.events[0]);
  EXPECT_TRUE(first.joint);
  EXPECT_EQ(first.speed_mm_s, 100.0);
  EXPECT_EQ(first.turn_ratio, 1.0);
  EXPECT_EQ(first.zone_mm, 0.0);
  EXPECT_EQ(first.tool, "spindle");
  EXPECT_EQ(first.work, "part");
  expect_pose(first, {10.0, 0.0, 52.5}, {0.0, 0.0, 1.0, 0.0});  // tool down: back along its z is up
  EXPECT_EQ(std::get<ReadSet>(read.events[1]).output, "97");
  EXPECT_EQ(std::get<ReadWait>(read.events[2]).timeout_s, 5.0);
  EXPECT_EQ(std::get<ReadWait>(read.events[2]).on_timeout.at(0).value, 0);
  const auto& passes = std::get<ReadMove>(read.events[3]);
  EXPECT_FALSE(passes.zone_mm.has_value());
  EXPECT_EQ(passes.turn_ratio, 0.1);
  expect_pose(std::get<ReadMove>(read.events[4]), {20.0, 5.0, 0.0}, {0.5, -0.5, 0.5, 0.5});
  expect_pose(std::get<ReadMove>(read.events[5]), {20.0, -45.0, 0.0}, {0.5, -0.5, 0.5, 0.5});
  EXPECT_EQ(std::get<ReadSet>(read.events[6]).value, 0);
  EXPECT_EQ(read.tools.at("spindle").flange_from_tool.xyz_mm[2], 180.0);
  EXPECT_EQ(read.taught_works.at("part").plane, "pc");
  EXPECT_TRUE(read.on_error.empty());
}

TEST(ReadVplus, KnowsNoCaseAndTakesWindowsLines) {
  std::string text = edited("MOVES part:here.1", "moves PART:Here.1");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  const Reading read = read_vplus(text, "hand.v2");
  EXPECT_EQ(read.events.size(), 7u);
  EXPECT_EQ(std::get<ReadMove>(read.events[3]).work, "part");
}

struct Edit {
  const char *from, *to, *says;
};
class ReadVplusRefuses : public testing::TestWithParam<Edit> {};

TEST_P(ReadVplusRefuses, WithLineAndReason) {
  try {
    (void)read_vplus(edited(GetParam().from, GetParam().to), "hand.v2");
    ADD_FAILURE() << "accepted: " << GetParam().to;
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInput);
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("hand.v2, line "), std::string::npos) << error.what();
  }
}

const Edit kEdits[] = {
    {"SPEED 100 MMPS", "SPEED 100", "the word mmps"},
    {"SPEED 100 MMPS ALWAYS", "SPEED 100 MMPS", "the word always"},
    {"SPEED 100 MMPS", "SPEED 100 IPS", "the word mmps"},
    {"SPEED 20, 10", "SPEED 20, 110", "a turning speed"},
    {"SPEED 20", "SPEED -20", "a speed that is not above 0"},
    {"        SPEED 100 MMPS ALWAYS\n", "", "a move without a speed"},
    {"        BREAK\n        SIGNAL 97", "        SIGNAL 97",
     "line 13): found a SIGNAL while the robot moves"},
    {"        BREAK\n        SIGNAL -97", "        SIGNAL -97", "a SIGNAL while the robot moves"},
    {"        BREAK\n        SIGNAL -97\n        DETACH ()", "        DETACH ()", "DETACH while the robot"},
    {"        BREAK\n        SIGNAL -97\n        DETACH ()\n", "", "the end while the robot moves"},
    {"        TIMER 1 = 0\n", "", "a timer that may be at any time"},
    {"TIMER 1 = 0", "TIMER 2 = 0", "a timer that may be at any time"},
    {"TIMER 1 = 0", "TIMER 1 = 3", "does not start at 0"},
    {"IF NOT SIG(1097)", "IF NOT SIG(1098)", "is not looked at"},
    {"IF NOT SIG(1097)", "IF NOT SIG(-1097)", "is not looked at"},
    {"            HALT\n", "", "a handler that goes on"},
    {"            SIGNAL -97\n", "            BREAK\n", "another statement in a handler"},
    {"        END\n", "", "the word end"},
    {"MOVES part:here.1", "MOVES part:there", "the location there"},
    {"MOVES part:here.1", "MOVE part here.1", "the end of the line"},
    {"DEPARTS 50", "DEPARTS", "a number"},
    {"APPRO part:here.1", "APPROS part:there", "the location there"},  // the first move: no pose before it
    {"APPRO part:here.1, 50", "APPRO part:here.1", "needed ','"},
    {"APPRO part:here.1, 50", "DEPARTS 50", "a DEPART from a place that is not known"},
    {"        DEPARTS 50", "        TOOL other\n        DEPARTS 50",
     "a DEPART from a place that is not known"},
    {"        BREAK\n        DEPARTS", "        DEPARTS", "a DEPART while the robot moves"},
    {"TRANS(10, 0, 2.5, 0, 180, 0)", "TRANS(10, 0, 2.5, 0, 180)", "needed ','"},
    {"TRANS(10, 0, 2.5, 0, 180, 0)", "TRANS(10, 0, 2.5, 0, 180, 0, 0)", "needed ')'"},
    {"TRANS(10, 0,", "TRANS(10, -0.0,", "a zero without sign"},
    {"TRANS(10,", "TRANS(1E1,", "without exponent"},
    {"SIGNAL 97", "SIGNAL 0", "a whole number"},
    {"DEPARTS 50", "DEPARTS 1234567890123456789012345", "found '1234567890123456789012345';"},
    {"SIGNAL 97", "SIGNAL 9.7", "a whole number"},
    {"SIGNAL 97", "OUT[5]=TRUE", "character 91"},
    {"spindle = TRANS", "spindle_of_the_arm = TRANS", "at most 15 characters"},
    {"        SET part", "        SET spindle = TRANS(0, 0, 1, 0, 0, 0)\n        SET part", "that changes"},
    {"TOOL spindle", "TOOL pa\n CALL two()", "the program two"},
    {"TOOL spindle", "TOOL pa\n REACTE two", "the program two"},
    {".END\n", ".END\n.PROGRAM two()\n.END\n", "one entry"},
    {".END\n", ".END\n.PROGRAM Deburr1()\n.END\n", "a second Deburr1"},
    {".END\n", "", "the word .end"},
    {"        ATTACH ()\n", "", "not attached"},
    {"; cut", "; \xC3\xA9", "beyond ASCII"},
    {"; cut",
     "; 0123456789012345678901234567890123456789012345678901234567890123456789012345678901234567890123456789",
     "characters; needed at most 128"},
    {"AUTO LOC here.1", "AUTO LOC here.1\n AUTO LOC HERE.1", "a second HERE.1"},
    {"        BREAK\n        DEPARTS", "        HALT\n        DEPARTS", "an IF or HALT here"}};

INSTANTIATE_TEST_SUITE_P(ReadVplus, ReadVplusRefuses, testing::ValuesIn(kEdits));

struct Away {
  const char *trans, *statement;
  std::array<double, 3> xyz_mm;  // by hand: x, y, z less the distance times (cos y sin p, sin y sin p, cos p)
};
class ReadVplusAway : public testing::TestWithParam<Away> {
 protected:
  // The statement behind a move to the location; its move is the second.
  static ReadMove moved() {
    const std::string text = edited("TRANS(10, 0, 2.5, 0, 180, 0)", GetParam().trans);
    std::string moves = text;
    const std::size_t at = moves.find("        APPRO part:here.1, 50\n");
    moves.replace(at, moves.find("        SIGNAL 97") - at,
                  "        MOVE part:here.1\n        BREAK\n        " + std::string(GetParam().statement) +
                      "\n        BREAK\n");
    return std::get<ReadMove>(read_vplus(moves, "away.v2").events.at(1));
  }
};

TEST_P(ReadVplusAway, GoesBackAlongTheToolsOwnZ) {
  const ReadMove move = moved();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(move.pose.xyz_mm[i], GetParam().xyz_mm[i], 1e-9) << i;
  EXPECT_EQ(move.joint, std::string(GetParam().statement).find("S ") == std::string::npos);
  EXPECT_EQ(move.work, "part");
  EXPECT_EQ(move.zone_mm, 0.0);
}

const Away kAways[] = {
    {"TRANS(10, 20, 30, 0, 180, 0)", "APPROS part:here.1, 50", {10.0, 20.0, 80.0}},  // tool down
    {"TRANS(10, 20, 30, 0, 180, 0)", "APPRO part:here.1, 50", {10.0, 20.0, 80.0}},
    {"TRANS(10, 20, 30, 0, 180, 0)", "APPROS part:here.1, -50", {10.0, 20.0, -20.0}},  // beyond it
    {"TRANS(10, 20, 30, 0, 180, 0)", "DEPARTS 50", {10.0, 20.0, 80.0}},
    {"TRANS(10, 20, 30, 0, 180, 0)", "DEPART 50", {10.0, 20.0, 80.0}},
    {"TRANS(10, 20, 30, 77, 180, -141)", "APPROS part:here.1, 50", {10.0, 20.0, 80.0}},  // gimbal lock
    {"TRANS(10, 20, 30, 77, 180, -141)", "DEPARTS 50", {10.0, 20.0, 80.0}},
    {"TRANS(10, 20, 30, 77, 0, -141)", "APPROS part:here.1, 50", {10.0, 20.0, -20.0}},
    {"TRANS(10, 20, 30, 77, 0, -141)", "DEPARTS 50", {10.0, 20.0, -20.0}},
    {"TRANS(10, 20, 30, 0, 90, 45)", "APPROS part:here.1, 50", {-40.0, 20.0, 30.0}},
    {"TRANS(10, 20, 30, 90, 90, 45)", "DEPARTS 50", {10.0, -30.0, 30.0}},
    {"TRANS(10, 20, 30, 30, 60, 5)", "APPROS part:here.1, 100", {-65.0, -23.301270189, -20.0}},
    {"TRANS(10, 20, 30, 30, 60, 5)", "DEPARTS 100", {-65.0, -23.301270189, -20.0}},
    {"TRANS(1, 2, 3, 0, 0, 0)", "APPROS part:TRANS(10, 20, 30, 0, 180, 0), 50", {10.0, 20.0, 80.0}}};

INSTANTIATE_TEST_SUITE_P(ReadVplus, ReadVplusAway, testing::ValuesIn(kAways));

// Each from where the one before it ended, an approach among them, and with the turn of that pose.
TEST(ReadVplus, ADepartLeavesFromTheLastPose) {
  const Reading read =
      read_vplus(edited("        APPRO part:here.1, 50\n        BREAK\n",
                        "        APPROS part:here.1, 50\n        BREAK\n        DEPARTS 7\n        BREAK\n"
                        "        DEPART 0.5\n        BREAK\n"),
                 "hand.v2");
  expect_pose(std::get<ReadMove>(read.events[0]), {10.0, 0.0, 52.5}, {0.0, 0.0, 1.0, 0.0});
  expect_pose(std::get<ReadMove>(read.events[1]), {10.0, 0.0, 59.5}, {0.0, 0.0, 1.0, 0.0});
  expect_pose(std::get<ReadMove>(read.events[2]), {10.0, 0.0, 60.0}, {0.0, 0.0, 1.0, 0.0});
}

TEST(ReadVplus, ATrapMustComeBeforeTheFirstMove) {
  const std::string trap = ".PROGRAM off()\n SIGNAL -97\n HALT\n.END\n";
  const Reading read = read_vplus(edited("TOOL spindle", "REACTE off\n TOOL spindle") + trap, "hand.v2");
  ASSERT_EQ(read.on_error.size(), 1u);
  EXPECT_EQ(read.on_error[0].output, "97");
  EXPECT_THROW((void)read_vplus(edited("SIGNAL 97", "SIGNAL 97\n REACTE off") + trap, "hand.v2"), Error);
}

TEST(ReadVplus, EveryTruncationIsRefused) {
  for (std::size_t length = 0; length + 1 < kByHand.size(); ++length)
    EXPECT_THROW((void)read_vplus(kByHand.substr(0, length), "cut.v2"), Error) << length;
}

}  // namespace
}  // namespace arris
