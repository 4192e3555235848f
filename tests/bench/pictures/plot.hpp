#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "report/picture_parts.hpp"

namespace arris::bench {

/// Colour of line i of a figure: the same method has the same colour in all of them.
[[nodiscard]] report::Rgb line_colour(std::size_t i);

/// A legend that goes on below when a row is full.
inline constexpr std::size_t kLegendItemsARow = 4;
inline constexpr int kLegendRowPx = 36;
void draw_legend_rows(report::Canvas& canvas, const std::vector<report::LegendItem>& items, double y);

struct PlotLine {
  std::string name;  ///< empty: not in the legend
  report::Rgb colour;
  std::vector<Eigen::Vector2d> points_mm;  ///< x ascending
  bool is_dashed = false;
};

/// Lines over one abscissa, as a PNG beside the pictures of the report. y holds zero.
struct Plot {
  std::string title, subtitle, x_label, y_label;
  std::vector<PlotLine> lines;
  std::vector<std::pair<double, double>> gaps_mm;  ///< stretches of x drawn in grey: no scan points there
};
[[nodiscard]] std::string plot_png(const Plot& plot);

}  // namespace arris::bench
