#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "tests/bench/accuracy/case.hpp"
#include "tests/bench/accuracy/special.hpp"
#include "tests/support/one_run.hpp"

namespace arris::bench {
namespace {

constexpr int kRounds = 3;

struct TimeGoal {
  const char* part;
  std::int64_t points;
  double limit_s;
};
constexpr TimeGoal kGoals[] = {{"nosecone", 10000, 1.0}, {"sheet", 100000, 3.0}, {"duct", 100000, 3.0}};

double length_mm(const BenchPart& part) {
  double sum_mm = 0.0;
  for (const synthetic::EdgeRange& range : synthetic::contour_ranges(part.truth.edge()))
    sum_mm += range.length_mm;
  return sum_mm;
}

/// Seconds from points in memory to the corrected path with its standard deviations; -1 when refused.
double run_s(const BenchPart& part, const PointCloud& cloud) {
  const auto begin = std::chrono::steady_clock::now();
  const OneRun run = run_one({part.recipe, part.cad, part.drawing.path, part.threads}, cloud,
                             calibrated_options(part.recipe, part.threads));
  const auto end = std::chrono::steady_clock::now();
  return run.accepted() ? std::chrono::duration<double>(end - begin).count() : -1.0;
}

}  // namespace

std::vector<GoalRow> time_rows(const SpecialSetup& setup) {
  std::vector<GoalRow> rows;
  for (const TimeGoal& goal : kGoals) {
    const BenchPart part(setup.fixtures / goal.part, setup.threads);
    synthetic::ScanOptions options;
    options.points = goal.points;
    const PointCloud cloud = sample_scan(part.fe, options, 1).cloud();
    std::vector<double> rounds_s;
    for (int round = 0; round < kRounds; ++round) rounds_s.push_back(run_s(part, cloud));
    std::sort(rounds_s.begin(), rounds_s.end());
    GoalRow row;
    row.what =
        fmt::format("time, {} points in the band of {:.0f} mm of contour, surface field with uncertainty",
                    cloud.size(), length_mm(part));
    row.part = goal.part;
    row.scans = kRounds;
    row.goal = fmt::format("{:.0f} s", goal.limit_s);
    row.refused = static_cast<std::size_t>(std::count(rounds_s.begin(), rounds_s.end(), -1.0));
    row.within = static_cast<std::size_t>(std::count_if(
        rounds_s.begin(), rounds_s.end(), [&](double s) { return s >= 0.0 && s <= goal.limit_s; }));
    row.reached = fmt::format("{:.2f} s (median)", rounds_s[kRounds / 2]);
    row.worst = fmt::format("{:.2f} s", rounds_s.back());
    row.met = row.refused == 0 && rounds_s[kRounds / 2] <= goal.limit_s;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace arris::bench
