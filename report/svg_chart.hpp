#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/colour_map.hpp"
#include "report/statistics.hpp"

namespace arris::report {

struct ChartSeries {
  std::string name;
  Rgb colour;
  double width_px = 2.0;
  bool dashed = false;
  std::vector<double> y;  ///< one a position; NaN: a gap
};

/// Stretches of the x axis that stand out behind the lines.
struct ChartBands {
  std::string name;
  Rgb colour;
  std::vector<std::pair<double, double>> spans;
};

/// Lines over a common x axis, as inline SVG 860 units wide: grid, numbers, legend, and the data as
/// attributes, which the page's script reads for its read-out. y always includes zero.
struct LineChart {
  std::string x_label, y_label;
  std::vector<double> x;
  std::vector<ChartSeries> series;
  std::vector<ChartBands> bands;
  std::vector<double> limits;  ///< level lines
  std::string limit_name;
  double height_px = 300.0;
};
[[nodiscard]] std::string line_chart(const LineChart& chart);

/// Stretches of ascending x where mask is true, each reaching halfway to its neighbours.
[[nodiscard]] std::vector<std::pair<double, double>> spans_where(std::span<const double> x,
                                                                 const std::vector<bool>& mask);

/// Bars in the colours of the scale with the limits of the zone drawn, as inline SVG.
[[nodiscard]] std::string histogram_chart(const Histogram& histogram, const ColourMap& map);

}  // namespace arris::report
