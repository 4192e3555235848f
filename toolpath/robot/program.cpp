#include "toolpath/robot/program.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr double kSmallestZoneMm = 0.01;

// A stop of the tool in the work frame; a closed polyline ends with its first row once more.
struct Stop {
  Vector3d tip_mm, axis, travel;
  double speed_mm_s = 0.0;
  std::ptrdiff_t row = -1;
};

struct Stops {
  std::vector<Stop> all;
  std::vector<PathRange> ranges;
};

ToolPath in_work_frame(const Correction& correction, const Vector3d& offset_mm, const Cell& cell,
                       double lift_mm) {
  const RigidMotion work_from_scan = cell.robot_from_work.inverse() * cell.robot_from_scan;
  ToolPath path;
  for (const CorrectedPoint& corrected : correction.points) {
    PathPoint row = corrected.point;
    row.axis = (work_from_scan.linear() * row.axis).normalized();
    row.tip_mm = work_from_scan * (row.tip_mm + offset_mm) + lift_mm * row.axis;
    path.points.push_back(row);
  }
  return path;
}

Stops stops_of(const ToolPath& path, const Correction& correction, const Cell& cell) {
  const std::vector<Vector3d> travel = directions(path);
  Stops stops;
  for (const PathRange& range : polylines(path)) {
    const std::size_t begin = stops.all.size();
    const std::size_t count = range.size() + (range.closed && range.size() > 2 ? 1 : 0);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = range.begin + k % range.size();
      const PathPoint& row = path.points[i];
      const double cut_mm_s = row.feed_mm_s > 0.0 ? row.feed_mm_s : cell.cut_speed_mm_s;
      const double speed_mm_s = correction.points[i].air_move ? cell.approach_speed_mm_s : cut_mm_s;
      stops.all.push_back({row.tip_mm, row.axis, travel[i], speed_mm_s, static_cast<std::ptrdiff_t>(i)});
    }
    stops.ranges.push_back({begin, stops.all.size(), range.closed});
  }
  return stops;
}

// The largest zone_mm / 2^k that is no more than half of the shorter neighbouring step; tiny ones become
// stops.
double zone_at_mm(const std::vector<Stop>& stops, const PathRange& range, std::size_t i, double zone_mm) {
  if (i == range.begin || i + 1 == range.end || zone_mm <= 0.0) return 0.0;
  const double step_mm = std::min((stops[i].tip_mm - stops[i - 1].tip_mm).norm(),
                                  (stops[i + 1].tip_mm - stops[i].tip_mm).norm());
  while (zone_mm > 0.5 * step_mm) {
    zone_mm *= 0.5;
    if (zone_mm < kSmallestZoneMm) return 0.0;
  }
  return zone_mm;
}

class Maker {
 public:
  Maker(const Cell& cell, bool dry_run, Program& program)
      : cell_(cell), dry_run_(dry_run), program_(program) {}

  void run(const Stops& stops, const std::vector<Eigen::Matrix3d>& frames) {
    for (const PathRange& range : stops.ranges) {
      const bool first = &range == &stops.ranges.front();
      above(stops.all[range.begin], frames[range.begin], first);
      if (first) tool_on();
      for (std::size_t i = range.begin; i < range.end; ++i)
        move(stops.all[i].tip_mm, frames[i], stops.all[i].speed_mm_s,
             zone_at_mm(stops.all, range, i, cell_.zone_mm), stops.all[i].row);
      above(stops.all[range.end - 1], frames[range.end - 1], false);
    }
    if (switches()) program_.events.emplace_back(SetOutput{cell_.spindle_output, false});
  }

 private:
  [[nodiscard]] bool switches() const { return !dry_run_ && !cell_.spindle_output.empty(); }

  void tool_on() {
    if (!switches()) return;
    program_.events.emplace_back(SetOutput{cell_.spindle_output, true});
    if (!cell_.spindle_ready.empty())
      program_.events.emplace_back(
          WaitInput{cell_.spindle_ready, true, cell_.ready_timeout_s, cell_.spindle_output});
  }

  void above(const Stop& stop, const Eigen::Matrix3d& frame, bool joint) {
    move(stop.tip_mm + cell_.clearance_mm * stop.axis, frame, cell_.approach_speed_mm_s, 0.0, -1);
    std::get<Move>(program_.events.back()).joint = joint;
  }

  void move(const Vector3d& tip_mm, const Eigen::Matrix3d& frame, double speed_mm_s, double zone_mm,
            std::ptrdiff_t row) {
    Move move;
    move.work_from_tool.linear() = frame;
    move.work_from_tool.translation() = tip_mm;
    move.speed_mm_s = speed_mm_s * (dry_run_ ? cell_.dry_run_speed_ratio : 1.0);
    move.zone_mm = zone_mm;
    move.row = row;
    const double away_mm = (cell_.robot_from_work * tip_mm).norm();
    if (!(away_mm <= cell_.reach_mm))
      throw Error(Fault::kRecipe,
                  ErrorText{"the program leaves the robot's reach",
                            row < 0 ? "clearance" : "row " + std::to_string(row + 1),
                            fixed_text(away_mm, 0) + " mm from the robot's base",
                            "at most " + fixed_text(cell_.reach_mm, 0) + " mm (cell.reach_mm)",
                            "check robot_from_scan in the cell"});
    program_.events.emplace_back(move);
  }

  const Cell& cell_;
  bool dry_run_;
  Program& program_;
};

}  // namespace

std::string name_of_program(const Cell& cell, bool dry_run) {
  return cell.program_name + (dry_run ? "Dry" : "");
}

Program make_program(const Correction& correction, const Vector3d& offset_mm, const Cell& cell,
                     const ProgramOptions& options) {
  cell.check();
  if (!correction.accepted())
    throw Error(Fault::kBug, "a robot program asked for a correction that is refused");
  Program program;
  program.cell = cell;
  program.name = name_of_program(cell, options.dry_run);
  program.result_hash = options.result_hash;
  program.comments = options.comments;
  program.dry_run = options.dry_run;

  const double lift_mm = options.dry_run ? cell.dry_run_offset_mm : 0.0;
  const Stops stops = stops_of(in_work_frame(correction, offset_mm, cell, lift_mm), correction, cell);
  std::vector<Vector3d> axes, travel;
  for (const Stop& stop : stops.all) {
    axes.push_back(stop.axis);
    travel.push_back(stop.travel);
  }
  Maker(cell, options.dry_run, program).run(stops, tool_frames(axes, travel, options.spin));
  return program;
}

}  // namespace arris
