#include "toolpath/robot/read_rapid.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

// A module as people write them by hand: standard speeds, Offs, no hash.
const std::string kByHand =
    "MODULE Deburr1\n"
    "  ! result_hash = 12ab\n"
    "  PERS tooldata tSpindle:=[TRUE,[[0,0,180],[1,0,0,0]],[2.5,[0,0,90],[1,0,0,0],0,0,0]];\n"
    "  PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[850,0,400],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
    "  CONST speeddata vCut:=[20,45,5000,1000];\n"
    "  CONST zonedata zCut:=[FALSE,0.3,0.3,0.3,0.03,0.3,0.03];\n"
    "  CONST robtarget p1:=[[0,0,50],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    "  PROC main()\n"
    "    ConfL\\Off;\n"
    "    MoveJ p1,v200,fine,tSpindle\\WObj:=wPart;\n"
    "    SetDO doSpindle,1;\n"
    "    WaitDI diSpindleReady,1\\MaxTime:=5;\n"
    "    MoveL Offs(p1,10,-2.5,0),vCut,zCut,tSpindle\\WObj:=wPart;\n"
    "    MoveL [[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],vCut,z10,tSpindle\\WObj:=wPart;\n"
    "    SetDO doSpindle,0;\n"
    "  ENDPROC\n"
    "ENDMODULE\n";

std::string edited(const std::string& from, const std::string& to) {
  std::string text = kByHand;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(ReadRapid, ReadsWhatTheControllerWouldDo) {
  const Reading read = read_rapid(kByHand, "hand.mod");
  EXPECT_EQ(read.name, "Deburr1");
  EXPECT_EQ(read.result_hash, "12ab");
  EXPECT_EQ(read.hashed_text, kByHand);
  ASSERT_EQ(read.events.size(), 6u);
  const auto& first = std::get<ReadMove>(read.events[0]);
  EXPECT_TRUE(first.joint);
  EXPECT_EQ(first.speed_mm_s, 200.0);
  EXPECT_EQ(first.zone_mm, 0.0);
  EXPECT_EQ(first.tool, "tSpindle");
  EXPECT_EQ(std::get<ReadSet>(read.events[1]).value, 1);
  EXPECT_EQ(std::get<ReadWait>(read.events[2]).timeout_s, 5.0);
  const auto& shifted = std::get<ReadMove>(read.events[3]);
  EXPECT_EQ(shifted.pose.xyz_mm, (std::array<double, 3>{10.0, -2.5, 50.0}));
  EXPECT_EQ(shifted.pose.quat_wxyz, (std::array<double, 4>{0.0, 0.0, 1.0, 0.0}));
  EXPECT_EQ(shifted.zone_mm, 0.3);
  EXPECT_EQ(std::get<ReadMove>(read.events[4]).zone_mm, 10.0);
  EXPECT_EQ(read.tools.at("tSpindle").load->mass_kg, 2.5);
  EXPECT_EQ(read.works.at("wPart").xyz_mm[0], 850.0);
  EXPECT_FALSE(read.configurations_off);  // ConfJ was left on
}

TEST(ReadRapid, KnowsNoCaseAndTakesWindowsLines) {
  std::string text = edited("MoveJ p1", "MOVEJ P1");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  EXPECT_EQ(read_rapid(text, "hand.mod").events.size(), 6u);
}

struct Edit {
  const char *from, *to, *says;
};
class ReadRapidRefuses : public testing::TestWithParam<Edit> {};

TEST_P(ReadRapidRefuses, WithLineAndReason) {
  try {
    (void)read_rapid(edited(GetParam().from, GetParam().to), "hand.mod");
    ADD_FAILURE() << "accepted: " << GetParam().to;
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInput);
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("hand.mod, line "), std::string::npos) << error.what();
  }
}

const Edit kEdits[] = {
    {"ENDMODULE\n", "", "needed the word endmodule"},
    {"ENDPROC", "", "ENDMODULE"},
    {"ENDMODULE\n", "ENDMODULE\nMODULE b\n", "the end of the text"},
    {"MODULE Deburr1", "MODULE module", "needed a name"},
    {"MoveJ p1,v200", "MoveJ p1 v200", "line 10): found 'v200'; needed ','"},
    {"fine,tSpindle", "fin,tSpindle", "the name fin"},
    {"MoveJ p1", "MoveJ p9", "the name p9"},
    {"v200", "v201", "the name v201"},
    {"[0,0,1,0]", "[0,0,1]", "another shape"},
    {"[0,0,1,0]", "[0,0,1,0,0]", "another shape"},
    {"[0,0,1,0]", "[0,0,0.9999,0]", "quaternion of length"},
    {"[0,0,50]", "[0,-0.0,50]", "a zero without sign"},
    {"[0,0,50]", "[0,0,5E1]", "without exponent"},
    {"[0,0,50]", "[0,0,1234567890123456789012345\n]", "found '1234567890123456789012345';"},
    {"[0,0,50]", "[0,0,50.]", "digits behind the point"},
    {"9E9,9E9", "9E9,100", "another shape"},
    {"9E9,9E9", "9E8,9E9", "without exponent"},
    {"[0,0,0,0]", "[0,0,0.5,0]", "a configuration"},
    {"[2.5,", "[0,", "without mass"},
    {"PERS tooldata", "CONST tooldata", "needed PERS"},
    {"[TRUE,", "[FALSE,", "stands still"},
    {"[FALSE,TRUE,\"\"", "[FALSE,FALSE,\"\"", "a fixed one"},
    {"\"\"", "\"", "a string without end"},
    {"[20,45", "[0,45", "a speed that is not above 0"},
    {"[FALSE,0.3,0.3", "[FALSE,0.3,0.2", "pzone_ori"},
    {"[FALSE,0.3", "[FALSE,-0.3", "a negative zone"},
    {"CONST zonedata zCut", "CONST zonedata vCut", "a second vCut"},
    {"SetDO doSpindle,1", "SetDO doSpindle,2", "0 or 1"},
    {"\\MaxTime:=5", "\\MaxTime:=0", "a time above 0"},
    {"\\MaxTime:=5", "\\MaxTime:=5\\TimeFlag:=bLate", "the name bLate"},
    {"ConfL\\Off", "ConfL\\Of", "On or Off"},
    {"SetDO doSpindle,0;", "EXIT;", "an IF, EXIT or RAISE here"},
    {"SetDO doSpindle,0;", "stop1;", "a call of stop1"},
    {"SetDO doSpindle,0;", "main;", "no procedure to start with"},
    {"  ENDPROC\n", "  ENDPROC\n PROC two()\n ENDPROC\n", "one entry"},
    {"doSpindle,1", "doSpindleOfTheSecondStationOnTheLeft,1", "at most 32 characters"},
    {"Deburr1", "Deburr\xC3\xA9", "character 195"},
    {"! result", "! r\xC3\xA9sult", "beyond ASCII"},
    {"ConfL\\Off;", "IF b THEN EXIT; ENDIF", "an IF, EXIT or RAISE here"},
    {"  ENDPROC", "  ERROR SetDO doSpindle,0;\n ENDPROC", "a handler that goes on"},
    {"  ENDPROC", "  ERROR RAISE; SetDO doSpindle,0;\n ENDPROC", "never reached"}};

INSTANTIATE_TEST_SUITE_P(ReadRapid, ReadRapidRefuses, testing::ValuesIn(kEdits));

TEST(ReadRapid, EveryTruncationIsRefused) {
  for (std::size_t length = 0; length + 2 < kByHand.size(); ++length)
    EXPECT_THROW((void)read_rapid(kByHand.substr(0, length), "cut.mod"), Error) << length;
}

}  // namespace
}  // namespace arris
