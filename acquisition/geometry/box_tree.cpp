#include "acquisition/geometry/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace arris {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kBins = 16;

float float_below(double value) {
  return std::nextafter(static_cast<float>(value), -kInfinity);
}
float float_above(double value) {
  return std::nextafter(static_cast<float>(value), kInfinity);
}

/// Half the surface: what the heuristic weighs a box by.
double half_area(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return 0.0;
  const Eigen::Vector3d size = box.sizes();
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

struct Range {
  std::size_t first, last;
  int depth;  // halvings that led to it
  Eigen::AlignedBox3d box;
  [[nodiscard]] std::size_t count() const { return last - first; }
};

struct Bin {
  Eigen::AlignedBox3d box;
  std::size_t count = 0;
};

}  // namespace

struct BoxTree::Builder {
  std::span<const Eigen::AlignedBox3d> boxes;
  BoxTree& tree;
  std::vector<std::uint32_t> order = std::vector<std::uint32_t>(boxes.size());

  [[nodiscard]] Eigen::Vector3d middle(std::size_t place) const { return boxes[order[place]].center(); }

  [[nodiscard]] Range range(std::size_t first, std::size_t last, int depth) const {
    Range made{first, last, depth, {}};
    for (std::size_t i = first; i < last; ++i) made.box.extend(boxes[order[i]]);
    return made;
  }

  /// Where to part a range of two or more in two: between the bins of the widest axis where the areas cost
  /// least. In the middle of the order where that parts nothing off (all centres in one place), and from half
  /// the depth on, which bounds the depth.
  [[nodiscard]] std::size_t split(const Range& whole) {
    const std::size_t half = whole.first + whole.count() / 2;
    Eigen::AlignedBox3d centres;
    for (std::size_t i = whole.first; i < whole.last; ++i) centres.extend(middle(i));
    int axis = 0;
    const double width_mm = centres.sizes().maxCoeff(&axis);
    if (!(width_mm > 0.0)) return half;
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(whole.first);
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(whole.last);
    if (whole.depth >= kDeepest / 2) {
      const auto nth = order.begin() + static_cast<std::ptrdiff_t>(half);
      std::nth_element(begin, nth, end, [&](std::uint32_t a, std::uint32_t b) {
        const double at_a = boxes[a].center()[axis], at_b = boxes[b].center()[axis];
        return at_a < at_b || (at_a == at_b && a < b);
      });
      return half;
    }
    const auto bin_of = [&](std::uint32_t item) {
      const double ratio = (boxes[item].center()[axis] - centres.min()[axis]) / width_mm;
      return std::clamp(static_cast<int>(ratio * kBins), 0, kBins - 1);
    };
    const int cut = cheapest_cut(whole, bin_of);
    const auto parted = std::partition(begin, end, [&](std::uint32_t item) { return bin_of(item) < cut; });
    const auto place = static_cast<std::size_t>(parted - order.begin());
    return place == whole.first || place == whole.last ? half : place;
  }

  template <class BinOf>
  [[nodiscard]] int cheapest_cut(const Range& whole, const BinOf& bin_of) const {
    std::array<Bin, kBins> bins;
    for (std::size_t i = whole.first; i < whole.last; ++i) {
      Bin& bin = bins[static_cast<std::size_t>(bin_of(order[i]))];
      bin.box.extend(boxes[order[i]]);
      ++bin.count;
    }
    std::array<double, kBins> right_cost{};
    Bin right;
    for (std::size_t b = kBins - 1; b > 0; --b) {
      right.box.extend(bins[b].box);
      right.count += bins[b].count;
      right_cost[b] = half_area(right.box) * static_cast<double>(right.count);
    }
    int cut = 1;
    double least = std::numeric_limits<double>::infinity();
    Bin left;
    for (std::size_t b = 1; b < kBins; ++b) {
      left.box.extend(bins[b - 1].box);
      left.count += bins[b - 1].count;
      const double cost = half_area(left.box) * static_cast<double>(left.count) + right_cost[b];
      if (cost < least) least = cost, cut = static_cast<int>(b);
    }
    return cut;
  }

  /// Parts the range until it has four pieces, the largest first; returns the node's number.
  std::int32_t build(const Range& whole) {
    std::vector<Range> pieces = {whole};
    while (pieces.size() < kWidth) {
      const auto largest = std::max_element(pieces.begin(), pieces.end(), [](const Range& a, const Range& b) {
        return (a.count() > 1 ? half_area(a.box) + 1e-300 : 0.0) <
               (b.count() > 1 ? half_area(b.box) + 1e-300 : 0.0);
      });
      if (largest->count() < 2) break;
      const Range parent = *largest;
      const std::size_t at = split(parent);
      *largest = range(parent.first, at, parent.depth + 1);
      pieces.push_back(range(at, parent.last, parent.depth + 1));
    }
    const auto id = static_cast<std::int32_t>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    Node node;
    node.child.fill(kNone);
    for (auto* side : {&node.low_mm, &node.high_mm}) side->fill(Eigen::Array4f::Zero());
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        node.low_mm[a][static_cast<int>(k)] = float_below(pieces[k].box.min()[axis] - tree.centre_mm_[axis]);
        node.high_mm[a][static_cast<int>(k)] = float_above(pieces[k].box.max()[axis] - tree.centre_mm_[axis]);
      }
      node.child[k] =
          pieces[k].count() == 1 ? -1 - static_cast<std::int32_t>(order[pieces[k].first]) : build(pieces[k]);
    }
    tree.nodes_[static_cast<std::size_t>(id)] = node;
    return id;
  }
};

BoxTree::BoxTree(std::span<const Eigen::AlignedBox3d> boxes_mm) {
  if (boxes_mm.empty()) return;
  Builder builder{boxes_mm, *this};
  std::iota(builder.order.begin(), builder.order.end(), 0U);
  const Range whole = builder.range(0, boxes_mm.size(), 0);
  centre_mm_ = whole.box.center();
  half_extent_mm_ = 0.5 * whole.box.sizes().maxCoeff();
  nodes_.reserve(boxes_mm.size() / 2 + 1);
  builder.build(whole);
  nodes_.shrink_to_fit();
}

}  // namespace arris
