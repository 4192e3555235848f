#pragma once

#include <cstdint>

#include "acquisition/geometry/box_tree.hpp"

/// Eight queries walk down a BoxTree of triangles together. All of it is float and only prunes: what may be
/// the nearest triangle of a query is listed, and who asked decides in double. So neither the width of the
/// CPU's registers nor the order of the walk can change an answer.
namespace arris::packet {

constexpr int kLanes = 8;
constexpr int kMostCandidates = 24;

/// A triangle about the tree's centre, for the float test.
struct alignas(64) Triangle {
  float a_mm[3], ab_mm[3], ac_mm[3];
  float over_ab2, over_ac2, over_bc2, over_area2;  ///< 1 / squared length, squared length of the normal
  float slack2_mm2;  ///< what rounding may add to a squared distance; infinite: only its box tells
};

/// The triangle for the test; how well its shape can be told in float goes into its slack.
[[nodiscard]] Triangle triangle_of(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm,
                                   const Eigen::Vector3d& c_mm, double slack_mm);

struct Queries {
  alignas(32) float p_mm[3][kLanes];     ///< about the tree's centre
  alignas(32) float limit2_mm2[kLanes];  ///< none farther is listed; shrinks during the search
};

/// What may be nearest to each query: all items whose distance lies within the limit left at the end.
struct Candidates {
  std::int32_t item[kLanes][kMostCandidates];
  float least2_mm2[kLanes][kMostCandidates];  ///< below its true squared distance
  int count[kLanes];                          ///< -1: too many, the query must be asked alone
};

/// `near_item`: looked at first (-1: none); it makes the search quicker. On AVX2 where the CPU has it.
void search(const BoxTree& tree, const Triangle* triangles, std::int32_t near_item, Queries& queries,
            Candidates& candidates);

}  // namespace arris::packet
