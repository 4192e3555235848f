#include "acquisition/smooth_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "acquisition/geometry/parallel_for.hpp"

namespace arris {
namespace {

constexpr double kGateSigmas = 4.0;
constexpr double kGateSpacings = 0.06;
constexpr std::size_t kMayStandOff = 2;  // of a flat point's neighbours
constexpr int kCarryRounds = 4;          // neighbourhoods from the last flat point to the edge
constexpr std::size_t kChunk = 256;

using Values = std::array<double, NeighbourTable::kCount>;

double ranked(Values& values, std::size_t count, std::size_t rank) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.begin() + static_cast<std::ptrdiff_t>(count));
  return *place;
}

class SurfaceGrower {
 public:
  SurfaceGrower(std::span<const Eigen::Vector3d> points_mm, const NeighbourTable& table,
                const LocalPlanes& planes, int threads)
      : points_mm_(points_mm),
        table_(table),
        gate_mm_(std::max(kGateSigmas * planes.noise_sigma_mm, kGateSpacings * planes.spacing_median_mm)),
        threads_(threads),
        surface_{planes.normals, std::vector<char>(points_mm.size(), 0)} {}

  SmoothSurface grow() {
    for_each_point([&](std::size_t i) { surface_.on[i] = is_flat(i) ? 1 : 0; });
    for (int round = 0; round < kCarryRounds; ++round) {
      SmoothSurface next = surface_;
      for_each_point([&](std::size_t i) {
        if (!surface_.on[i]) carry_to(i, next);
      });
      surface_ = std::move(next);
    }
    return std::move(surface_);
  }

 private:
  void for_each_point(const auto& visit) const {
    parallel_for(points_mm_.size(), kChunk, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(i);
    });
  }

  [[nodiscard]] bool is_flat(std::size_t i) const {
    Values heights_mm{};
    std::size_t count = 0;
    for (const std::int32_t j : table_.of(i))
      if (j >= 0) heights_mm[count++] = std::abs(height_mm(static_cast<std::size_t>(j), i));
    if (count <= kMayStandOff) return false;
    return ranked(heights_mm, count, count - 1 - kMayStandOff) < gate_mm_;
  }

  /// Median of the normals of the neighbours that are on the surface, and of the heights over their planes.
  void carry_to(std::size_t i, SmoothSurface& next) const {
    Values heights_mm{};
    std::array<Values, 3> normals{};
    std::size_t count = 0;
    for (const std::int32_t neighbour : table_.of(i)) {
      const auto j = static_cast<std::size_t>(neighbour);
      if (neighbour < 0 || !surface_.on[j]) continue;
      heights_mm[count] = height_mm(i, j);
      for (int axis = 0; axis < 3; ++axis)
        normals[static_cast<std::size_t>(axis)][count] = surface_.normals[j][axis];
      ++count;
    }
    if (count == 0 || std::abs(ranked(heights_mm, count, count / 2)) >= gate_mm_) return;
    Eigen::Vector3d normal;
    for (int axis = 0; axis < 3; ++axis)
      normal[axis] = ranked(normals[static_cast<std::size_t>(axis)], count, count / 2);
    if (normal.norm() < 0.1) return;
    next.normals[i] = normal.normalized();
    next.on[i] = 1;
  }

  /// Of point i over the plane of point j.
  [[nodiscard]] double height_mm(std::size_t i, std::size_t j) const {
    return surface_.normals[j].dot(points_mm_[i] - points_mm_[j]);
  }

  std::span<const Eigen::Vector3d> points_mm_;
  const NeighbourTable& table_;
  double gate_mm_;
  int threads_;
  SmoothSurface surface_;
};

}  // namespace

NeighbourTable neighbour_table(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
                               int threads) {
  NeighbourTable table{std::vector<std::int32_t>(points_mm.size() * NeighbourTable::kCount, -1)};
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest_k(points_mm[i], static_cast<int>(NeighbourTable::kCount) + 1, near);
      std::size_t k = 0;
      for (const Neighbour& neighbour : near)
        if (neighbour.index != static_cast<std::int32_t>(i) && k < NeighbourTable::kCount)
          table.index[i * NeighbourTable::kCount + k++] = neighbour.index;
    }
  });
  return table;
}

SmoothSurface smooth_surface(std::span<const Eigen::Vector3d> points_mm, const NeighbourTable& table,
                             const LocalPlanes& planes, int threads) {
  return SurfaceGrower(points_mm, table, planes, threads).grow();
}

}  // namespace arris
