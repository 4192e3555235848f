#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/bench/paper/experiments.hpp"
#include "tests/support/circularity.hpp"
#include "tests/support/released.hpp"

namespace arris::bench {
namespace {

/// Of one cut contour after release, against the drawing's.
struct ReleasedError {
  double across_mean_mm = 0.0, across_max_mm = 0.0;  ///< in the surface: what stands on the part
  double normal_mean_mm = 0.0;                       ///< how far off the face the tip was led
  double zone_mm = 0.0;  ///< circularity of a round contour, else profile of a line
};

ReleasedError released_error(const BenchPart& part, const CarriedPath& path) {
  const std::vector<Eigen::Vector3d> released_mm = ReleaseMap(part.fe).released_mm(path.tips_mm);
  const std::vector<RowError> rows = part.truth.rows(released_mm, false);
  ReleasedError error;
  for (const RowError& row : rows) {
    error.across_mean_mm += std::abs(row.across_mm) / static_cast<double>(rows.size());
    error.normal_mean_mm += std::abs(row.normal_mm) / static_cast<double>(rows.size());
    error.across_max_mm = std::max(error.across_max_mm, std::abs(row.across_mm));
  }
  error.zone_mm = part.truth.is_circle() ? circularity(released_mm).width_mm() : 2.0 * error.across_max_mm;
  return error;
}

struct ReleasedTally {
  std::string method;
  std::vector<ReleasedError> errors;
  int refused = 0;
  [[nodiscard]] double mean_mm(double ReleasedError::*member) const {
    double sum = 0.0;
    for (const ReleasedError& error : errors) sum += error.*member;
    return sum / static_cast<double>(std::max<std::size_t>(1, errors.size()));
  }
};

std::vector<Method> released_methods() {
  std::vector<Method> methods = all_methods();
  const Method forward = subdivision();
  methods.push_back({"backwards: the inverse of ours", [forward](ScanTrial& trial) {
                       std::optional<CarriedPath> path = forward.carry(trial);
                       if (path) *path = backwards(*rigid_icp().carry(trial), *path);
                       return path;
                     }});
  return methods;
}

std::vector<ReleasedTally> release_all(const BenchPart& part, int seeds) {
  const std::vector<Method> methods = released_methods();
  std::vector<ReleasedTally> tallies(methods.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    const synthetic::SyntheticScan scan = sample_scan(part.fe, {}, static_cast<std::uint64_t>(seed));
    ScanTrial trial(part, scan);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      tallies[m].method = methods[m].name;
      const std::optional<CarriedPath> path =
          trial.has_pose() ? methods[m].carry(trial) : std::optional<CarriedPath>();
      if (path) tallies[m].errors.push_back(released_error(part, *path));
      if (!path || !path->reasons.empty()) ++tallies[m].refused;
    }
  }
  return tallies;
}

}  // namespace

std::string release_section(const BenchPart& part, int seeds) {
  std::string text = fmt::format(
      "#### {}, cut and released\n\nScan: {} points, noise 0.05 mm, nothing missing; seeds 1 to {}.\n\n"
      "| path | across, mean | across, max | {} | off the face, mean | refused "
      "|\n|---|---|---|---|---|---|\n",
      part.fe.name(), part.fe.scan_points(), seeds,
      part.truth.is_circle() ? "circularity (ISO 1101 zone)" : "profile of the line (ISO 1101 zone)");
  for (const ReleasedTally& tally : release_all(part, seeds))
    text += fmt::format("| {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {} of {} |\n", tally.method,
                        tally.mean_mm(&ReleasedError::across_mean_mm),
                        tally.mean_mm(&ReleasedError::across_max_mm), tally.mean_mm(&ReleasedError::zone_mm),
                        tally.mean_mm(&ReleasedError::normal_mean_mm), tally.refused, seeds);
  return text + "\n";
}

}  // namespace arris::bench
