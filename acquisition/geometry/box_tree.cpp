#include "acquisition/geometry/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/geometry/curve_order.hpp"
#include "acquisition/geometry/parallel_for.hpp"

namespace arris {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kBins = 16, kFewBins = 6;
constexpr std::size_t kFewItems = 24;  // of so few the cuts are looked at more coarsely
constexpr std::size_t kRun = 512;      // items that follow each other on a curve, a branch of the tree
constexpr int kHalvedFrom = BoxTree::kDeepest / 2, kHalvedFromInParts = BoxTree::kDeepest / 4;
constexpr std::size_t kChunk = 4096;
constexpr float kRounding = 1.2e-7F,  // of itself: more than a float is off by
    kLeastRounding = std::numeric_limits<float>::min();

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
  std::int32_t number = 0;
  [[nodiscard]] Eigen::Array4f middle() const { return 0.5F * (box.low + box.high); }
};

struct Piece {
  std::size_t first = 0, last = 0;
  int depth = 0;     // halvings that led to it
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

float below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded - (std::abs(rounded) * kRounding + kLeastRounding);
}
float above(double value) {
  return -below(-value);
}

/// Along a space-filling curve, by the boxes' middles.
std::vector<std::uint32_t> order_of(std::span<const Eigen::AlignedBox3d> boxes_mm,
                                    const Eigen::Vector3d& centre_mm, int threads) {
  std::vector<Eigen::Vector3f> middles_mm(boxes_mm.size());
  parallel_for(boxes_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      middles_mm[i] = (boxes_mm[i].center() - centre_mm).cast<float>();
  });
  return curve_order(middles_mm, threads);
}

/// The boxes in an order (empty: as they come) about the centre, rounded outward.
std::vector<Item> items_of(std::span<const Eigen::AlignedBox3d> boxes_mm, const Eigen::Vector3d& centre_mm,
                           const std::vector<std::uint32_t>& order, int threads) {
  std::vector<Item> items(boxes_mm.size());
  parallel_for(items.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Item& item = items[i];
      const std::size_t number = order.empty() ? i : order[i];
      item.number = static_cast<std::int32_t>(number);
      item.box.low[3] = item.box.high[3] = 0.0F;
      const Eigen::Vector3d low_mm = boxes_mm[number].min() - centre_mm;
      const Eigen::Vector3d high_mm = boxes_mm[number].max() - centre_mm;
      for (int axis = 0; axis < 3; ++axis) {
        item.box.low[axis] = below(low_mm[axis]);
        item.box.high[axis] = above(high_mm[axis]);
      }
    }
  });
  return items;
}

}  // namespace

/// Builds nodes over items, which it puts in the order of the leaves.
struct BoxTree::Builder {
  std::span<Item> items;
  int halved_from;        // depth
  std::int32_t at_place;  // of the first item; -1: leaves tell the item's number
  std::vector<Node> nodes{};

  [[nodiscard]] Piece piece(std::size_t first, std::size_t last, int depth) const {
    Piece made{first, last, depth, {}, {}};
    for (std::size_t i = first; i < last; ++i) {
      made.box.extend(items[i].box);
      made.middles.extend(items[i].middle());
    }
    return made;
  }

  /// Parts a piece of two or more in two: between the bins of the widest axis where the areas cost least. In
  /// the middle of the order where that parts nothing off (all middles in one place), and from a depth on,
  /// which bounds it.
  [[nodiscard]] std::array<Piece, 2> parted(const Piece& whole) {
    int axis = 0;
    const float width_mm = (whole.middles.high - whole.middles.low).head<3>().maxCoeff(&axis);
    const auto begin = items.begin() + static_cast<std::ptrdiff_t>(whole.first);
    const auto end = items.begin() + static_cast<std::ptrdiff_t>(whole.last);
    if (width_mm > 0.0F && whole.depth < halved_from) {
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

  struct Pieces {
    std::array<Piece, kWidth> of;
    std::size_t count = 0;
    void add(const Piece& piece) { of[count++] = piece; }
  };

  /// Up to four pieces of one: items, or parted until there are four, the largest first.
  [[nodiscard]] Pieces pieces_of(const Piece& whole) {
    Pieces pieces;
    if (whole.count() <= kWidth) {
      for (std::size_t i = whole.first; i < whole.last; ++i)
        pieces.add({i, i + 1, whole.depth + 1, items[i].box, {}});
      return pieces;
    }
    pieces.add(whole);
    while (pieces.count < kWidth) {
      const auto end = pieces.of.begin() + static_cast<std::ptrdiff_t>(pieces.count);
      const auto largest = std::max_element(
          pieces.of.begin(), end, [](const Piece& a, const Piece& b) { return a.to_part() < b.to_part(); });
      if (largest->count() < 2) break;
      const auto [left, right] = parted(*largest);
      *largest = left;
      pieces.add(right);
    }
    return pieces;
  }

  /// Adds the node of a piece and all below it.
  std::int32_t build(const Piece& whole) {
    const Pieces pieces = pieces_of(whole);
    const std::size_t id = nodes.size();
    nodes.emplace_back();
    Node node;
    for (std::size_t k = 0; k < kWidth; ++k) {
      const bool is_there = k < pieces.count;
      const Box box = is_there ? pieces.of[k].box : Box();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low_mm[axis][k] = box.low[static_cast<int>(axis)];
        node.high_mm[axis][k] = box.high[static_cast<int>(axis)];
      }
      node.child[k] = kNone;
      if (!is_there) continue;
      if (pieces.of[k].count() > 1)
        node.child[k] = build(pieces.of[k]);
      else if (at_place >= 0)
        node.child[k] = -1 - at_place - static_cast<std::int32_t>(pieces.of[k].first);
      else
        node.child[k] = -1 - items[pieces.of[k].first].number;
    }
    nodes[id] = node;
    return static_cast<std::int32_t>(id);
  }

  void build() {
    nodes.reserve(items.size() / 2);  // a third is what most need
    build(piece(0, items.size(), 0));
  }

  static std::vector<Node> in_parts(std::span<Item> items, int threads);
};

/// Runs of a space-filling curve, built by themselves on all threads, under a tree of their boxes.
std::vector<BoxTree::Node> BoxTree::Builder::in_parts(std::span<Item> items, int threads) {
  const std::size_t runs = (items.size() - 1) / kRun + 1;
  std::vector<Builder> branches;
  branches.reserve(runs);
  for (std::size_t r = 0; r < runs; ++r)
    branches.push_back({items.subspan(r * kRun, std::min(kRun, items.size() - r * kRun)), kHalvedFromInParts,
                        static_cast<std::int32_t>(r * kRun)});
  std::vector<Item> boxes(runs);
  parallel_for(runs, 4, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      boxes[r] = {branches[r].piece(0, branches[r].items.size(), 0).box, static_cast<std::int32_t>(r)};
      branches[r].build();
    }
  });
  Builder top{boxes, kHalvedFromInParts, -1};
  top.build();
  std::size_t count = top.nodes.size();
  std::vector<std::int32_t> first;
  for (const Builder& branch : branches) {
    first.push_back(static_cast<std::int32_t>(count));
    count += branch.nodes.size();
  }
  for (Node& node : top.nodes)
    for (std::int32_t& child : node.child)
      if (child < 0 && child != kNone) child = first[static_cast<std::size_t>(-1 - child)];
  std::vector<Node> all(count);
  std::copy(top.nodes.begin(), top.nodes.end(), all.begin());
  parallel_for(runs, 4, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      auto into = all.begin() + first[r];
      for (Node node : branches[r].nodes) {
        for (std::int32_t& child : node.child)
          if (child >= 0) child += first[r];
        *into++ = node;
      }
    }
  });
  return all;
}

BoxTree::BoxTree(std::span<const Eigen::AlignedBox3d> boxes_mm, int threads) {
  if (boxes_mm.empty()) return;
  Eigen::AlignedBox3d whole;
  for (const Eigen::AlignedBox3d& box : boxes_mm) whole.extend(box);
  centre_mm_ = whole.center();
  half_extent_mm_ = 0.5 * whole.sizes().maxCoeff();
  const bool in_parts = boxes_mm.size() > 2 * kRun;
  std::vector<std::uint32_t> order;
  if (in_parts) order = order_of(boxes_mm, centre_mm_, threads);
  std::vector<Item> items = items_of(boxes_mm, centre_mm_, order, threads);
  if (in_parts) {
    nodes_ = Builder::in_parts(items, threads);
  } else {
    Builder builder{items, kHalvedFrom, 0};
    builder.build();
    nodes_ = std::move(builder.nodes);
  }
  item_at_.reserve(items.size());
  for (const Item& item : items) item_at_.push_back(item.number);
}

}  // namespace arris
