#pragma once

#include <filesystem>
#include <string>

#include "acquisition/types/triangle_mesh.hpp"

namespace arris::bench {

/// What the rows are measured on.
struct ScaleData {
  TriangleMesh cad;
  std::filesystem::path folder;  ///< for the files of the runs; large
  std::filesystem::path arris;   ///< the program
  int rounds = 3;                ///< all of them interleaved; medians are told
  int threads = 2;
};

// Each a Markdown table with its heading.
[[nodiscard]] std::string rigid_rows(const ScaleData& data);
[[nodiscard]] std::string deviation_rows(const ScaleData& data);
[[nodiscard]] std::string map_rows(const ScaleData& data);

}  // namespace arris::bench
