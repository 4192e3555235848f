#include "toolpath/robot/compare.hpp"

#include <gtest/gtest.h>

#include "tests/toolpath/programs.hpp"
#include "toolpath/robot/rapid.hpp"
#include "toolpath/robot/read_rapid.hpp"

namespace arris {
namespace {

Program meant() {
  ProgramOptions options;
  options.result_hash = test::toy_hash("result");
  return make_program(test::ring(12, 60.0, true), Eigen::Vector3d::Zero(), test::some_cell(), options);
}

Reading read_back() {
  return read_rapid(write_rapid(meant(), test::toy_hash), "p.mod");
}

ReadMove& move_at(Reading& read, std::size_t i) {
  return std::get<ReadMove>(read.events[i]);
}

struct Meddled {
  void (*with)(Reading&);
  const char* says;
};
class CompareSays : public testing::TestWithParam<Meddled> {};

TEST_P(CompareSays, WhatDiffers) {
  Reading read = read_back();
  ASSERT_EQ(differences(meant(), read, test::toy_hash), std::vector<std::string>());
  GetParam().with(read);
  const std::vector<std::string> found = differences(meant(), read, test::toy_hash);
  ASSERT_EQ(found.size(), 1u) << GetParam().says;
  EXPECT_NE(found[0].find(GetParam().says), std::string::npos) << found[0];
}

// Events: 0 to the clearance, 1 on, 2 wait, 3 to 15 the rows and the first again, 16 up, 17 off.
const Meddled kMeddled[] = {
    {[](Reading& r) { r.name = "Other"; }, "the program is called Other"},
    {[](Reading& r) { r.result_hash = "0"; }, "another result_hash"},
    {[](Reading& r) { r.hashed_text += " "; }, "the body's hash"},
    {[](Reading& r) { r.body_sha256[5] ^= 1; }, "the body's hash"},
    {[](Reading& r) { r.configurations_off = false; }, "configurations"},
    {[](Reading& r) { r.longest_procedure = 5001; }, "too many moves"},
    {[](Reading& r) { r.events.pop_back(); }, "17 events instead of 18"},
    {[](Reading& r) { move_at(r, 4).pose.xyz_mm[2] += 0.0012; }, "event 5: the pose is off by 0.0012"},
    {[](Reading& r) { move_at(r, 4).pose.xyz_mm[0] = std::nan(""); }, "event 5: the pose is off by nan"},
    {[](Reading& r) { move_at(r, 5).pose.quat_wxyz[0] += 2e-5; }, "event 6: the pose is turned by 0.002"},
    {[](Reading& r) { move_at(r, 0).joint = false; }, "event 1: another kind of move"},
    {[](Reading& r) { move_at(r, 6).speed_mm_s = 20.01; }, "event 7: another speed"},
    {[](Reading& r) { move_at(r, 6).turn_deg_s = 500.0; }, "event 7: another turning speed"},
    {[](Reading& r) { move_at(r, 6).zone_mm = 0.0; }, "event 7: another zone"},
    {[](Reading& r) { move_at(r, 3).zone_mm = 1e-9; }, "event 4: another zone"},
    {[](Reading& r) { move_at(r, 6).tool = "tool0"; }, "event 7: another tool"},
    {[](Reading& r) { move_at(r, 6).work = "wobj0"; }, "event 7: another work object"},
    {[](Reading& r) {
       r.events[6] = ReadSet{"doSpindle", 1};
     },
     "event 7: no move"},
    {[](Reading& r) { std::get<ReadSet>(r.events[1]).value = 0; }, "event 2: not doSpindle on"},
    {[](Reading& r) { std::get<ReadSet>(r.events[17]).output = "doX"; }, "event 18: not doSpindle off"},
    {[](Reading& r) { std::get<ReadWait>(r.events[2]).input = "diX"; }, "event 3: no wait for"},
    {[](Reading& r) { std::get<ReadWait>(r.events[2]).value = 0; }, "event 3: no wait for"},
    {[](Reading& r) { std::get<ReadWait>(r.events[2]).timeout_s = 50.0; }, "another time to wait"},
    {[](Reading& r) { std::get<ReadWait>(r.events[2]).on_timeout.clear(); }, "does not switch off and end"},
    {[](Reading& r) { std::get<ReadWait>(r.events[2]).on_timeout[0].value = 1; }, "switch off and end"},
    {[](Reading& r) { std::get<ReadWait>(r.events[2]).ends_on_timeout = false; }, "switch off and end"},
    {[](Reading& r) { r.on_error.clear(); }, "the error handler"},
    {[](Reading& r) { r.on_error[0].value = 1; }, "the error handler"},
    {[](Reading& r) { r.on_error[0].output = "doX"; }, "the error handler"},
    {[](Reading& r) { r.tools.clear(); }, "another set of tools"},
    {[](Reading& r) { r.tools["tSpindle"].load->mass_kg = 2.0; }, "another tool mass"},
    {[](Reading& r) { r.tools["tSpindle"].load->centre_mm[1] = 1.0; }, "another centre of gravity"},
    {[](Reading& r) { r.tools["tSpindle"].flange_from_tool.xyz_mm[2] += 1.0; }, "the tool off by 1.0"},
    {[](Reading& r) { r.works["wSecond"] = {}; }, "another set of work objects"},
    {[](Reading& r) { r.works["wPart"].xyz_mm[0] += 1.0; }, "the work object off by 1.0"}};

INSTANTIATE_TEST_SUITE_P(Compare, CompareSays, testing::ValuesIn(kMeddled));

TEST(Compare, OppositeQuaternionsAreTheSameTurn) {
  Reading read = read_back();
  for (double& part : move_at(read, 5).pose.quat_wxyz) part = -part;
  EXPECT_TRUE(differences(meant(), read, test::toy_hash).empty());
}

TEST(Compare, AHalfTurnIsSeen) {
  Reading read = read_back();
  auto& q = move_at(read, 5).pose.quat_wxyz;
  q = {-q[1], q[0], q[3], -q[2]};  // q times a half turn about x
  const std::vector<std::string> found = differences(meant(), read, test::toy_hash);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find("turned by 180.0"), std::string::npos) << found[0];
}

TEST(Compare, ListsAreCut) {
  Reading read = read_back();
  for (std::size_t i = 3; i < 16; ++i) {
    move_at(read, i).pose.xyz_mm[0] += 1.0;
    move_at(read, i).speed_mm_s += 1.0;
  }
  EXPECT_EQ(differences(meant(), read, test::toy_hash).size(), 20u);
}

}  // namespace
}  // namespace arris
