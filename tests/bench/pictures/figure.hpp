#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arris::bench {

/// A drawn figure: its file name and its PNG bytes.
struct Figure {
  std::string file, png;
};

/// The picture at half its width and height: a page of many.
[[nodiscard]] std::string shrunk(const std::string& png);

/// Writes them into a folder that is there or made. Throws Error(kInput) when it cannot.
void write_figures(const std::vector<Figure>& figures, const std::filesystem::path& folder);

}  // namespace arris::bench
