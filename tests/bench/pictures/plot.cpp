#include "tests/bench/pictures/plot.hpp"

#include <algorithm>
#include <cmath>

#include "report/number_text.hpp"
#include "report/picture_parts.hpp"
#include "report/scene.hpp"

namespace arris::bench {
namespace {

using report::Anchor;
using report::Box;
using report::Canvas;
using report::Rgb;

constexpr int kHeight = 810;
constexpr double kWantedTicks = 8.0;
constexpr Rgb kGrid{225, 229, 233}, kGap{238, 238, 238};
const Box kPanel{110.0, 100.0, report::kPictureWidth - 140.0, 540.0};

double tick_step(double range) {
  const double raw = range / kWantedTicks, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power * (1.0 + 1e-9)) return factor * power;
  return 10.0 * power;
}

/// Values on pixels of the panel.
struct Axes {
  double x_low, x_high, y_low, y_high, x_step, y_step;
  [[nodiscard]] double x(double value) const {
    return kPanel.x + (value - x_low) / (x_high - x_low) * kPanel.width;
  }
  [[nodiscard]] double y(double value) const {
    return kPanel.y + (y_high - value) / (y_high - y_low) * kPanel.height;
  }
};

Axes axes_of(const Plot& plot) {
  Axes axes{1e300, -1e300, 0.0, 0.0, 1.0, 1.0};
  for (const PlotLine& line : plot.lines)
    for (const Eigen::Vector2d& p : line.points_mm) {
      axes.x_low = std::min(axes.x_low, p.x());
      axes.x_high = std::max(axes.x_high, p.x());
      axes.y_low = std::min(axes.y_low, p.y());
      axes.y_high = std::max(axes.y_high, p.y());
    }
  axes.x_step = tick_step(axes.x_high - axes.x_low);
  axes.y_step = tick_step(std::max(1e-6, axes.y_high - axes.y_low));
  axes.y_low = std::floor(axes.y_low / axes.y_step + 1e-9) * axes.y_step;
  axes.y_high = std::ceil(axes.y_high / axes.y_step - 1e-9) * axes.y_step;
  return axes;
}

void draw_grid(Canvas& canvas, const Axes& axes, const Plot& plot) {
  const report::TextStyle number{report::kLabelSize, false, report::kSoftInk, Anchor::kRight};
  for (double k = std::round(axes.y_low / axes.y_step); k * axes.y_step <= axes.y_high * (1 + 1e-9) + 1e-12;
       k += 1.0) {
    const double y = axes.y(k * axes.y_step);
    const std::vector<Eigen::Vector2d> line = {{kPanel.x, y}, {kPanel.x + kPanel.width, y}};
    canvas.polyline(line, false, {k == 0.0 ? report::kSoftInk : kGrid, 1.5, {}, 1.0});
    canvas.text(kPanel.x - 12.0, y + 9.0,
                report::minus_text(k * axes.y_step, report::digits_for_step(axes.y_step)), number);
  }
  report::TextStyle below = number;
  below.anchor = Anchor::kCentre;
  for (double k = std::ceil(axes.x_low / axes.x_step); k * axes.x_step <= axes.x_high; k += 1.0) {
    const double x = axes.x(k * axes.x_step);
    const std::vector<Eigen::Vector2d> line = {{x, kPanel.y}, {x, kPanel.y + kPanel.height}};
    canvas.polyline(line, false, {kGrid, 1.5, {}, 1.0});
    canvas.text(x, kPanel.y + kPanel.height + 32.0,
                report::minus_text(k * axes.x_step, report::digits_for_step(axes.x_step)), below);
  }
  canvas.text(kPanel.x + 0.5 * kPanel.width, kPanel.y + kPanel.height + 68.0,
              plot.x_label + "   (upwards: " + plot.y_label + ")", below);
}

}  // namespace

Rgb line_colour(std::size_t i) {
  constexpr Rgb kColours[] = {{214, 98, 28}, {150, 150, 150}, {170, 120, 0}, {140, 60, 150},
                              {0, 90, 170},  {0, 140, 130},   {190, 20, 60}};
  return kColours[i % std::size(kColours)];
}

void draw_legend_rows(report::Canvas& canvas, const std::vector<report::LegendItem>& items, double y) {
  for (std::size_t i = 0; i < items.size(); i += kLegendItemsARow, y += kLegendRowPx) {
    const auto from = items.begin() + static_cast<std::ptrdiff_t>(i);
    const auto count = static_cast<std::ptrdiff_t>(std::min(kLegendItemsARow, items.size() - i));
    report::draw_legend(canvas, {from, from + count}, report::kMargin, y,
                        report::kPictureWidth - 2.0 * report::kMargin);
  }
}

std::string plot_png(const Plot& plot) {
  Canvas canvas(report::kPictureWidth, kHeight, report::kPaper);
  report::draw_title(canvas, plot.title, plot.subtitle);
  const Axes axes = axes_of(plot);
  for (const auto& [from_mm, to_mm] : plot.gaps_mm)
    canvas.rectangle({axes.x(from_mm), kPanel.y, axes.x(to_mm) - axes.x(from_mm), kPanel.height}, kGap);
  draw_grid(canvas, axes, plot);
  std::vector<report::LegendItem> legend;
  for (const PlotLine& line : plot.lines) {
    report::LegendItem item{line.name, {line.colour, 3.0, {}, 1.0}, std::nullopt, false};
    if (line.is_dashed) item.stroke.dash_px = {10.0, 6.0};
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector2d& p : line.points_mm) pixels.emplace_back(axes.x(p.x()), axes.y(p.y()));
    report::draw_line(canvas, pixels, false, item);
    if (!item.text.empty()) legend.push_back(item);
  }
  report::draw_panel_frame(canvas, kPanel);
  draw_legend_rows(canvas, legend, kPanel.y + kPanel.height + 112.0);
  return canvas.png();
}

}  // namespace arris::bench
