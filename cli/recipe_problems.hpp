#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/types/error.hpp"

namespace arris {

/// All that a run would refuse of a recipe before it looks at a scan.
struct RecipeProblems {
  std::vector<ErrorText> problems;
  std::string remark;  ///< of a good one: what it is not good for; else empty
};

/// Problems of a recipe and of the cell that it names. If its keys are good and its files are there, the
/// drawing and the tool path are read as a run reads them, so that its words come without a scan.
///   cost  that of reading the drawing: 0.1 s for 100,000 triangles
[[nodiscard]] RecipeProblems problems_of_recipe(const std::filesystem::path& file, int threads);

}  // namespace arris
