#include "registration/deviation.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "acquisition/geometry/curve_order.hpp"
#include "acquisition/geometry/parallel_for.hpp"

namespace arris {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20U;  // put in order at a time: 16 MB while it is done
constexpr std::size_t kChunk = 8192, kAtATime = 2048, kAhead = 32;

/// Points of one block, `order` of them from a chunk of it.
void measure(const SurfaceQuery& cad, const RigidMotion& cad_from_scan,
             std::span<const Eigen::Vector3f> points_mm, double reach_mm,
             std::span<const std::uint32_t> order, std::span<float> deviation_mm) {
  std::vector<Eigen::Vector3d> at_mm(kAtATime);
  std::vector<double> signed_mm(kAtATime);
  for (std::size_t first = 0; first < order.size(); first += kAtATime) {
    const std::size_t count = std::min(kAtATime, order.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      if (first + k + kAhead < order.size()) __builtin_prefetch(&points_mm[order[first + k + kAhead]]);
      at_mm[k] = cad_from_scan * points_mm[order[first + k]].cast<double>();
    }
    cad.signed_distances(std::span(at_mm).first(count), reach_mm, std::span(signed_mm).first(count));
    for (std::size_t k = 0; k < count; ++k) deviation_mm[order[first + k]] = static_cast<float>(signed_mm[k]);
  }
}

}  // namespace

std::vector<float> signed_deviation_mm(const SurfaceQuery& cad, const RigidMotion& scan_from_cad,
                                       std::span<const Eigen::Vector3f> points_mm, double reach_mm,
                                       int threads) {
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  std::vector<float> deviation_mm(points_mm.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t begin = 0; begin < points_mm.size(); begin += kBlock) {
    const auto block_mm = points_mm.subspan(begin, std::min(kBlock, points_mm.size() - begin));
    const std::vector<std::uint32_t> order = curve_order(block_mm, threads);
    parallel_for(order.size(), kChunk, threads, [&](std::size_t first, std::size_t last) {
      measure(cad, cad_from_scan, block_mm, reach_mm, std::span(order).subspan(first, last - first),
              std::span(deviation_mm).subspan(begin, block_mm.size()));
    });
  }
  return deviation_mm;
}

}  // namespace arris
