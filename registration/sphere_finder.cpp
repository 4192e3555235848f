#include "registration/sphere_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "acquisition/geometry/normals.hpp"
#include "acquisition/types/error.hpp"
#include "registration/sphere_fit.hpp"

namespace arris {
namespace {

constexpr double kThinRatio = 0.1;   // of the radius: spacing of the points that vote
constexpr double kCellRatio = 0.15;  // of the radius: votes are counted in blocks of 3 x 3 x 3 such cells
constexpr int kPlaneNeighbours = 12;
constexpr std::size_t kFewestVotes = 8, kMostTried = 2000, kMostPeaks = 20000, kMostSpheres = 60;
constexpr double kSurroundingsRatio = 1.3;              // of the radius: what is looked at round a peak
constexpr double kShellRatio = 0.12;                    // of the radius: near enough to judge normals
constexpr double kNormalCosine = 0.9;                   // 26 degrees from the radius
constexpr double kNormalShare = 0.7;                    // of the points near the sphere have its normals
constexpr double kApartRatio = 0.5, kTriedRatio = 0.1;  // of the radius: another sphere, another start

using Cell = std::array<std::int64_t, 3>;

Cell cell_of(const Eigen::Vector3d& p_mm, double cell_mm) {
  Cell cell{};
  for (int axis = 0; axis < 3; ++axis)
    cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(p_mm[axis] / cell_mm));
  return cell;
}

/// Numbers sorted by the cell of their point, then by number.
struct Binned {
  std::vector<Cell> cells;  // one an entry, ascending
  std::vector<std::size_t> entries;

  Binned(std::span<const Eigen::Vector3d> points_mm, double cell_mm) : entries(points_mm.size()) {
    std::vector<Cell> own(points_mm.size());
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = cell_of(points_mm[i], cell_mm);
    std::iota(entries.begin(), entries.end(), std::size_t{0});
    std::sort(entries.begin(), entries.end(),
              [&](std::size_t a, std::size_t b) { return own[a] != own[b] ? own[a] < own[b] : a < b; });
    for (const std::size_t entry : entries) cells.push_back(own[entry]);
  }
};

std::vector<Eigen::Vector3d> thinned(std::span<const Eigen::Vector3d> points_mm, double cell_mm) {
  const Binned binned(points_mm, cell_mm);
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < binned.cells.size(); ++k)
    if (k == 0 || binned.cells[k] != binned.cells[k - 1]) kept.push_back(binned.entries[k]);
  std::sort(kept.begin(), kept.end());
  std::vector<Eigen::Vector3d> out;
  for (const std::size_t i : kept) out.push_back(points_mm[i]);
  return out;
}

struct Peak {
  std::size_t votes = 0;
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();
};

/// Blocks of 3 x 3 x 3 cells about each cell that has votes, most votes first, each at the mean of its votes.
std::vector<Peak> peaks_of(const std::vector<Eigen::Vector3d>& votes_mm, double cell_mm) {
  const Binned binned(votes_mm, cell_mm);
  struct Count {
    std::size_t votes = 0;
    Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
  };
  std::vector<Cell> cells;
  std::vector<Count> counts;
  for (std::size_t k = 0; k < binned.cells.size(); ++k) {
    if (cells.empty() || cells.back() != binned.cells[k]) {
      cells.push_back(binned.cells[k]);
      counts.emplace_back();
    }
    ++counts.back().votes;
    counts.back().sum_mm += votes_mm[binned.entries[k]];
  }
  std::vector<Peak> peaks;
  for (const Cell& middle : cells) {
    Count block;
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y) {  // the three cells along z are neighbours in the order
        const Cell low{middle[0] + x, middle[1] + y, middle[2] - 1};
        auto at = std::lower_bound(cells.begin(), cells.end(), low);
        for (; at != cells.end() && (*at)[0] == low[0] && (*at)[1] == low[1] && (*at)[2] <= low[2] + 2;
             ++at) {
          const Count& count = counts[static_cast<std::size_t>(at - cells.begin())];
          block.votes += count.votes;
          block.sum_mm += count.sum_mm;
        }
      }
    if (block.votes >= kFewestVotes)
      peaks.push_back({block.votes, block.sum_mm / static_cast<double>(block.votes)});
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Peak& a, const Peak& b) { return a.votes > b.votes; });
  peaks.resize(std::min(peaks.size(), kMostPeaks));
  return peaks;
}

bool any_within(const std::vector<Eigen::Vector3d>& places_mm, const Eigen::Vector3d& p_mm, double reach_mm) {
  return std::any_of(places_mm.begin(), places_mm.end(),
                     [&](const Eigen::Vector3d& q_mm) { return (q_mm - p_mm).norm() < reach_mm; });
}

/// The thinned points with their planes: who votes, and who is asked about a peak.
struct Voters {
  std::vector<Eigen::Vector3d> points_mm;
  NearestPoints tree;
  LocalPlanes planes;

  Voters(std::vector<Eigen::Vector3d> points, int threads)
      : points_mm(std::move(points)),
        tree(points_mm),
        planes(fit_local_planes(points_mm, tree, kPlaneNeighbours, threads)) {}

  [[nodiscard]] std::vector<Eigen::Vector3d> votes_mm(double radius_mm) const {
    std::vector<Eigen::Vector3d> votes;
    for (std::size_t i = 0; i < points_mm.size(); ++i)
      for (const double side : {-1.0, 1.0})
        votes.emplace_back(points_mm[i] + side * radius_mm * planes.normals[i]);
    return votes;
  }

  /// Whether most points near the sphere are turned as it is, and in directions that fix its centre.
  [[nodiscard]] bool looks_round(const Eigen::Vector3d& centre_mm, double radius_mm) const {
    std::vector<Neighbour> near;
    tree.within(centre_mm, (1.0 + kShellRatio) * radius_mm, near);
    std::size_t turned = 0, all = 0;
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const Neighbour& neighbour : near) {
      if (std::sqrt(neighbour.distance2_mm2) < (1.0 - kShellRatio) * radius_mm) continue;
      const auto i = static_cast<std::size_t>(neighbour.index);
      const Eigen::Vector3d u = (points_mm[i] - centre_mm).normalized();
      ++all;
      if (std::abs(u.dot(planes.normals[i])) < kNormalCosine) continue;
      ++turned;
      squares += u * u.transpose();
    }
    constexpr double kLeastSpread = 0.03;  // looser than the fit's own
    return turned >= kFewestVotes && static_cast<double>(turned) >= kNormalShare * static_cast<double>(all) &&
           least_spread(squares, turned) > kLeastSpread;
  }
};

}  // namespace

void SphereOptions::check() const {
  if (!(radius_tolerance_ratio >= 0.0) || !(noise_most_ratio > 0.0) || fewest_points < 4)
    throw Error(Fault::kBug, "SphereOptions: ratios above 0 and at least 4 points are needed");
}

SphereFinder::SphereFinder(std::span<const Eigen::Vector3d> points_mm, const SphereOptions& options)
    : points_mm_(points_mm.begin(), points_mm.end()), tree_(points_mm_), options_(options) {
  options_.check();
}

std::vector<std::int32_t> SphereFinder::points_near(const Eigen::Vector3d& place_mm, double reach_mm) const {
  std::vector<Neighbour> near;
  tree_.within(place_mm, reach_mm, near);
  std::vector<std::int32_t> points;
  for (const Neighbour& neighbour : near) points.push_back(neighbour.index);
  std::sort(points.begin(), points.end());
  return points;
}

std::vector<FoundSphere> SphereFinder::find(double radius_mm) const {
  const Voters voters(thinned(points_mm_, kThinRatio * radius_mm), options_.threads);
  std::vector<FoundSphere> spheres;
  std::vector<Eigen::Vector3d> found_mm, tried_mm;
  for (const Peak& peak : peaks_of(voters.votes_mm(radius_mm), kCellRatio * radius_mm)) {
    if (tried_mm.size() >= kMostTried || spheres.size() >= kMostSpheres) break;
    if (any_within(found_mm, peak.place_mm, kApartRatio * radius_mm) ||
        any_within(tried_mm, peak.place_mm, kTriedRatio * radius_mm))
      continue;
    tried_mm.push_back(peak.place_mm);
    if (!voters.looks_round(peak.place_mm, radius_mm)) continue;
    std::optional<FoundSphere> sphere =
        fit_sphere(points_mm_, points_near(peak.place_mm, kSurroundingsRatio * radius_mm), peak.place_mm,
                   radius_mm, options_);
    if (!sphere || any_within(found_mm, sphere->centre_mm, kApartRatio * radius_mm)) continue;
    if (!voters.looks_round(sphere->centre_mm, radius_mm)) continue;
    found_mm.push_back(sphere->centre_mm);
    spheres.push_back(std::move(*sphere));
  }
  return spheres;
}

}  // namespace arris
