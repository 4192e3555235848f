#include "toolpath/robot/compare.hpp"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

constexpr std::size_t kListed = 20;
constexpr double kDegPerRad = 57.295779513082320877;

double turn_between_rad(const Eigen::Matrix3d& meant, const ReadPose& read) {
  const auto& q = read.quat_wxyz;
  const Eigen::Quaterniond found = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  const Eigen::Matrix3d rest = meant.transpose() * found.toRotationMatrix();
  const Eigen::Vector3d sine(rest(2, 1) - rest(1, 2), rest(0, 2) - rest(2, 0), rest(1, 0) - rest(0, 1));
  return std::atan2(0.5 * sine.norm(), 0.5 * (rest.trace() - 1.0));
}

double distance_mm(const Eigen::Vector3d& meant_mm, const std::array<double, 3>& read_mm) {
  return (meant_mm - Eigen::Vector3d(read_mm[0], read_mm[1], read_mm[2])).norm();
}

class Comparison {
 public:
  Comparison(const Program& meant, const Reading& read, const CompareOptions& options)
      : meant_(meant), read_(read), options_(options) {}

  std::vector<std::string> run(const std::function<std::string(std::string_view)>& sha256_hex) {
    if (read_.name != meant_.name) say("the program is called " + read_.name);
    if (read_.result_hash != meant_.result_hash) say("another result_hash");
    if (read_.body_sha256 != sha256_hex(read_.hashed_text)) say("the body's hash is not the one it states");
    frames();
    if (!read_.configurations_off) say("axis configurations are monitored");
    if (read_.longest_procedure > meant_.cell.max_points) say("a procedure of too many moves");
    if (read_.events.size() != meant_.events.size())
      say(std::to_string(read_.events.size()) + " events instead of " + std::to_string(meant_.events.size()));
    for (std::size_t i = 0; i < std::min(read_.events.size(), meant_.events.size()); ++i) {
      at_ = "event " + std::to_string(i + 1) + ": ";
      std::visit([&](const auto& event) { check(event, read_.events[i]); }, meant_.events[i]);
    }
    at_.clear();
    error_path();
    return std::move(out_);
  }

 private:
  void say(const std::string& text) {
    if (out_.size() < kListed) out_.push_back(at_ + text);
  }

  void pose(const RigidMotion& meant, const ReadPose& read, const std::string& what) {
    const double off_mm = distance_mm(meant.translation(), read.xyz_mm);
    const double off_rad = turn_between_rad(meant.linear(), read);
    if (!(off_mm <= options_.position_mm)) say(what + " off by " + std::to_string(off_mm) + " mm");
    if (!(off_rad <= options_.turn_rad))
      say(what + " turned by " + std::to_string(off_rad * kDegPerRad) + " deg");
  }

  void frames() {
    const Cell& cell = meant_.cell;
    const auto tool = read_.tools.find(cell.tool_name);
    if (read_.tools.size() != (cell.define_tool ? 1u : 0u) ||
        (tool == read_.tools.end()) == cell.define_tool) {
      say("another set of tools");
    } else if (cell.define_tool) {
      pose(cell.flange_from_tool, tool->second.flange_from_tool, "the tool");
      if (tool->second.load) load(*tool->second.load);
    }
    if (read_.robot.value_or(cell.robot_number) != cell.robot_number) say("another robot");
    work();
  }

  void load(const ReadLoad& read) {
    const Cell& cell = meant_.cell;
    if (!(std::abs(read.mass_kg - cell.tool_mass_kg) <= 0.001)) say("another tool mass");
    if (!(distance_mm(cell.tool_centre_mm, read.centre_mm) <= options_.position_mm))
      say("another centre of gravity");
  }

  void work() {
    const Cell& cell = meant_.cell;
    const bool taught = cell.define_work && !cell.work_points.empty();
    const bool stated = cell.define_work && !taught;
    const auto work = read_.works.find(cell.work_name);
    const auto points = read_.taught_works.find(cell.work_name);
    if (read_.works.size() != (stated ? 1u : 0u) || (work != read_.works.end()) != stated ||
        read_.taught_works.size() != (taught ? 1u : 0u) || (points != read_.taught_works.end()) != taught)
      return say("another set of work objects");
    if (stated) pose(cell.robot_from_work, work->second, "the work object");
    if (!taught) return;
    const TaughtWork& read = points->second;
    if (read.x_from + ", " + read.x_to + ", " + read.plane != cell.work_points || read.origin != read.x_from)
      say("the work object through other points");
  }

  void turning(const ReadMove& read) {
    const double turn_deg_s = meant_.cell.turn_speed_rad_s * kDegPerRad;
    const double off_deg_s = std::abs(read.turn_deg_s.value_or(turn_deg_s) - turn_deg_s);
    const double off_ratio =
        std::abs(read.turn_ratio.value_or(meant_.cell.turn_speed_ratio) - meant_.cell.turn_speed_ratio);
    const bool stated = read.turn_deg_s || read.turn_ratio;
    if (!stated || !(off_deg_s <= 0.001) || !(off_ratio <= 1e-5)) say("another turning speed");
  }

  void check(const Move& meant, const ReadEvent& event) {
    const auto* read = std::get_if<ReadMove>(&event);
    if (read == nullptr) return say("no move");
    pose(meant.work_from_tool, read->pose, "the pose is");
    if (read->joint != meant.joint) say("another kind of move");
    if (!(std::abs(read->speed_mm_s - meant.speed_mm_s) <= options_.speed_mm_s)) say("another speed");
    turning(*read);
    const bool stops = meant.zone_mm == 0.0;
    const double off_mm = std::abs(read->zone_mm.value_or(meant.zone_mm) - meant.zone_mm);
    if (stops != (read->zone_mm == 0.0) || !(off_mm <= options_.zone_mm)) say("another zone");
    if (read->tool != meant_.cell.tool_name) say("another tool");
    if (read->work != meant_.cell.work_name) say("another work object");
  }

  void check(const SetOutput& meant, const ReadEvent& event) {
    const auto* read = std::get_if<ReadSet>(&event);
    if (read == nullptr || read->output != meant.output || read->value != (meant.on ? 1 : 0))
      say("not " + meant.output + (meant.on ? " on" : " off"));
  }

  void check(const WaitInput& meant, const ReadEvent& event) {
    const auto* read = std::get_if<ReadWait>(&event);
    if (read == nullptr || read->input != meant.input || read->value != (meant.on ? 1 : 0))
      return say("no wait for " + meant.input);
    if (!(std::abs(read->timeout_s - meant.timeout_s) <= 0.001)) say("another time to wait");
    const bool switched = read->on_timeout.size() == 1 && read->on_timeout[0].output == meant.off &&
                          read->on_timeout[0].value == 0;
    if (!read->ends_on_timeout || !(meant.off.empty() ? read->on_timeout.empty() : switched))
      say("the time-out does not switch off and end");
  }

  // Whatever the program switches on, its error handler switches off.
  void error_path() {
    std::vector<std::string> expected;
    for (const Event& event : meant_.events)
      if (const auto* set = std::get_if<SetOutput>(&event))
        if (std::find(expected.begin(), expected.end(), set->output) == expected.end())
          expected.push_back(set->output);
    bool same = read_.on_error.size() == expected.size();
    for (const ReadSet& set : read_.on_error)
      same =
          same && set.value == 0 && std::find(expected.begin(), expected.end(), set.output) != expected.end();
    if (!same) say("the error handler does not switch everything off");
  }

  const Program& meant_;
  const Reading& read_;
  const CompareOptions& options_;
  std::vector<std::string> out_;
  std::string at_;
};

}  // namespace

std::vector<std::string> differences(const Program& meant, const Reading& read,
                                     const std::function<std::string(std::string_view)>& sha256_hex,
                                     const CompareOptions& options) {
  return Comparison(meant, read, options).run(sha256_hex);
}

}  // namespace arris
