#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace arris {

/// What a recogniser found in a robot program, whatever its language: plain numbers, nothing that a writer
/// uses.
struct ReadPose {
  std::array<double, 3> xyz_mm = {0.0, 0.0, 0.0};
  std::array<double, 4> quat_wxyz = {1.0, 0.0, 0.0, 0.0};  ///< unit within 1e-6
};
struct ReadMove {
  ReadPose pose;
  bool joint = false;
  double speed_mm_s = 0.0;
  std::optional<double> turn_deg_s, turn_ratio;  ///< turning speed: of the one kind that the language states
  std::optional<double> zone_mm = 0.0;  ///< 0: stops there; none: passes, the controller says how near
  std::string tool, work;
};
struct ReadSet {
  std::string output;
  int value = 0;
};
struct ReadWait {
  std::string input;
  int value = 0;
  double timeout_s = 0.0;           ///< 0: waits for ever
  std::vector<ReadSet> on_timeout;  ///< what is switched then
  bool ends_on_timeout = false;     ///< and the program ends
};
using ReadEvent = std::variant<ReadMove, ReadSet, ReadWait>;

struct ReadLoad {
  double mass_kg = 0.0;
  std::array<double, 3> centre_mm = {0.0, 0.0, 0.0};
};
struct ReadTool {
  ReadPose flange_from_tool;
  std::optional<ReadLoad> load;  ///< none: the language states it elsewhere
};
/// A work object through points that are taught on the controller: x axis, towards plus y, origin.
struct TaughtWork {
  std::string x_from, x_to, plane, origin;
};

struct Reading {
  std::string name;
  std::vector<std::string> comments;
  std::string result_hash, body_sha256;  ///< as the comments state them; empty when they do not
  std::string hashed_text;               ///< what body_sha256 must be the hash of: all but its digits
  std::map<std::string, ReadTool> tools;
  std::map<std::string, ReadPose> works;  ///< work objects: base from work
  std::map<std::string, TaughtWork> taught_works;
  std::optional<int> robot;         ///< which of the controller's robots; none: the language has one
  std::vector<ReadEvent> events;    ///< in the order in which the controller would meet them
  std::vector<ReadSet> on_error;    ///< switched by the entry procedure's error handler
  bool configurations_off = false;  ///< axis configurations are not monitored in any move
  int longest_procedure = 0;        ///< moves
};

}  // namespace arris
