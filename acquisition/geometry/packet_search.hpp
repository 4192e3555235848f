#pragma once

#include <cstdint>

#include "acquisition/geometry/box_tree.hpp"

/// Sixteen queries that lie near each other are searched for together in a BoxTree of triangles. All of it is
/// float and only prunes: what may be the nearest triangle of a query is listed, and who asked decides in
/// double. So neither the width of the CPU's registers nor the order of the queries can change an answer.
namespace arris::packet {

constexpr int kLanes = 16;
constexpr int kMostTriangles = 192;  // that a packet looks at

/// A triangle about the tree's centre, for the float test: its longest side is the x axis of a frame of its
/// own, in whose plane it lies.
struct alignas(32) Triangle {
  float origin_mm[3], along[3], across[3], normal[3];
  float length_mm;                                           ///< of the longest side, from the origin
  float second_along[2], second_start[2], second_length_mm;  ///< the side from its end: direction; where it
                                                             ///< starts, along and across that direction
  float third_along[2], third_length_mm;                     ///< the side that ends in the origin
  float slack2_mm2;  ///< what rounding may add to a squared distance; infinite: it must be asked in double
};

/// The triangle for the test; how well its shape can be told in float goes into its slack.
[[nodiscard]] Triangle triangle_of(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm,
                                   const Eigen::Vector3d& c_mm, double slack_mm);

struct Queries {
  alignas(32) float p_mm[3][kLanes];     ///< about the tree's centre
  alignas(32) float limit2_mm2[kLanes];  ///< none farther counts; shrinks during the search
};

/// What may be nearest to each query: every triangle whose distance lies within the limit left at the end.
struct Candidates {
  int count = 0;
  std::int32_t place[kMostTriangles];                    ///< in the tree
  std::uint32_t lanes[kMostTriangles];                   ///< bit k: may be nearest to query k
  alignas(32) float least2_mm2[kMostTriangles][kLanes];  ///< below its true squared distance
};

/// False when there are too many: the queries must be asked alone. `guess2_mm2`: how far the nearest
/// triangles may be, squared; a good guess makes the search quick, a bad one changes nothing. Told is what
/// would have been one.
[[nodiscard]] bool search(const BoxTree& tree, const Triangle* triangles, std::int32_t near_place,
                          float& guess2_mm2, Queries& queries, Candidates& candidates);

}  // namespace arris::packet
