#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "toolpath/correct.hpp"
#include "toolpath/robot/cell.hpp"
#include "toolpath/robot/orientation.hpp"

namespace arris {

/// Go to a pose.
struct Move {
  RigidMotion work_from_tool =
      RigidMotion::Identity();  ///< tool tip and orientation in the work object's frame, mm
  double speed_mm_s = 0.0;
  double zone_mm = 0.0;     ///< corner rounding at the end of the move; 0: stop there
  bool joint = false;       ///< by the joints' shortest way; else along a straight line
  std::ptrdiff_t row = -1;  ///< the path's row, from 0; -1: clearance
};
/// Switch an output of the robot's controller.
struct SetOutput {
  std::string output;
  bool on = false;
};
/// Wait for an input; too late: `off` is switched off, and the program ends.
struct WaitInput {
  std::string input;
  bool on = true;
  double timeout_s = 0.0;
  std::string off;
};
using Event = std::variant<Move, SetOutput, WaitInput>;

/// A robot program before it has a language: what happens, in order.
struct Program {
  Cell cell;         ///< frames, tool and names that a dialect writes down
  std::string name;  ///< name_of_program()
  std::string result_hash;
  std::vector<std::string> comments;  ///< for the head of the file
  bool dry_run = false;
  std::vector<Event> events;
};

/// cell.program_name, with "Dry" for the twin.
[[nodiscard]] std::string name_of_program(const Cell& cell, bool dry_run);

/// Options of make_program.
struct ProgramOptions {
  Spin spin = Spin::kLeastTurn;
  bool dry_run = false;               ///< the twin: off the part, nothing switched, slower
  std::string result_hash;            ///< stands in the header
  std::vector<std::string> comments;  ///< further header lines: part, version
};

/// Makes the program of an accepted correction: to the clearance above the first row by the joints, tool on,
/// wait until it is ready, then each polyline (down, along its rows, back to the first row where closed, up
/// to the clearance), at the end tool off. The robot stands still (zone 0) at the first and last row of a
/// polyline, at every clearance and before every output. Zones never exceed half of either neighbouring step.
/// A row's own feed goes before the cell's.
///   offset_mm   the scan's ingest offset: robot_from_scan takes the coordinates of the scan's file
///   dry_run     tips dry_run_offset_mm along the axis, speeds times dry_run_speed_ratio, no outputs, no
///   waiting throws      Error(kBug) for a correction that is not accepted; Error(kRecipe) from cell.check(),
///   and when a pose
///               lies beyond cell.reach_mm
/// What it does not know: the robot's joints (configuration, singularities) and what stands in the way
/// between polylines. The dry run is there for that.
[[nodiscard]] Program make_program(const Correction& correction, const Eigen::Vector3d& offset_mm,
                                   const Cell& cell, const ProgramOptions& options);

}  // namespace arris
