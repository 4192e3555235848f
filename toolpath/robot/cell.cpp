#include "toolpath/robot/cell.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"

namespace arris {
namespace {

[[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& bound) {
  throw Error(Fault::kRecipe, "cell." + field + " = " + value + ", need " + bound);
}

void need(bool holds, const char* field, double value, const char* bound) {
  if (!holds || !std::isfinite(value))
    refuse(field, std::isfinite(value) ? fixed_text(value, 6) : "not finite", bound);
}

void check_name(const char* field, const std::string& name, bool may_be_empty) {
  const bool printable = std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c < 127; });
  if (!printable || name.size() > 32 || (name.empty() && !may_be_empty))
    refuse(field, "\"" + name + "\"", "1 to 32 printable ASCII characters without blanks");
}

void check_motion(const char* field, const RigidMotion& motion) {
  const Eigen::Matrix3d turn = motion.linear();
  const double departure = (turn.transpose() * turn - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!motion.matrix().allFinite()) refuse(field, "not finite", "a rigid motion");
  if (departure > 1e-6 || turn.determinant() < 0.0) refuse(field, "not a rotation", "a rigid motion");
  if (motion.translation().norm() > 1e6)
    refuse(field, fixed_text(motion.translation().norm(), 0) + " mm away", "at most 1000000 mm");
}

}  // namespace

void Cell::check() const {
  check_motion("robot_from_scan", robot_from_scan);
  need(targets_max_residual_mm > 0.0, "targets_max_residual_mm", targets_max_residual_mm, "> 0");
  need(targets_clear_mm >= 0.0, "targets_clear_mm", targets_clear_mm, ">= 0");
  need(scan_points_sd_mm > 0.0, "scan_points_sd_mm", scan_points_sd_mm, "> 0");
  check_motion("robot_from_work", robot_from_work);
  check_motion("flange_from_tool", flange_from_tool);
  for (const auto& [field, name] : {std::pair{"tool_name", tool_name},
                                    {"program_name", program_name},
                                    {"entry_name", entry_name},
                                    {"work_name", work_name}})
    check_name(field, name, false);
  if (program_name.size() > 29) refuse("program_name", "\"" + program_name + "\"", "at most 29 characters");
  check_name("spindle_output", spindle_output, true);
  check_name("spindle_ready", spindle_ready, true);
  if (spindle_output.empty() && !spindle_ready.empty())
    refuse("spindle_ready", "\"" + spindle_ready + "\"", "a spindle_output to wait for");
  need(tool_mass_kg > 0.0 && tool_mass_kg < 1000.0, "tool_mass_kg", tool_mass_kg, "> 0 and < 1000");
  need(tool_centre_mm.allFinite(), "tool_centre_mm", tool_centre_mm.sum(), "three finite numbers");
  need(approach_speed_mm_s >= 0.1 && approach_speed_mm_s <= 7000.0, "approach_speed_mm_s",
       approach_speed_mm_s, "0.1 to 7000");
  need(cut_speed_mm_s >= 0.1 && cut_speed_mm_s <= 7000.0, "cut_speed_mm_s", cut_speed_mm_s, "0.1 to 7000");
  need(turn_speed_rad_s >= 0.01 && turn_speed_rad_s <= 10.0, "turn_speed_rad_s", turn_speed_rad_s,
       "0.01 to 10");
  need(turn_speed_ratio >= 0.01 && turn_speed_ratio <= 1.0, "turn_speed_ratio", turn_speed_ratio,
       "0.01 to 1");
  need(robot_number >= 1 && robot_number <= 15, "robot_number", robot_number, "1 to 15");
  need(zone_mm >= 0.0 && zone_mm <= 200.0, "zone_mm", zone_mm, "0 to 200");
  need(clearance_mm > 0.0 && clearance_mm <= 2000.0, "clearance_mm", clearance_mm, "> 0 and <= 2000");
  need(dry_run_offset_mm > 0.0 && dry_run_offset_mm <= 2000.0, "dry_run_offset_mm", dry_run_offset_mm,
       "> 0 and <= 2000");
  need(dry_run_speed_ratio > 0.0 && dry_run_speed_ratio <= 1.0, "dry_run_speed_ratio", dry_run_speed_ratio,
       "in (0, 1]");
  need(reach_mm > 0.0 && reach_mm <= 1e6, "reach_mm", reach_mm, "> 0 and <= 1000000");
  need(max_points >= 10, "max_points", max_points, ">= 10");
  need(ready_timeout_s > 0.0 && ready_timeout_s <= 3600.0, "ready_timeout_s", ready_timeout_s,
       "> 0 and <= 3600");
}

}  // namespace arris
