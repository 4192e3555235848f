#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace arris {

/// The numbers of the points in the order of a Hilbert curve through their box, cut into 1024 cells an axis:
/// points that follow each other lie near each other, whatever order they came in. Points of one cell keep
/// their order; what is not finite comes first. At most 2^32 - 1 points; the same order for any number of
/// threads. Cost O(N), radix sort; 16 bytes a point while it runs. Source: J. Skilling, Programming the
/// Hilbert curve, AIP Conf. Proc. 707 (2004).
[[nodiscard]] std::vector<std::uint32_t> curve_order(std::span<const Eigen::Vector3f> points_mm, int threads);

}  // namespace arris
