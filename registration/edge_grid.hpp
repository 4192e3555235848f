#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace arris {

/// A place on an edge, and the way across it into the material, in a plane.
struct EdgePlace {
  Eigen::Vector2d place_mm;
  double inward_rad;
};

/// Squared distances of a plane's cells to the nearest edge whose material lies on nearly the same side,
/// capped; and the least of them over squares of cells, for a branch and bound.
class EdgeGrid {
 public:
  static constexpr int kSectors = 8;  ///< of the ways into the material
  static constexpr int kLevels = 6;   ///< squares of 1, 2, 4 .. 32 cells

  /// Cells of a third of the cap, larger where there would be too many. One edge place at least.
  EdgeGrid(const std::vector<EdgePlace>& edges, double cap_mm);

  [[nodiscard]] double step_mm() const { return step_mm_; }
  /// Where cell 0, 0 begins: no edge lies lower.
  [[nodiscard]] const Eigen::Vector2d& low_mm() const { return low_mm_; }
  /// Of an axis, as far as there are edges.
  [[nodiscard]] int cells(std::size_t axis) const { return cells_[axis]; }
  [[nodiscard]] static int sector_of(double inward_rad);
  /// The least over 2^level by 2^level cells from x, y on, which may lie anywhere; mm squared.
  [[nodiscard]] float least2(int sector, int level, int x, int y) const {
    x += margin_;
    y += margin_;
    const int reach = 1 << level;
    if (x <= -reach || y <= -reach || x >= wide_ || y >= high_) return cap2_mm2_;
    return levels_[static_cast<std::size_t>(sector)][static_cast<std::size_t>(level)]
                  [index(std::max(x, 0), std::max(y, 0))];
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(wide_) + static_cast<std::size_t>(x);
  }
  void draw(const Eigen::Vector2d& edge, int sector);
  void pool(const std::vector<float>& from, int half, std::vector<float>& to) const;

  float cap2_mm2_;
  double step_mm_;
  Eigen::Vector2d low_mm_;
  std::array<int, 2> cells_{};
  int margin_, wide_, high_;  // cells: about the edges, and in all
  std::array<std::array<std::vector<float>, kLevels>, kSectors> levels_;
};

}  // namespace arris
