#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace arris {

/// One neighbour: index into the points the tree was built from, and its squared distance (mm^2).
struct Neighbour {
  std::int32_t index = -1;
  double distance2_mm2 = 0.0;
};

/// Nearest points of a fixed set; exact, safe to query from several threads. Build O(N log N), query O(log
/// N). FLANN's single kd-tree index inside, in double; ties are broken by the lower index.
class NearestPoints {
 public:
  /// Copies the points; an empty set is allowed and answers every query with nothing. Throws Error(kBug) for
  /// a point that is not finite; a query that is not finite finds nothing.
  explicit NearestPoints(std::span<const Eigen::Vector3d> points_mm);
  ~NearestPoints();
  NearestPoints(NearestPoints&&) noexcept;
  NearestPoints& operator=(NearestPoints&&) noexcept;

  [[nodiscard]] std::size_t size() const;
  /// index -1 when the set is empty.
  [[nodiscard]] Neighbour nearest(const Eigen::Vector3d& query_mm) const;
  /// Up to k neighbours, nearest first; `found` is reused.
  void nearest_k(const Eigen::Vector3d& query_mm, int k, std::vector<Neighbour>& found) const;
  /// All neighbours within radius_mm, nearest first; `found` is reused.
  void within(const Eigen::Vector3d& query_mm, double radius_mm, std::vector<Neighbour>& found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace arris
