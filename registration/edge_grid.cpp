#include "registration/edge_grid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace arris {
namespace {

constexpr double kStepRatio = 1.0 / 3.0;  // of the cap
constexpr int kMostCells = 320;           // an axis
constexpr int kBeside = 1;                // sectors to either side that count as the same side

}  // namespace

int EdgeGrid::sector_of(double inward_rad) {
  return static_cast<int>(std::lround(inward_rad * kSectors / (2.0 * std::numbers::pi))) & (kSectors - 1);
}

EdgeGrid::EdgeGrid(const std::vector<EdgePlace>& edges, double cap_mm)
    : cap2_mm2_(static_cast<float>(cap_mm * cap_mm)) {
  Eigen::AlignedBox2d box;
  for (const EdgePlace& edge : edges) box.extend(edge.place_mm);
  low_mm_ = box.min();
  step_mm_ = std::max(kStepRatio * cap_mm, box.sizes().maxCoeff() / (kMostCells - 1));
  margin_ = static_cast<int>(std::ceil(cap_mm / step_mm_)) + 1;
  for (std::size_t axis = 0; axis < 2; ++axis)
    cells_[axis] = static_cast<int>(box.sizes()[static_cast<int>(axis)] / step_mm_) + 1;
  wide_ = cells_[0] + 2 * margin_;
  high_ = cells_[1] + 2 * margin_;
  for (auto& levels : levels_) levels[0].assign(index(0, high_), cap2_mm2_);
  for (const EdgePlace& edge : edges) draw((edge.place_mm - low_mm_) / step_mm_, sector_of(edge.inward_rad));
  for (auto& levels : levels_)
    for (std::size_t level = 1; level < kLevels; ++level)
      pool(levels[level - 1], 1 << (level - 1), levels[level]);
}

/// Marks the cells about an edge place, counted in cells, by the distances of their middles.
void EdgeGrid::draw(const Eigen::Vector2d& edge, int sector) {
  const int x = static_cast<int>(edge.x()), y = static_cast<int>(edge.y());
  for (int j = y - margin_; j <= y + margin_; ++j)
    for (int i = x - margin_; i <= x + margin_; ++i) {
      const double off2 = (Eigen::Vector2d(i + 0.5, j + 0.5) - edge).squaredNorm() * step_mm_ * step_mm_;
      for (int beside = -kBeside; beside <= kBeside; ++beside) {
        float& least = levels_[static_cast<std::size_t>((sector + beside) & (kSectors - 1))][0]
                              [index(i + margin_, j + margin_)];
        least = std::min(least, static_cast<float>(off2));
      }
    }
}

void EdgeGrid::pool(const std::vector<float>& from, int half, std::vector<float>& to) const {
  to.resize(from.size());
  for (int y = 0; y < high_; ++y)
    for (int x = 0; x < wide_; ++x) {
      const int right = std::min(x + half, wide_ - 1), up = std::min(y + half, high_ - 1);
      to[index(x, y)] =
          std::min({from[index(x, y)], from[index(right, y)], from[index(x, up)], from[index(right, up)]});
    }
}

}  // namespace arris
