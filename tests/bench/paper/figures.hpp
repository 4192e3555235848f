#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/paper/experiments.hpp"

namespace arris::bench {

/// A redrawn figure: its file name and its PNG bytes.
struct Figure {
  std::string file, png;
};

/// The paper's figures with our parts, of the first seed: 2 to 6 of the porthole, 7 to 11 of the nose cone.
[[nodiscard]] std::vector<Figure> porthole_figures(const BenchPart& porthole);
[[nodiscard]] std::vector<Figure> nosecone_figures(const BenchPart& nosecone);
/// 13 and 14: the finished contour and its error along the abscissa.
[[nodiscard]] std::vector<Figure> release_figures(const BenchPart& part);

/// Writes them into a folder that is there or made.
void write_figures(const std::vector<Figure>& figures, const std::filesystem::path& folder);

}  // namespace arris::bench
