#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/files/file_info.hpp"

namespace arris {
namespace {

constexpr std::size_t kSeeds = 255;
constexpr std::size_t kPointsPerSlice = 64;
constexpr std::size_t kMostCandidates =
    1 << 18;  // per seed; only reached where thousands of points share a slice

/// Points sorted into slices of equal width along one axis.
class Slices {
 public:
  explicit Slices(std::span<const Eigen::Vector3f> points) : points_(points) {
    choose_axis();
    const std::size_t count = std::clamp<std::size_t>(points.size() / kPointsPerSlice, 1, 65536);
    scale_ = high_ > low_ ? static_cast<float>(count) / (high_ - low_) : 0.0F;
    first_.assign(count + 1, 0);
    for (const Eigen::Vector3f& p : points) ++first_[slice_of(p) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    order_.resize(points.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i)
      order_[next[slice_of(points[i])]++] = static_cast<std::uint32_t>(i);
  }

  /// Distance from point `seed` to the nearest point with another index.
  [[nodiscard]] double nearest(std::size_t seed) const {
    const Eigen::Vector3f p = points_[seed];
    const auto home = static_cast<std::ptrdiff_t>(slice_of(p));
    const auto slices = static_cast<std::ptrdiff_t>(first_.size()) - 1;
    float best = std::numeric_limits<float>::infinity();
    std::size_t candidates = 0;
    for (std::ptrdiff_t ring = 0; ring < slices && candidates < kMostCandidates; ++ring) {
      // Slices of this ring lie at least ring - 1 whole slices away.
      if (scale_ > 0.0F && static_cast<float>(ring - 1) > std::sqrt(best) * scale_) break;
      for (const std::ptrdiff_t slice : {home - ring, home + ring}) {
        if (slice < 0 || slice >= slices || (ring == 0 && slice != home)) continue;
        candidates += look_through(static_cast<std::size_t>(slice), seed, best);
        if (ring == 0) break;
      }
    }
    return std::sqrt(static_cast<double>(best));
  }

 private:
  /// The axis of the largest spread, between the hundredth and the hundredth but last of a sample: strays
  /// must not stretch the slices.
  void choose_axis() {
    float widest = -1.0F;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<float> values;
      for (std::size_t i = 0; i < points_.size(); i += points_.size() / 4096 + 1)
        values.push_back(points_[i][axis]);
      std::sort(values.begin(), values.end());
      const float low = values[values.size() / 100];
      const float high = values[values.size() - 1 - values.size() / 100];
      if (high - low <= widest) continue;
      widest = high - low;
      axis_ = axis;
      low_ = low;
      high_ = high;
    }
  }

  [[nodiscard]] std::size_t slice_of(const Eigen::Vector3f& p) const {
    const float place = (p[axis_] - low_) * scale_;
    const auto last = static_cast<float>(first_.size() - 2);
    return static_cast<std::size_t>(std::clamp(place, 0.0F, last));
  }

  std::size_t look_through(std::size_t slice, std::size_t seed, float& best) const {
    const std::size_t end = std::min(first_[slice + 1], first_[slice] + kMostCandidates);
    for (std::size_t i = first_[slice]; i < end; ++i)
      if (order_[i] != seed) best = std::min(best, (points_[order_[i]] - points_[seed]).squaredNorm());
    return end - first_[slice];
  }

  std::span<const Eigen::Vector3f> points_;
  int axis_ = 0;
  float low_ = 0.0F;
  float high_ = 0.0F;
  float scale_ = 0.0F;
  std::vector<std::size_t> first_;  ///< of each slice, in order_
  std::vector<std::uint32_t> order_;
};

}  // namespace

double estimate_spacing(std::span<const Eigen::Vector3f> points) {
  if (points.size() < 2) return 0.0;
  const Slices slices(points);
  std::vector<double> distances;
  for (std::size_t seed = 0; seed < points.size(); seed += points.size() / kSeeds + 1)
    distances.push_back(slices.nearest(seed));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace arris
