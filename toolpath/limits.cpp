#include "toolpath/limits.hpp"

#include <algorithm>

#include "toolpath/formats/number.hpp"

namespace arris {
namespace {

constexpr double kDegPerRad = 57.295779513082320877;
constexpr std::size_t kRunsListed = 20;

struct Run {
  std::size_t first = 0, last = 0;
  double worst = 0.0;
};

std::vector<Run> runs_of(const ToolPath& nominal,
                         const std::function<std::optional<double>(std::size_t)>& over) {
  std::vector<Run> runs;
  for (const PathRange& range : polylines(nominal)) {
    bool open = false;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::optional<double> excess = over(i);
      if (!excess) {
        open = false;
      } else if (open) {
        runs.back().last = i;
        runs.back().worst = std::max(runs.back().worst, *excess);
      } else {
        runs.push_back({i, i, *excess});
        open = true;
      }
    }
  }
  return runs;
}

std::string name_of(const Run& run, const ToolPath& nominal, const std::vector<double>& arc_mm,
                    bool several) {
  std::string name = several ? "path " + std::to_string(nominal.points[run.first].path) + ", " : "";
  const std::string from = fixed_text(arc_mm[run.first], 1);
  if (run.first == run.last) return name + "row " + std::to_string(run.first + 1) + " (s = " + from + " mm)";
  return name + "rows " + std::to_string(run.first + 1) + " to " + std::to_string(run.last + 1) +
         " (s = " + from + " to " + fixed_text(arc_mm[run.last], 1) + " mm)";
}

void append(std::vector<std::string>& all, std::vector<std::string> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

// By how much the step from row i to its successor departs from the nominal step, carried by the rotation of
// either end; nothing within the limit, and nothing between rows that an air move ties to different places.
std::vector<std::optional<double>> broken_steps(const ToolPath& nominal, const Correction& correction,
                                                const std::vector<Eigen::Matrix3d>& rotations,
                                                const CorrectOptions& options) {
  std::vector<std::optional<double>> broken(nominal.points.size());
  const auto judge = [&](std::size_t i, std::size_t j) {
    const CorrectedPoint &a = correction.points[i], &b = correction.points[j];
    if (!a.has_place || !b.has_place || ((a.air_move || b.air_move) && a.anchor != b.anchor)) return;
    const Eigen::Vector3d step_mm = nominal.points[j].tip_mm - nominal.points[i].tip_mm;
    const Eigen::Vector3d moved_mm = b.point.tip_mm - a.point.tip_mm;
    const double excess_mm =
        std::min((moved_mm - rotations[i] * step_mm).norm(), (moved_mm - rotations[j] * step_mm).norm());
    if (excess_mm > (options.max_step_ratio - 1.0) * step_mm.norm() + options.step_slack_mm)
      broken[i] = excess_mm;
  };
  for (const PathRange& range : polylines(nominal)) {
    for (std::size_t i = range.begin; i + 1 < range.end; ++i) judge(i, i + 1);
    if (range.closed && range.size() > 2) judge(range.end - 1, range.begin);
  }
  return broken;
}

}  // namespace

std::vector<std::string> list_rows(const ToolPath& nominal,
                                   const std::function<std::optional<double>(std::size_t)>& over,
                                   const std::function<std::string(double)>& say) {
  const std::vector<Run> runs = runs_of(nominal, over);
  if (runs.empty()) return {};
  const std::vector<double> arc_mm = arc_along_mm(nominal);
  const bool several = nominal.points.front().path != nominal.points.back().path;
  std::vector<std::string> lines;
  for (std::size_t r = 0; r < std::min(runs.size(), kRunsListed); ++r)
    lines.push_back(name_of(runs[r], nominal, arc_mm, several) + ": " + say(runs[r].worst));
  if (runs.size() > kRunsListed) {
    std::size_t rows = 0;
    double worst = 0.0;
    for (std::size_t r = kRunsListed; r < runs.size(); ++r) {
      rows += runs[r].last - runs[r].first + 1;
      worst = std::max(worst, runs[r].worst);
    }
    lines.push_back(std::to_string(rows) + " more rows in " + std::to_string(runs.size() - kRunsListed) +
                    " places: " + say(worst));
  }
  return lines;
}

std::vector<std::string> limits_broken(const ToolPath& nominal, const Correction& correction,
                                       const std::vector<Eigen::Matrix3d>& rotations,
                                       const CorrectOptions& options) {
  const auto over = [](double value, double limit) {
    return value <= limit ? std::optional<double>() : std::optional<double>(value);
  };
  std::vector<std::string> reasons = list_rows(
      nominal, [&](std::size_t i) { return over(correction.points[i].shift_mm, options.max_correction_mm); },
      [&](double worst_mm) {
        return "shift " + fixed_text(worst_mm, 2) + " mm, limit " + fixed_text(options.max_correction_mm, 2) +
               " mm";
      });
  append(
      reasons,
      list_rows(
          nominal, [&](std::size_t i) { return over(correction.points[i].tilt_rad, options.max_tilt_rad); },
          [&](double worst_rad) {
            return "axis turned by " + fixed_text(worst_rad * kDegPerRad, 1) + " deg, limit " +
                   fixed_text(options.max_tilt_rad * kDegPerRad, 1) + " deg";
          }));
  const std::vector<std::optional<double>> broken = broken_steps(nominal, correction, rotations, options);
  append(reasons, list_rows(
                      nominal, [&](std::size_t i) { return broken[i]; },
                      [&](double worst_mm) {
                        return "the step to the next row departs by " + fixed_text(worst_mm, 1) +
                               " mm from the nominal step, limit " +
                               fixed_text((options.max_step_ratio - 1.0) * 100.0, 0) + " % of it plus " +
                               fixed_text(options.step_slack_mm, 1) + " mm";
                      }));
  return reasons;
}

}  // namespace arris
