#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace arris::files {

/// Gives points that are equal bit for bit one index (-0 counts as 0), numbered in the order in which they
/// first come. An open hash table; cost O(corners), no sort, so the numbering follows the file.
template <class Real>
class Welder {
 public:
  using Point = Eigen::Matrix<Real, 3, 1>;

  explicit Welder(std::size_t corners_expected);

  /// Indices of all corners, in order, into index[0..].
  void add(std::span<const Point> corners, std::int32_t* index);

  [[nodiscard]] std::vector<Point>& points() { return points_; }

 private:
  struct Slot {
    std::uint32_t hash = 0;
    std::int32_t index = -1;
  };

  std::int32_t find_or_add(const Point& point, std::uint32_t hash);
  void grow();

  std::vector<Slot> slots_;
  std::vector<Point> points_;
};

extern template class Welder<float>;
extern template class Welder<double>;

}  // namespace arris::files
