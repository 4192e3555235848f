#include "acquisition/clean.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "acquisition/geometry/nearest.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr int kNeighbours = 8;
constexpr std::size_t kChunk = 1024;
constexpr double kLonelyRatio =
    2.0;  // farther from its neighbours than this many times what they are from theirs
constexpr double kAirRatio =
    6.0;  // strays that have only strays about them: this many times the cloud's median
constexpr int kMostRounds = 10;

void check(const CleanOptions& options) {
  if (!(options.outlier_sigmas >= 0.0) || !std::isfinite(options.outlier_sigmas))
    throw Error(Fault::kRecipe,
                "scan.outlier_sigmas = " + std::to_string(options.outlier_sigmas) + ", need >= 0");
  if (!(options.voxel_mm >= 0.0) || !std::isfinite(options.voxel_mm))
    throw Error(Fault::kRecipe, "scan.voxel_mm = " + std::to_string(options.voxel_mm) + ", need >= 0");
}

struct Isolation {
  std::vector<double> distance_mm;   // mean distance to the nearest neighbours
  std::vector<std::uint8_t> lonely;  // its neighbours are much closer to theirs, or the whole cloud is
};

Isolation measure_isolation(const std::vector<Eigen::Vector3d>& points_mm, int threads) {
  const NearestPoints tree(points_mm);
  Isolation isolation;
  isolation.distance_mm.resize(points_mm.size());
  isolation.lonely.resize(points_mm.size());
  std::vector<std::array<std::int32_t, kNeighbours>> neighbours(points_mm.size());
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest_k(points_mm[i], kNeighbours + 1, found);  // one of them is the point itself, or its double
      double sum_mm = 0.0;
      for (std::size_t n = 1; n < found.size(); ++n) {
        sum_mm += std::sqrt(found[n].distance2_mm2);
        neighbours[i][n - 1] = found[n].index;
      }
      isolation.distance_mm[i] = sum_mm / kNeighbours;
    }
  });
  std::vector<double> sorted_mm = isolation.distance_mm;
  const auto middle = sorted_mm.begin() + static_cast<std::ptrdiff_t>(sorted_mm.size() / 2);
  std::nth_element(sorted_mm.begin(), middle, sorted_mm.end());
  const double air_mm = kAirRatio * *middle;
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double sum_mm = 0.0;
      for (const std::int32_t n : neighbours[i]) sum_mm += isolation.distance_mm[static_cast<std::size_t>(n)];
      const double d_mm = isolation.distance_mm[i];
      isolation.lonely[i] = d_mm > air_mm || d_mm > kLonelyRatio * sum_mm / kNeighbours ? 1 : 0;
    }
  });
  return isolation;
}

// mean + sigmas * standard deviation of the distances of the points that are kept.
double limit_mm(const Isolation& isolation, const std::vector<std::int32_t>& kept, double sigmas,
                int threads) {
  using Sums = Eigen::Vector2d;
  const auto moments = [&](double about_mm) {
    const Sums zero = Sums::Zero();
    return parallel_sum(kept.size(), kChunk, threads, zero, [&](std::size_t begin, std::size_t end) {
      Sums part = Sums::Zero();
      for (std::size_t i = begin; i < end; ++i) {
        const double d_mm = isolation.distance_mm[static_cast<std::size_t>(kept[i])] - about_mm;
        part += Sums(d_mm, d_mm * d_mm);
      }
      return part;
    });
  };
  const auto count = static_cast<double>(kept.size());
  const double mean_mm = moments(0.0)(0) / count;
  return mean_mm + sigmas * std::sqrt(moments(mean_mm)(1) / count);
}

// One far stray widens the deviation and hides the others, so the limit is taken again without what it
// dropped.
std::vector<std::int32_t> without_outliers(const PointCloud& cloud, std::vector<std::int32_t> kept,
                                           const CleanOptions& options) {
  if (options.outlier_sigmas == 0.0 || kept.size() <= kNeighbours) return kept;
  const Isolation isolation = measure_isolation(local_points_mm(cloud), options.threads);
  for (int round = 0; round < kMostRounds; ++round) {
    const double most_mm = limit_mm(isolation, kept, options.outlier_sigmas, options.threads);
    const std::size_t dropped = std::erase_if(kept, [&](std::int32_t i) {
      const auto point = static_cast<std::size_t>(i);
      return isolation.lonely[point] != 0 && isolation.distance_mm[point] > most_mm;
    });
    if (dropped == 0) break;
  }
  return kept;
}

std::int32_t nearest_the_centroid(const PointCloud& cloud, std::span<const std::int32_t> points) {
  Eigen::Vector3d centroid_mm = Eigen::Vector3d::Zero();
  for (const std::int32_t i : points) centroid_mm += cloud.local_mm(static_cast<std::size_t>(i));
  centroid_mm /= static_cast<double>(points.size());
  const auto away_mm2 = [&](std::int32_t i) {
    return (cloud.local_mm(static_cast<std::size_t>(i)) - centroid_mm).squaredNorm();
  };
  return *std::min_element(points.begin(), points.end(),
                           [&](std::int32_t a, std::int32_t b) { return away_mm2(a) < away_mm2(b); });
}

std::vector<std::int32_t> one_a_voxel(const PointCloud& cloud, const std::vector<std::int32_t>& kept,
                                      double voxel_mm) {
  if (voxel_mm == 0.0) return kept;
  struct Member {
    std::array<double, 3> cell;  // whole numbers, in double: no coordinate overflows them
    std::int32_t point;
  };
  std::vector<Member> members;
  members.reserve(kept.size());
  for (const std::int32_t i : kept) {
    const Eigen::Vector3d p_mm = cloud.local_mm(static_cast<std::size_t>(i));
    members.push_back(
        {{std::floor(p_mm.x() / voxel_mm), std::floor(p_mm.y() / voxel_mm), std::floor(p_mm.z() / voxel_mm)},
         i});
  }
  std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.point < b.point;
  });
  std::vector<std::int32_t> thinned;
  std::vector<std::int32_t> cell_points;
  for (std::size_t first = 0; first < members.size();) {
    cell_points.clear();
    std::size_t last = first;
    for (; last < members.size() && members[last].cell == members[first].cell; ++last)
      cell_points.push_back(members[last].point);
    thinned.push_back(nearest_the_centroid(cloud, cell_points));
    first = last;
  }
  std::sort(thinned.begin(), thinned.end());
  return thinned;
}

PointCloud select(const PointCloud& cloud, const std::vector<std::int32_t>& kept) {
  PointCloud out;
  out.offset_mm = cloud.offset_mm;
  out.points_mm.reserve(kept.size());
  for (const std::int32_t i : kept) out.points_mm.push_back(cloud.points_mm[static_cast<std::size_t>(i)]);
  if (cloud.has_normals())
    for (const std::int32_t i : kept) out.normals.push_back(cloud.normals[static_cast<std::size_t>(i)]);
  return out;
}

}  // namespace

Cleaned clean(const PointCloud& cloud, const CleanOptions& options) {
  check(options);
  if (cloud.empty())
    throw Error(Fault::kInput, ErrorText{.what = "the scan holds no points",
                                         .where = {},
                                         .found = "0 points",
                                         .needed = "at least 1",
                                         .next = "look at the file with arris info"});
  Cleaned cleaned;
  std::vector<std::int32_t> all(cloud.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<std::int32_t> inliers = without_outliers(cloud, std::move(all), options);
  cleaned.kept = one_a_voxel(cloud, inliers, options.voxel_mm);
  cleaned.dropped_outliers = cloud.size() - inliers.size();
  cleaned.dropped_by_voxel = inliers.size() - cleaned.kept.size();
  cleaned.cloud = select(cloud, cleaned.kept);
  return cleaned;
}

PointCloud crop_to_band(const PointCloud& cloud, const std::vector<Eigen::Vector3d>& contour_local_mm,
                        double distance_mm) {
  if (!(distance_mm >= 0.0))
    throw Error(Fault::kBug, "crop_to_band: distance_mm = " + std::to_string(distance_mm) + ", need >= 0");
  const NearestPoints contour(contour_local_mm);
  std::vector<std::int32_t> kept;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Neighbour nearest = contour.nearest(cloud.local_mm(i));
    if (nearest.index >= 0 && nearest.distance2_mm2 <= distance_mm * distance_mm)
      kept.push_back(static_cast<std::int32_t>(i));
  }
  return select(cloud, kept);
}

}  // namespace arris
