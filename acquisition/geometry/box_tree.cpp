#include "acquisition/geometry/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kBins = 16, kFewBins = 6;
constexpr std::size_t kFewItems = 24;  // of so few the cuts are looked at more coarsely

/// A box of floats; the fourth lane is nothing's.
struct Box {
  Eigen::Array4f low = Eigen::Array4f::Constant(kInfinity), high = Eigen::Array4f::Constant(-kInfinity);
  void extend(const Box& other) {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  void extend(const Eigen::Array4f& point) {
    low = low.min(point);
    high = high.max(point);
  }
  /// Half the surface: what the heuristic weighs a box by. 0 when empty.
  [[nodiscard]] float half_area() const {
    const Eigen::Array4f size = (high - low).max(0.0F);
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

/// What is sorted: the box itself, so that a pass over a range reads memory in order.
struct Item {
  Box box;
  std::int32_t number;
  [[nodiscard]] Eigen::Array4f middle() const { return 0.5F * (box.low + box.high); }
};

struct Piece {
  std::size_t first, last;
  int depth;         // halvings that led to it
  Box box, middles;  // of its items
  [[nodiscard]] std::size_t count() const { return last - first; }
  /// The piece to part next has most of it; one item cannot be parted.
  [[nodiscard]] float to_part() const { return count() > 1 ? box.half_area() : -1.0F; }
};

struct Bin {
  Box box, middles;
  std::size_t count = 0;
  void add(const Bin& other) {
    box.extend(other.box);
    middles.extend(other.middles);
    count += other.count;
  }
  [[nodiscard]] float cost() const { return box.half_area() * static_cast<float>(count); }
};

}  // namespace

struct BoxTree::Builder {
  BoxTree& tree;
  std::vector<Item> items;

  [[nodiscard]] Piece piece(std::size_t first, std::size_t last, int depth) const {
    Piece made{first, last, depth, {}, {}};
    for (std::size_t i = first; i < last; ++i) {
      made.box.extend(items[i].box);
      made.middles.extend(items[i].middle());
    }
    return made;
  }

  /// Parts a piece of two or more in two: between the bins of the widest axis where the areas cost least. In
  /// the middle of the order where that parts nothing off (all middles in one place), and from half the depth
  /// on, which bounds the depth.
  [[nodiscard]] std::array<Piece, 2> parted(const Piece& whole) {
    int axis = 0;
    const float width_mm = (whole.middles.high - whole.middles.low).head<3>().maxCoeff(&axis);
    const auto begin = items.begin() + static_cast<std::ptrdiff_t>(whole.first);
    const auto end = items.begin() + static_cast<std::ptrdiff_t>(whole.last);
    if (width_mm > 0.0F && whole.depth < kDeepest / 2) {
      const int bin_count = whole.count() <= kFewItems ? kFewBins : kBins;
      const float low_mm = whole.middles.low[axis], bins_per_mm = static_cast<float>(bin_count) / width_mm;
      const auto bin_of = [&](const Item& item) {
        const float at_mm = 0.5F * (item.box.low[axis] + item.box.high[axis]) - low_mm;
        return std::clamp(static_cast<int>(std::min(at_mm * bins_per_mm, 1e3F)), 0, bin_count - 1);
      };
      std::array<Bin, kBins> all_bins;
      const std::span<Bin> bins(all_bins.data(), static_cast<std::size_t>(bin_count));
      for (auto item = begin; item != end; ++item) {
        Bin& bin = bins[static_cast<std::size_t>(bin_of(*item))];
        bin.box.extend(item->box);
        bin.middles.extend(item->middle());
        ++bin.count;
      }
      const int cut = cheapest_cut(bins);
      const auto middle = std::partition(begin, end, [&](const Item& item) { return bin_of(item) < cut; });
      const auto place = static_cast<std::size_t>(middle - items.begin());
      if (place != whole.first && place != whole.last) {
        Bin left, right;
        for (int b = 0; b < bin_count; ++b) (b < cut ? left : right).add(bins[static_cast<std::size_t>(b)]);
        return {Piece{whole.first, place, whole.depth + 1, left.box, left.middles},
                Piece{place, whole.last, whole.depth + 1, right.box, right.middles}};
      }
    }
    const std::size_t half = whole.first + whole.count() / 2;
    std::nth_element(begin, items.begin() + static_cast<std::ptrdiff_t>(half), end,
                     [&](const Item& a, const Item& b) {
                       const float at_a = a.middle()[axis], at_b = b.middle()[axis];
                       return at_a < at_b || (at_a == at_b && a.number < b.number);
                     });
    return {piece(whole.first, half, whole.depth + 1), piece(half, whole.last, whole.depth + 1)};
  }

  [[nodiscard]] static int cheapest_cut(std::span<const Bin> bins) {
    std::array<float, kBins> right_cost{};
    Bin right;
    for (std::size_t b = bins.size() - 1; b > 0; --b) {
      right.add(bins[b]);
      right_cost[b] = right.cost();
    }
    int cut = 1;
    float least = kInfinity;
    Bin left;
    for (std::size_t b = 1; b < bins.size(); ++b) {
      left.add(bins[b - 1]);
      const float cost = left.cost() + right_cost[b];
      if (cost < least) least = cost, cut = static_cast<int>(b);
    }
    return cut;
  }

  /// Up to four pieces of one: items, or parted until there are four, the largest first.
  [[nodiscard]] std::vector<Piece> pieces_of(const Piece& whole) {
    std::vector<Piece> pieces;
    pieces.reserve(kWidth);
    if (whole.count() <= kWidth) {
      for (std::size_t i = whole.first; i < whole.last; ++i)
        pieces.push_back({i, i + 1, whole.depth + 1, items[i].box, {}});
      return pieces;
    }
    pieces.push_back(whole);
    while (pieces.size() < kWidth) {
      const auto largest = std::max_element(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
        return a.to_part() < b.to_part();
      });
      if (largest->count() < 2) break;
      const auto [left, right] = parted(*largest);
      *largest = left;
      pieces.push_back(right);
    }
    return pieces;
  }

  /// Returns the node's number.
  std::int32_t build(const Piece& whole) {
    const std::vector<Piece> pieces = pieces_of(whole);
    const auto id = static_cast<std::int32_t>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    Node node;
    for (std::size_t k = 0; k < kWidth; ++k) {
      const bool is_there = k < pieces.size();
      const Box box = is_there ? pieces[k].box : Box();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low_mm[axis][k] = box.low[static_cast<int>(axis)];
        node.high_mm[axis][k] = box.high[static_cast<int>(axis)];
      }
      node.child[k] = kNone;
      if (is_there)
        node.child[k] = pieces[k].count() == 1 ? -1 - items[pieces[k].first].number : build(pieces[k]);
    }
    tree.nodes_[static_cast<std::size_t>(id)] = node;
    return id;
  }
};

BoxTree::BoxTree(std::span<const Eigen::AlignedBox3d> boxes_mm) {
  if (boxes_mm.empty()) return;
  Eigen::AlignedBox3d whole;
  for (const Eigen::AlignedBox3d& box : boxes_mm) whole.extend(box);
  centre_mm_ = whole.center();
  half_extent_mm_ = 0.5 * whole.sizes().maxCoeff();
  Builder builder{*this, {}};
  builder.items.reserve(boxes_mm.size());
  for (const Eigen::AlignedBox3d& box : boxes_mm) {
    Item item{{}, static_cast<std::int32_t>(builder.items.size())};
    item.box.low[3] = item.box.high[3] = 0.0F;
    for (int axis = 0; axis < 3; ++axis) {  // rounded outward
      item.box.low[axis] = std::nextafter(static_cast<float>(box.min()[axis] - centre_mm_[axis]), -kInfinity);
      item.box.high[axis] = std::nextafter(static_cast<float>(box.max()[axis] - centre_mm_[axis]), kInfinity);
    }
    builder.items.push_back(item);
  }
  nodes_.reserve(boxes_mm.size() / 2 + 1);
  builder.build(builder.piece(0, builder.items.size(), 0));
  nodes_.shrink_to_fit();
}

}  // namespace arris
