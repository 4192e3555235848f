#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace arris {

/// Which nodes' unknowns may meet in one residual. With nodes numbered along the part (Cuthill and McKee,
/// Proc. 24th ACM Conf., 1969) they lie close to each other in number, so that normal equations are a band:
/// of node a, the nodes first(a) .. a.
class NodeBand {
 public:
  NodeBand() = default;
  /// first[a] <= a.
  explicit NodeBand(std::vector<std::size_t> first);
  /// Every node meets every other.
  [[nodiscard]] static NodeBand full(std::size_t nodes);

  [[nodiscard]] std::size_t nodes() const { return first_.size(); }
  [[nodiscard]] std::size_t first(std::size_t a) const { return first_[a]; }
  /// Place of the pair (a, b), first(a) <= b <= a, in a list of all pairs; and how many there are.
  [[nodiscard]] std::size_t pair(std::size_t a, std::size_t b) const { return start_[a] + b - first_[a]; }
  [[nodiscard]] std::size_t pairs() const { return pairs_; }

 private:
  std::vector<std::size_t> first_, start_;
  std::size_t pairs_ = 0;
};

/// Order in which points that are neighbours get numbers close to each other: breadth first from an outermost
/// one, each part of the cloud by itself. Neighbours are closer than their mean reach. O(n^2).
[[nodiscard]] std::vector<std::size_t> numbered_along(const std::vector<Eigen::Vector3d>& points_mm,
                                                      const std::vector<double>& reach_mm);
/// The band of points that meet when closer than both their reaches together.
[[nodiscard]] NodeBand band_of(const std::vector<Eigen::Vector3d>& points_mm,
                               const std::vector<double>& reach_mm);

}  // namespace arris
