#include "cli/cell.hpp"

#include <cmath>
#include <set>

#include "acquisition/target_file.hpp"
#include "cli/text_file.hpp"
#include "registration/fixture_targets.hpp"

namespace arris {
namespace {

/// Tables that later versions fill: lines of the station's own computer.
const std::set<std::string> kReserved = {"gpio"};

void add_pose(std::vector<Key>& keys, const std::string& name, CellFile::Pose& pose, const std::string& about,
              bool required) {
  keys.push_back({.name = "frames." + name + ".xyz_mm",
                  .slot = &pose.xyz_mm,
                  .about = about + ": origin",
                  .required = required,
                  .lengths = {3}});
  keys.push_back({.name = "frames." + name + ".quat_wxyz",
                  .slot = &pose.quat_wxyz,
                  .about = about + ": unit quaternion, w first",
                  .required = required,
                  .lengths = {4}});
}

bool by_targets(const CellFile& file) {
  return file.scan_reference == "targets";
}

std::vector<Key> frame_keys(CellFile& file) {
  std::vector<Key> keys = {
      {.name = "frames.scan_reference",
       .slot = &file.scan_reference,
       .about = "fixed: a mounted scanner; targets: a hand scanner, whose frame changes every time",
       .words = {"fixed", "targets"}},
      {.name = "frames.references",
       .slot = &file.references,
       .about = "places of the fixture targets in the robot's base (csv), for scan_reference = \"targets\"",
       .required = by_targets(file),
       .example = "\"fixture_targets.csv\""},
      {.name = "frames.references_max_residual_mm",
       .slot = &file.cell.targets_max_residual_mm,
       .about = "a fixture target that is farther than this from its place is refused",
       .min = 1e-3,
       .max = 100.0},
      {.name = "frames.references_clear_mm",
       .slot = &file.cell.targets_clear_mm,
       .about = "scan points this near to a target's sphere are its mount's and take no part",
       .min = 0.0,
       .max = 500.0},
      {.name = "frames.scan_points_sd_mm",
       .slot = &file.cell.scan_points_sd_mm,
       .about = "standard deviation of points given with --targets that state none, each axis",
       .min = 1e-4,
       .max = 100.0},
  };
  add_pose(keys, "robot_from_scan", file.robot_from_scan,
           by_targets(file) ? "of a mounted scanner; left out, for the targets give it"
                            : "scanner's frame in the robot's base",
           !by_targets(file));
  add_pose(keys, "robot_from_work", file.robot_from_work, "work object in the robot's base", false);
  return keys;
}

std::vector<Key> tool_keys(CellFile& file) {
  Cell& cell = file.cell;
  return {
      {.name = "tool.name", .slot = &cell.tool_name, .about = "tool data in the robot program"},
      {.name = "tool.define",
       .slot = &cell.define_tool,
       .about = "write the tool data; false: the controller has it under that name"},
      {.name = "tool.xyz_mm",
       .slot = &file.flange_from_tool.xyz_mm,
       .about = "tip of the tool in the flange's frame",
       .lengths = {3}},
      {.name = "tool.quat_wxyz",
       .slot = &file.flange_from_tool.quat_wxyz,
       .about = "turn of the tool in the flange's frame: unit quaternion, w first; z leaves the flange",
       .lengths = {4}},
      {.name = "tool.mass_kg",
       .slot = &cell.tool_mass_kg,
       .about = "mass; controllers refuse 0",
       .min = 1e-3,
       .max = 999.0},
      {.name = "tool.centre_mm",
       .slot = &file.tool_centre_mm,
       .about = "centre of gravity in the flange's frame",
       .lengths = {3}},
  };
}

std::vector<Key> program_keys(CellFile& file) {
  Cell& cell = file.cell;
  return {
      {.name = "robot.program_name",
       .slot = &cell.program_name,
       .about = "module; the dry-run twin adds Dry"},
      {.name = "robot.entry_name",
       .slot = &cell.entry_name,
       .about = "procedure that the controller starts; V+ starts program_name"},
      {.name = "robot.work_name", .slot = &cell.work_name, .about = "work object in the robot program"},
      {.name = "robot.define_work",
       .slot = &cell.define_work,
       .about = "write the work object; false: the controller has it, equal to robot_from_work"},
      {.name = "robot.work_points",
       .slot = &cell.work_points,
       .about = "V+: three points taught on the controller, \"pa, pb, pc\", for FRAME(pa, pb, pc, pa); \"\": "
                "robot_from_work"},
      {.name = "robot.robot_number",
       .slot = &cell.robot_number,
       .about = "V+: which robot of the controller",
       .min = 1.0,
       .max = 15.0},
      {.name = "robot.approach_speed_mm_s",
       .slot = &cell.approach_speed_mm_s,
       .about = "speed of approach, retract and air moves",
       .min = 0.1,
       .max = 7000.0},
      {.name = "robot.cut_speed_mm_s",
       .slot = &cell.cut_speed_mm_s,
       .about = "speed along the path where neither path nor recipe says one",
       .min = 0.1,
       .max = 7000.0},
      {.name = "robot.turn_speed_deg_s",
       .slot = &file.turn_speed_deg_s,
       .about = "speed of the tool's turns",
       .min = 1.0,
       .max = 500.0},
      {.name = "robot.turn_speed_ratio",
       .slot = &cell.turn_speed_ratio,
       .about = "V+: speed of the tool's turns to the robot's full one, in place of turn_speed_deg_s",
       .min = 0.01,
       .max = 1.0},
      {.name = "robot.zone_mm",
       .slot = &cell.zone_mm,
       .about = "rounding of corners between rows, never more than half a step; 0: stop at each",
       .min = 0.0,
       .max = 200.0},
      {.name = "robot.clearance_mm",
       .slot = &cell.clearance_mm,
       .about = "height above the first and last row of a polyline, along the tool's axis",
       .min = 0.001,
       .max = 2000.0},
      {.name = "robot.dry_run_offset_mm",
       .slot = &cell.dry_run_offset_mm,
       .about = "the dry-run twin stays this far off, along the tool's axis",
       .min = 0.001,
       .max = 2000.0},
      {.name = "robot.dry_run_speed_ratio",
       .slot = &cell.dry_run_speed_ratio,
       .about = "speeds of the dry-run twin to those of the program",
       .min = 0.001,
       .max = 1.0},
      {.name = "robot.reach_mm",
       .slot = &cell.reach_mm,
       .about = "a pose farther from the robot's base is refused",
       .min = 1.0,
       .max = 1e6},
      {.name = "robot.max_points",
       .slot = &cell.max_points,
       .about = "moves a procedure; longer programs are split",
       .min = 10.0,
       .max = 1e6},
      {.name = "robot.spindle_output",
       .slot = &cell.spindle_output,
       .about = "robot output that switches the tool, V+ by number (\"97\"); \"\": not switched"},
      {.name = "robot.spindle_ready",
       .slot = &cell.spindle_ready,
       .about = "robot input waited for after switching on, V+ by number (\"1097\"); \"\": not waited for"},
      {.name = "robot.ready_timeout_s",
       .slot = &cell.ready_timeout_s,
       .about = "then the tool is switched off and the program ends",
       .min = 0.001,
       .max = 3600.0},
  };
}

Eigen::Vector3d vector_of(const std::vector<double>& v) {
  return {v.at(0), v.at(1), v.at(2)};
}

/// The motion a pose spells. Throws Error(kRecipe) when the quaternion is farther than 0.001 from unit
/// length.
RigidMotion motion_of(const std::string& name, const CellFile::Pose& pose) {
  const std::vector<double>& q = pose.quat_wxyz;
  Eigen::Quaterniond turn(q.at(0), q.at(1), q.at(2), q.at(3));
  if (std::abs(turn.norm() - 1.0) > 1e-3)
    throw Error(Fault::kRecipe, ErrorText{name + ".quat_wxyz is no rotation",
                                          {},
                                          "length " + std::to_string(turn.norm()),
                                          "a quaternion of length 1",
                                          "correct it in the cell"});
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() = turn.normalized().toRotationMatrix();
  motion.translation() = vector_of(pose.xyz_mm);
  return motion;
}

/// The targets of a cell that is made for a hand scanner. Throws Error(kRecipe) when they can give no frame.
void take_targets(const CellFile& file, Cell& cell) {
  if (!file.robot_from_scan.xyz_mm.empty() || !file.robot_from_scan.quat_wxyz.empty())
    throw Error(Fault::kRecipe, ErrorText{.what = "frames.robot_from_scan is given beside the targets",
                                          .found = "both",
                                          .needed = "one of them: with scan_reference = \"targets\" the "
                                                    "frame is solved in each scan",
                                          .next = "leave robot_from_scan out"});
  cell.targets = read_fixture_targets(file.references);
  cell.targets_file = file.references;
  const std::string why = why_list_is_unusable(cell.targets, cell.targets_max_residual_mm);
  if (!why.empty())
    throw Error(Fault::kRecipe, ErrorText{.what = "the fixture targets give no frame",
                                          .where = file.references.string(),
                                          .found = why,
                                          .needed = "at least 3 targets, better 4, that stand apart, not on "
                                                    "a line, at unlike distances",
                                          .next = "set one elsewhere, or correct the list"});
}

Cell cell_of(const CellFile& file) {
  Cell cell = file.cell;
  if (by_targets(file))
    take_targets(file, cell);
  else
    cell.robot_from_scan = motion_of("frames.robot_from_scan", file.robot_from_scan);
  cell.robot_from_work = motion_of("frames.robot_from_work", file.robot_from_work);
  cell.flange_from_tool = motion_of("tool", file.flange_from_tool);
  cell.tool_centre_mm = vector_of(file.tool_centre_mm);
  cell.turn_speed_rad_s = file.turn_speed_deg_s * 3.14159265358979323846 / 180.0;
  cell.check();
  return cell;
}

}  // namespace

std::vector<Key> cell_keys(CellFile& file) {
  std::vector<Key> keys;
  for (auto part : {frame_keys(file), tool_keys(file), program_keys(file)})
    keys.insert(keys.end(), part.begin(), part.end());
  return keys;
}

CellRead parse_cell(const std::filesystem::path& file, const std::string& text) {
  CellRead result;
  result.problems = read_keys(file, text, cell_keys(result.file), kReserved).problems;
  if (by_targets(result.file))  // now it is known which keys must be there
    result.problems = read_keys(file, text, cell_keys(result.file), kReserved).problems;
  if (!result.problems.empty()) return result;
  try {
    result.cell = cell_of(result.file);
  } catch (const Error& error) {
    ErrorText problem = error.text();
    if (problem.where.empty()) problem.where = file.string();
    result.problems.push_back(std::move(problem));
  }
  return result;
}

CellRead read_good_cell(const std::filesystem::path& file) {
  CellRead read = parse_cell(file, read_text_file(file, "cell"));
  if (read.problems.empty()) return read;
  throw Error(Fault::kRecipe, read.problems.front());
}

Cell read_cell(const std::filesystem::path& file) {
  return read_good_cell(file).cell;
}

std::string print_cell(const CellFile& file, const std::filesystem::path& folder) {
  CellFile copy = file;
  return "# Arris cell: what is true of one station. Every key stands here with its value; one that keeps "
         "its\n"
         "# default may be left out. * must be given. Lengths are mm, angles degrees, paths relative to this "
         "file.\n" +
         print_keys(cell_keys(copy), folder) +
         "\n# The lines of the station's own computer; a later version reads them.\n[gpio]\n";
}

}  // namespace arris
