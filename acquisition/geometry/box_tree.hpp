#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace arris {

/// A tree of boxes, four to a node, for nearest-first searches: it knows where an item may lie, its owner
/// knows the item. The boxes are floats about a centre, rounded outward, and searched with slack for the
/// rounding of the query: an item within the limit is never hidden. Binned surface-area heuristic (Wald, IEEE
/// RT 2007). About 41 bytes an item; built in O(n log n), the same tree for the same boxes.
class BoxTree {
 public:
  BoxTree() = default;
  /// One box an item; none may be empty or hold what is not finite. The same tree for any number of threads
  /// (0: all of the machine).
  explicit BoxTree(std::span<const Eigen::AlignedBox3d> boxes_mm, int threads = 0);

  /// Calls look_at(item) for the items whose box may reach within the limit of the query, nearer boxes first;
  /// look_at answers the limit to go on with, mm squared, that or a smaller one. An item exactly at the limit
  /// is looked at. The query must be finite.
  template <class LookAt>
  void search(const Eigen::Vector3d& query_mm, double limit2_mm2, LookAt&& look_at) const;

  static constexpr std::size_t kWidth = 4;
  static constexpr std::int32_t kNone = INT32_MIN;
  static constexpr int kDeepest = 64;  // halvings, see split()
  static constexpr std::size_t kMostOpen = (kWidth - 1) * kDeepest + kWidth;

  /// Boxes about the centre of up to four children, each a node (0 and up), an item (-1 - its place) or none;
  /// the boxes of those that are none are empty. Plain numbers, for searches of their own
  /// (packet_search.hpp); node 0 is the root.
  struct alignas(16) Node {
    float low_mm[3][kWidth], high_mm[3][kWidth];
    std::int32_t child[kWidth];
  };
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  /// The items by their places: those near each other in the tree follow each other.
  [[nodiscard]] std::span<const std::int32_t> item_at() const { return item_at_; }
  [[nodiscard]] const Eigen::Vector3d& centre_mm() const { return centre_mm_; }

  /// How far rounding may have moved a float query about the centre, or a box; mm.
  [[nodiscard]] double slack_mm(const Eigen::Vector3d& local_mm) const {
    return kFloatSlackRatio * (local_mm.cwiseAbs().maxCoeff() + half_extent_mm_);
  }
  /// The float limit that no box within the true one exceeds, for a query that rounding moved by slack_mm.
  [[nodiscard]] static float limit_above(double limit2_mm2, double slack_mm) {
    const double limit_mm = std::sqrt(limit2_mm2) * (1.0 + kFloatSlackRatio) + slack_mm;
    if (!(limit_mm < 1e18)) return std::numeric_limits<float>::infinity();  // its square must stay a float
    return static_cast<float>(limit_mm * limit_mm * (1.0 + kFloatSlackRatio));
  }

 private:
  struct Open {
    float distance2_mm2;
    std::int32_t child;
  };
  struct Builder;
  static Eigen::Map<const Eigen::Array4f, Eigen::Aligned16> side(const float (&values)[kWidth]) {
    return Eigen::Map<const Eigen::Array4f, Eigen::Aligned16>(values);
  }

  // Rounding to float moves a query by at most 2^-24 of its size, the distance to a box by a few times that
  // of itself. Sixteen roundings are allowed for.
  static constexpr double kFloatSlackRatio = 1e-6;

  Eigen::Vector3d centre_mm_ = Eigen::Vector3d::Zero();
  double half_extent_mm_ = 0.0;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> item_at_;
};

template <class LookAt>
void BoxTree::search(const Eigen::Vector3d& query_mm, double limit2_mm2, LookAt&& look_at) const {
  if (nodes_.empty()) return;
  const Eigen::Vector3d local_mm = query_mm - centre_mm_;
  const double slack = slack_mm(local_mm);
  const std::array<float, 3> q = {static_cast<float>(local_mm.x()), static_cast<float>(local_mm.y()),
                                  static_cast<float>(local_mm.z())};
  float limit = limit_above(limit2_mm2, slack);
  std::array<Open, kMostOpen> stack;
  std::size_t open = 0;
  stack[open++] = {0.0F, 0};
  while (open > 0) {
    const Open at = stack[--open];
    if (at.distance2_mm2 > limit) continue;
    if (at.child < 0) {
      const double next2_mm2 = look_at(item_at_[static_cast<std::size_t>(-1 - at.child)]);
      if (next2_mm2 < limit2_mm2) {
        limit2_mm2 = next2_mm2;
        limit = limit_above(limit2_mm2, slack);
      }
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(at.child)];
    Eigen::Array4f distance2 = Eigen::Array4f::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis)
      distance2 +=
          (side(node.low_mm[axis]) - q[axis]).max(q[axis] - side(node.high_mm[axis])).max(0.0F).square();
    // The nearest on top, the others as they come: sorting them costs more than it saves.
    std::size_t nearest = open;
    for (std::size_t k = 0; k < kWidth; ++k) {
      const float at2 = distance2[static_cast<int>(k)];
      if (node.child[k] == kNone || at2 > limit) continue;
      stack[open] = {at2, node.child[k]};
      if (at2 < stack[nearest].distance2_mm2) nearest = open;
      ++open;
    }
    if (nearest + 1 < open) std::swap(stack[nearest], stack[open - 1]);
  }
}

}  // namespace arris
