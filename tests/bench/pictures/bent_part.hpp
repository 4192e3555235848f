#pragma once

#include <string>

#include "tests/bench/pictures/part_picture.hpp"
#include "tests/support/bench_part.hpp"

namespace arris::bench {

/// Puts the followed contours of a part on a picture, each a line of its own and the first one named: as they
/// really are (deformed), or as drawn.
void add_edge(PartPicture& picture, const Truth& truth, bool deformed, const std::string& name,
              bool is_dashed = false);
[[nodiscard]] Eigen::Vector3d mean_edge_normal(const Truth& truth);

/// The clamped part, coloured by its displacement along the normal beyond the best rigid motion of the edge,
/// with its edge and that of the drawing at the true pose.
[[nodiscard]] PartPicture bent_part_picture(const BenchPart& part, const std::string& title, double mesh_mm);

}  // namespace arris::bench
