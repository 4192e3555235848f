#pragma once

#include <vector>

#include "tests/bench/paper/experiments.hpp"
#include "tests/bench/pictures/figure.hpp"

namespace arris::bench {

/// The paper's figures with our parts, of the first seed: 2 to 6 of the porthole, 7 to 11 of the nose cone.
[[nodiscard]] std::vector<Figure> porthole_figures(const BenchPart& porthole);
[[nodiscard]] std::vector<Figure> nosecone_figures(const BenchPart& nosecone);
/// 13 and 14: the finished contour and its error along the abscissa.
[[nodiscard]] std::vector<Figure> release_figures(const BenchPart& part);

}  // namespace arris::bench
