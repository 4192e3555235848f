#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/types/fixture_target.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {

/// What is true of one station (cell.toml): frames, tool, work object, lines, speeds. Every field that has a
/// sensible default has it; robot_from_scan has none that is right and must be given.
struct Cell {
  // [frames]
  RigidMotion robot_from_scan =
      RigidMotion::Identity();           ///< takes scan coordinates (those of the file) to the robot's base
  std::vector<FixtureTarget> targets;    ///< robot's base frame; not empty: robot_from_scan is solved from
                                         ///< them in each scan, and the one above is not used
  std::filesystem::path targets_file;    ///< where they were read from
  double targets_max_residual_mm = 0.2;  ///< a target that fits worse is refused; > 0
  double targets_clear_mm = 25.0;        ///< scan points this near to a sphere belong to its mount; >= 0
  double scan_points_sd_mm = 0.05;       ///< of a scanned point target whose file states none; > 0
  RigidMotion robot_from_work = RigidMotion::Identity();  ///< frame in which the program states its poses
  // [tool]
  std::string tool_name = "tSpindle";  ///< tool data in the program
  bool define_tool = true;             ///< false: the controller has it; referred to, not defined
  RigidMotion flange_from_tool =
      RigidMotion::Identity();  ///< the tool's frame at the flange: tip, z out of the flange
  double tool_mass_kg = 1.0;    ///< > 0; controllers refuse 0
  Eigen::Vector3d tool_centre_mm = Eigen::Vector3d(0.0, 0.0, 50.0);  ///< centre of gravity, flange frame
  // [robot]
  std::string program_name = "ArrisPath";  ///< module; the dry-run twin adds "Dry"
  std::string entry_name = "main";         ///< the procedure that the controller starts
  std::string work_name = "wPart";         ///< work object in the program
  bool define_work = true;  ///< false: the controller has it, and it must equal robot_from_work
  std::string work_points;  ///< V+: taught points "a, b, c": work = FRAME(a, b, c, a); empty: robot_from_work
  int robot_number = 1;     ///< V+: which robot of the controller, SELECT ROBOT
  double approach_speed_mm_s = 100.0;    ///< clearance, retract and air moves
  double cut_speed_mm_s = 20.0;          ///< rows without a feed of their own
  double turn_speed_rad_s = 0.78539816;  ///< the tool's reorientation
  double turn_speed_ratio = 0.2;         ///< V+: the same, to the robot's full speed of turns; in (0, 1]
  double zone_mm = 0.3;              ///< corner rounding between rows; never more than half a step; 0: stop
  double clearance_mm = 50.0;        ///< above the first and the last row of a polyline, along the tool axis
  double dry_run_offset_mm = 50.0;   ///< the twin runs this far off, along the tool axis
  double dry_run_speed_ratio = 0.5;  ///< the twin's speeds to the program's; in (0, 1]
  double reach_mm = 5000.0;          ///< a pose farther from the robot's base is refused
  int max_points = 5000;             ///< moves a procedure; longer programs are split
  // [gpio] as the robot's controller names its lines
  std::string spindle_output = "doSpindle";      ///< tool on/off; empty: not switched by the program
  std::string spindle_ready = "diSpindleReady";  ///< waited for after switching on; empty: not waited for
  double ready_timeout_s = 5.0;                  ///< then the tool is switched off and the program ends

  /// Throws Error(kRecipe) that names field, value and bound.
  void check() const;
};

}  // namespace arris
