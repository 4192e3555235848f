#pragma once

#include <string>
#include <vector>

#include "tests/bench/paper/methods.hpp"
#include "tests/bench/pictures/part_picture.hpp"
#include "tests/bench/pictures/plot.hpp"

namespace arris::bench {

/// A path with the name and colour that it has in every figure.
struct NamedPath {
  std::string name;
  report::Rgb colour;
  CarriedPath path;
};

/// The methods of the figures on one scan; those without a path are left out.
[[nodiscard]] std::vector<NamedPath> figure_paths(ScanTrial& trial);

/// Which part of a row's error is plotted.
enum class Along { kDistance, kNormal, kAcross };
/// Against the true edge (deformed) or the drawing's; x ascending.
[[nodiscard]] PlotLine error_line(const Truth& truth, const NamedPath& path, Along part, bool deformed);

/// The path drawn `factor` times as far from its feet on the edge as it is.
[[nodiscard]] PartLine exaggerated_line(const Truth& truth, const NamedPath& path, double factor,
                                        bool deformed);

}  // namespace arris::bench
