#include "acquisition/geometry/nearest.hpp"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <algorithm>
#include <limits>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using Tree = flann::KDTreeSingleIndex<flann::L2_Simple<double>>;

// FLANN visits what lies strictly below worstDist() and prunes by distances summed with rounding; a little
// slack keeps every tie, and the result sets below then decide exactly.
double with_slack(double distance2_mm2) {
  return distance2_mm2 * (1.0 + 1e-12) + std::numeric_limits<double>::denorm_min();
}

bool nearer(const Neighbour& a, const Neighbour& b) {
  return a.distance2_mm2 < b.distance2_mm2 || (a.distance2_mm2 == b.distance2_mm2 && a.index < b.index);
}

class KeepOne final : public flann::ResultSet<double> {
 public:
  [[nodiscard]] bool full() const override { return best.index >= 0; }
  [[nodiscard]] double worstDist() const override {
    return best.index < 0 ? std::numeric_limits<double>::infinity() : with_slack(best.distance2_mm2);
  }
  void addPoint(double distance2_mm2, std::size_t index) override {
    const Neighbour candidate{static_cast<std::int32_t>(index), distance2_mm2};
    if (best.index < 0 || nearer(candidate, best)) best = candidate;
  }
  Neighbour best;
};

class KeepK final : public flann::ResultSet<double> {
 public:
  KeepK(std::size_t k, std::vector<Neighbour>& found) : k_(k), found_(found) {}
  [[nodiscard]] bool full() const override { return found_.size() == k_; }
  [[nodiscard]] double worstDist() const override {
    return full() ? with_slack(found_.back().distance2_mm2) : std::numeric_limits<double>::infinity();
  }
  void addPoint(double distance2_mm2, std::size_t index) override {
    const Neighbour candidate{static_cast<std::int32_t>(index), distance2_mm2};
    if (full()) {
      if (!nearer(candidate, found_.back())) return;
      found_.back() = candidate;
    } else {
      found_.push_back(candidate);
    }
    for (std::size_t i = found_.size() - 1; i > 0 && nearer(found_[i], found_[i - 1]); --i)
      std::swap(found_[i], found_[i - 1]);
  }

 private:
  std::size_t k_;
  std::vector<Neighbour>& found_;
};

class KeepWithin final : public flann::ResultSet<double> {
 public:
  KeepWithin(double radius2_mm2, std::vector<Neighbour>& found) : radius2_mm2_(radius2_mm2), found_(found) {}
  [[nodiscard]] bool full() const override { return true; }
  [[nodiscard]] double worstDist() const override { return with_slack(radius2_mm2_); }
  void addPoint(double distance2_mm2, std::size_t index) override {
    if (distance2_mm2 <= radius2_mm2_) found_.push_back({static_cast<std::int32_t>(index), distance2_mm2});
  }

 private:
  double radius2_mm2_;
  std::vector<Neighbour>& found_;
};

void check_points(std::span<const Eigen::Vector3d> points_mm) {
  if (points_mm.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw Error(Fault::kInput, ErrorText{.what = "too many points for one tree",
                                         .where = {},
                                         .found = std::to_string(points_mm.size()),
                                         .needed = "at most 2147483647",
                                         .next = {}});
  for (std::size_t i = 0; i < points_mm.size(); ++i)
    if (!points_mm[i].allFinite())
      throw Error(Fault::kBug, "nearest: point " + std::to_string(i) + " is not finite");
}

}  // namespace

struct NearestPoints::Impl {
  explicit Impl(std::span<const Eigen::Vector3d> points_mm) : count(points_mm.size()) {
    check_points(points_mm);
    if (count == 0) return;
    // FLANN reads these points while it builds; `reorder` keeps its own copy, sorted by leaf, and searches
    // that.
    auto* coordinates = const_cast<double*>(points_mm.front().data());
    constexpr int kLeafPoints = 10;
    constexpr bool kReorder = true;
    tree = std::make_unique<Tree>(flann::Matrix<double>(coordinates, count, 3),
                                  flann::KDTreeSingleIndexParams(kLeafPoints, kReorder));
    tree->buildIndex();
  }

  void find(flann::ResultSet<double>& result, const Eigen::Vector3d& query_mm) const {
    if (tree && query_mm.allFinite()) tree->findNeighbors(result, query_mm.data(), exact);
  }

  std::size_t count;
  std::unique_ptr<Tree> tree;
  flann::SearchParams exact{flann::FLANN_CHECKS_UNLIMITED, 0.0F};
};

NearestPoints::NearestPoints(std::span<const Eigen::Vector3d> points_mm)
    : impl_(std::make_unique<Impl>(points_mm)) {}
NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;
NearestPoints& NearestPoints::operator=(NearestPoints&&) noexcept = default;

std::size_t NearestPoints::size() const {
  return impl_->count;
}

Neighbour NearestPoints::nearest(const Eigen::Vector3d& query_mm) const {
  KeepOne result;
  impl_->find(result, query_mm);
  return result.best;
}

void NearestPoints::nearest_k(const Eigen::Vector3d& query_mm, int k, std::vector<Neighbour>& found) const {
  found.clear();
  if (k <= 0) return;
  KeepK result(static_cast<std::size_t>(k), found);
  impl_->find(result, query_mm);
}

void NearestPoints::within(const Eigen::Vector3d& query_mm, double radius_mm,
                           std::vector<Neighbour>& found) const {
  found.clear();
  if (!(radius_mm >= 0.0)) return;
  KeepWithin result(radius_mm * radius_mm, found);
  impl_->find(result, query_mm);
  std::sort(found.begin(), found.end(), nearer);
}

}  // namespace arris
