#include "registration/fpfh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/geometry/nearest.hpp"
#include "acquisition/geometry/parallel_for.hpp"

namespace arris {
namespace {

constexpr int kBins = 11;
constexpr std::size_t kChunk = 64;

std::size_t bin_of(double value, double low, double high) {
  const double ratio = (value - low) / (high - low);
  return static_cast<std::size_t>(std::clamp(static_cast<int>(ratio * kBins), 0, kBins - 1));
}

/// Adds the three angles of the Darboux frame of a pair; the frame stands at the point whose normal makes the
/// smaller angle with the line between them.
void add_pair(const Eigen::Vector3d& p, const Eigen::Vector3d& n, const Eigen::Vector3d& q,
              const Eigen::Vector3d& m, Fpfh& histogram) {
  Eigen::Vector3d line = (q - p).normalized(), u = n, other = m;
  if (std::abs(n.dot(line)) < std::abs(m.dot(line))) {
    u = m;
    other = n;
    line = -line;
  }
  const Eigen::Vector3d across = line.cross(u);
  if (across.squaredNorm() < 1e-12) return;
  const Eigen::Vector3d v = across.normalized(), w = u.cross(v);
  histogram[bin_of(v.dot(other), -1.0, 1.0)] += 1.0F;
  histogram[kBins + bin_of(u.dot(line), -1.0, 1.0)] += 1.0F;
  histogram[2 * kBins +
            bin_of(std::atan2(w.dot(other), u.dot(other)), -std::numbers::pi, std::numbers::pi)] += 1.0F;
}

/// Makes each of the three histograms sum to 1.
void normalise(Fpfh& histogram) {
  for (std::size_t part = 0; part < 3; ++part) {
    float sum = 0.0F;
    for (std::size_t i = 0; i < kBins; ++i) sum += histogram[part * kBins + i];
    if (sum > 0.0F)
      for (std::size_t i = 0; i < kBins; ++i) histogram[part * kBins + i] /= sum;
  }
}

}  // namespace

std::vector<Fpfh> fpfh_of(std::span<const Eigen::Vector3d> points_mm,
                          std::span<const Eigen::Vector3d> normals, double radius_mm, int threads) {
  const NearestPoints tree(points_mm);
  std::vector<std::vector<Neighbour>> near(points_mm.size());
  std::vector<Fpfh> simple(points_mm.size(), Fpfh{}), full(points_mm.size(), Fpfh{});
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      tree.within(points_mm[i], radius_mm, near[i]);
      std::erase_if(near[i], [](const Neighbour& n) { return n.distance2_mm2 <= 0.0; });
      for (const Neighbour& n : near[i]) {
        const auto k = static_cast<std::size_t>(n.index);
        add_pair(points_mm[i], normals[i], points_mm[k], normals[k], simple[i]);
      }
      normalise(simple[i]);
    }
  });
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      full[i] = simple[i];
      for (const Neighbour& n : near[i]) {
        const double weight = radius_mm / (std::sqrt(n.distance2_mm2) * static_cast<double>(near[i].size()));
        for (std::size_t b = 0; b < full[i].size(); ++b)
          full[i][b] += static_cast<float>(weight) * simple[static_cast<std::size_t>(n.index)][b];
      }
      normalise(full[i]);
    }
  });
  return full;
}

float distance2(const Fpfh& a, const Fpfh& b) {
  float sum = 0.0F;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace arris
