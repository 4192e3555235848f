#include "report/svg_chart.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "report/html_text.hpp"
#include "report/number_text.hpp"

namespace arris::report {
namespace {

constexpr double kWidth = 860.0, kLeft = 66.0, kRight = 846.0, kTop = 44.0, kBelow = 50.0;
constexpr std::size_t kMostPoints = 1200;

std::string px(double value) {
  return fixed_text(value, 1);
}
std::string attribute(const std::string& name, const std::string& value) {
  return " " + name + "=\"" + value + "\"";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& rest) {
  return "<line" + attribute("x1", px(x1)) + attribute("y1", px(y1)) + attribute("x2", px(x2)) +
         attribute("y2", px(y2)) + " " + rest + "/>";
}

std::string text(double x, double y, const std::string& anchor, const std::string& words,
                 const std::string& css = "") {
  return "<text" + attribute("x", px(x)) + attribute("y", px(y)) + attribute("text-anchor", anchor) +
         (css.empty() ? "" : attribute("class", css)) + ">" + escaped(words) + "</text>";
}

std::string rectangle(double x, double y, double width, double height, const std::string& rest) {
  return "<rect" + attribute("x", px(x)) + attribute("y", px(y)) + attribute("width", px(width)) +
         attribute("height", px(height)) + " " + rest + "/>";
}

// Round steps: 1, 2 or 5 times a power of ten, so that about `wanted` fit.
double tick_step(double range, double wanted) {
  const double raw = std::max(range, 1e-9) / wanted, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power * (1.0 + 1e-9)) return factor * power;
  return 10.0 * power;
}

struct Axis {
  double low = 0.0, high = 1.0, step = 1.0, from_px = 0.0, to_px = 1.0;
  [[nodiscard]] double at(double value) const {
    return from_px + (value - low) / (high - low) * (to_px - from_px);
  }
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> values;
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0)
      values.push_back(k * step);
    return values;
  }
};

Axis x_axis(double low, double high) {
  const double wide = high > low ? high : low + 1.0;
  return {low, wide, tick_step(wide - low, 9.0), kLeft, kRight};
}

Axis y_axis(double low, double high, double bottom_px) {
  const double step = tick_step(std::max(high - low, 1e-6), 5.0);
  return {std::floor(low / step + 1e-9) * step, std::max(std::ceil(high / step - 1e-9), 1.0) * step, step,
          bottom_px, kTop};
}

std::string grid(const Axis& x, const Axis& y, const std::string& x_label, const std::string& y_label,
                 double height) {
  std::string svg;
  for (const double value : y.ticks()) {
    const bool is_zero = std::abs(value) < 1e-9 * y.step;
    svg +=
        line(kLeft, y.at(value), kRight, y.at(value), is_zero ? "stroke=\"#6b747e\"" : "stroke=\"#e1e5e9\"");
    svg += text(kLeft - 8.0, y.at(value) + 4.5, "end",
                y.low < 0.0 ? signed_text(value, digits_for_step(y.step))
                            : fixed_text(value, digits_for_step(y.step)));
  }
  for (const double value : x.ticks()) {
    svg += line(x.at(value), kTop, x.at(value), y.from_px, "stroke=\"#e1e5e9\"");
    svg += text(x.at(value), y.from_px + 19.0, "middle", minus_text(value, digits_for_step(x.step)));
  }
  svg += rectangle(kLeft, kTop, kRight - kLeft, y.from_px - kTop, "fill=\"none\" stroke=\"#6b747e\"");
  svg += text(0.5 * (kLeft + kRight), height - 8.0, "middle", x_label, "soft");
  const std::string middle = px(0.5 * (kTop + y.from_px));
  svg += "<text" + attribute("transform", "translate(15 " + middle + ") rotate(-90)") +
         attribute("text-anchor", "middle") + attribute("class", "soft") + ">" + escaped(y_label) + "</text>";
  return svg;
}

// Positions that are drawn of a long series: in each stretch those of its least and greatest value, and its
// gaps.
std::vector<std::size_t> thinned(const std::vector<double>& y) {
  std::vector<std::size_t> kept;
  const std::size_t stretch = std::max<std::size_t>(1, y.size() / (kMostPoints / 2));
  for (std::size_t begin = 0; begin < y.size(); begin += stretch) {
    const std::size_t end = std::min(begin + stretch, y.size());
    std::size_t low = begin, high = begin, gap = end;
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isfinite(y[i])) gap = i;
      if (!(y[i] >= y[low])) low = i;
      if (!(y[i] <= y[high])) high = i;
    }
    std::vector<std::size_t> few = {begin, low, high, end - 1};
    if (gap < end) few.push_back(gap);
    std::sort(few.begin(), few.end());
    few.erase(std::unique(few.begin(), few.end()), few.end());
    kept.insert(kept.end(), few.begin(), few.end());
  }
  return kept;
}

// One polyline for each run without gaps; a point alone becomes a dot.
std::string series_lines(const ChartSeries& series, const std::vector<double>& x, const Axis& x_axis,
                         const Axis& y_axis) {
  std::string svg, points;
  std::size_t count = 0;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  const auto flush = [&] {
    if (count == 1)
      svg += "<circle" + attribute("cx", px(last.x())) + attribute("cy", px(last.y())) +
             attribute("r", "1.8") + attribute("fill", to_hex(series.colour)) + "/>";
    if (count > 1)
      svg += "<polyline fill=\"none\" stroke-linejoin=\"round\"" +
             attribute("stroke", to_hex(series.colour)) + attribute("stroke-width", px(series.width_px)) +
             (series.dashed ? attribute("stroke-dasharray", "7 5") : "") + attribute("points", points) + "/>";
    points.clear();
    count = 0;
  };
  for (const std::size_t i : thinned(series.y)) {
    if (!std::isfinite(series.y[i])) {
      flush();
      continue;
    }
    last = {x_axis.at(x[i]), y_axis.at(series.y[i])};
    points.append(px(last.x())).append(",").append(px(last.y())).append(" ");
    ++count;
  }
  flush();
  return svg;
}

std::string legend(const LineChart& chart, bool has_limits) {
  std::string svg;
  double x = kLeft;
  const auto advance = [&](const std::string& name) {
    svg += text(x + 32.0, 26.0, "start", name);
    x += 32.0 + 7.4 * static_cast<double>(name.size()) + 22.0;
  };
  for (const ChartSeries& series : chart.series) {
    svg +=
        line(x, 21.5, x + 26.0, 21.5,
             "stroke=\"" + to_hex(series.colour) + "\" stroke-width=\"" + px(std::max(2.5, series.width_px)) +
                 "\"" + (series.dashed ? attribute("stroke-dasharray", "7 5") : ""));
    advance(series.name);
  }
  for (const ChartBands& bands : chart.bands) {
    if (bands.spans.empty()) continue;
    svg += rectangle(x, 14.0, 26.0, 14.0, "fill=\"" + to_hex(bands.colour) + "\" stroke=\"#8a929b\"");
    advance(bands.name);
  }
  if (has_limits) {
    svg += line(x, 21.5, x + 26.0, 21.5, "stroke=\"#b3261e\" stroke-width=\"2\" stroke-dasharray=\"3 3\"");
    advance(chart.limit_name);
  }
  return svg;
}

std::string listed(const std::vector<double>& values, const std::vector<std::size_t>& indices, int digits) {
  std::string text;
  for (const std::size_t i : indices) {
    if (!text.empty()) text += ' ';
    text += std::isfinite(values[i]) ? fixed_text(values[i], digits) : "-";
  }
  return text;
}

// What the script reads: positions, values, and where the axes lie.
std::string data_attributes(const LineChart& chart, const Axis& x) {
  std::vector<std::size_t> indices;
  const std::size_t step = std::max<std::size_t>(1, chart.x.size() / kMostPoints);
  for (std::size_t i = 0; i < chart.x.size(); i += step) indices.push_back(i);
  std::string values, names;
  for (const ChartSeries& series : chart.series) {
    if (!names.empty()) values += '|', names += ',';
    values += listed(series.y, indices, 4);
    names.append("\"").append(series.name).append("\"");
  }
  std::string all = attribute("data-x", listed(chart.x, indices, 2)) + attribute("data-y", values);
  all += attribute("data-names", escaped("[" + names + "]"));
  all += attribute("data-frame", px(kLeft) + " " + px(kRight));
  return all + attribute("data-range", fixed_text(x.low, 4) + " " + fixed_text(x.high, 4));
}

std::string svg_open(double height, const std::string& rest, const std::string& label) {
  return "<svg class=\"chart\" viewBox=\"0 0 " + px(kWidth) + " " + px(height) + "\" role=\"img\"" +
         attribute("aria-label", escaped(label)) + rest + ">";
}

Axis y_axis_of(const LineChart& chart, double bottom_px) {
  double low = 0.0, high = 0.0;
  for (const ChartSeries& series : chart.series)
    for (const double y : series.y) {
      if (!std::isfinite(y)) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  for (const double limit : chart.limits) {
    if (limit > 1.6 * std::max(high, 1e-9) || limit < 1.6 * std::min(low, -1e-9))
      continue;  // far off: not drawn
    low = std::min(low, limit);
    high = std::max(high, limit);
  }
  return y_axis(low, high, bottom_px);
}

}  // namespace

std::string line_chart(const LineChart& chart) {
  if (chart.x.empty()) return {};
  const double bottom = chart.height_px - kBelow;
  const Axis x = x_axis(chart.x.front(), chart.x.back()), y = y_axis_of(chart, bottom);
  std::string svg =
      svg_open(chart.height_px, data_attributes(chart, x), chart.y_label + " over " + chart.x_label);
  for (const ChartBands& bands : chart.bands)
    for (const auto& [from, to] : bands.spans)
      svg += rectangle(x.at(from), kTop, std::max(1.5, x.at(to) - x.at(from)), bottom - kTop,
                       "fill=\"" + to_hex(bands.colour) + "\"");
  svg += grid(x, y, chart.x_label, chart.y_label, chart.height_px);
  bool has_limits = false;
  for (const double limit : chart.limits)
    if (limit >= y.low && limit <= y.high) {
      has_limits = true;
      svg += line(kLeft, y.at(limit), kRight, y.at(limit),
                  "stroke=\"#b3261e\" stroke-width=\"2\" stroke-dasharray=\"3 3\"");
    }
  for (const ChartSeries& series : chart.series) svg += series_lines(series, chart.x, x, y);
  svg += legend(chart, has_limits);
  svg += "<line class=\"cursor\" visibility=\"hidden\" x1=\"0\" x2=\"0\"" + attribute("y1", px(kTop)) +
         attribute("y2", px(bottom)) + " stroke=\"#1d2126\"/>";
  svg += "<text class=\"readout\"" + attribute("x", px(kLeft + 8.0)) + attribute("y", px(kTop + 18.0)) +
         "></text>";
  return svg + "</svg>";
}

std::vector<std::pair<double, double>> spans_where(std::span<const double> x, const std::vector<bool>& mask) {
  std::vector<std::pair<double, double>> spans;
  const std::size_t count = std::min(x.size(), mask.size());
  for (std::size_t begin = 0; begin < count; ++begin) {
    if (!mask[begin]) continue;
    std::size_t last = begin;
    while (last + 1 < count && mask[last + 1]) ++last;
    spans.emplace_back(begin == 0 ? x[0] : 0.5 * (x[begin - 1] + x[begin]),
                       last + 1 == count ? x[last] : 0.5 * (x[last] + x[last + 1]));
    begin = last;
  }
  return spans;
}

std::string histogram_chart(const Histogram& histogram, const ColourMap& map) {
  constexpr double kHeight = 260.0, kBottom = kHeight - kBelow;
  const std::size_t most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  const double whole = static_cast<double>(std::max<std::size_t>(1, histogram.total()));
  const double low = histogram.edges_mm.front(), high = histogram.edges_mm.back();
  const Axis x{low, high, tick_step(high - low, 9.0), kLeft, kRight};
  const Axis y = y_axis(0.0, 100.0 * static_cast<double>(most) / whole, kBottom);
  std::string svg = svg_open(kHeight, "", "histogram of the deviations") +
                    grid(x, y, "deviation, mm", "% of points", kHeight);
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const double from = x.at(histogram.edges_mm[i]), to = x.at(histogram.edges_mm[i + 1]);
    const double top = y.at(100.0 * static_cast<double>(histogram.counts[i]) / whole);
    if (histogram.counts[i] == 0) continue;
    const Rgb colour = map.colour(0.5 * (histogram.edges_mm[i] + histogram.edges_mm[i + 1]));
    svg += rectangle(from, top, to - from, kBottom - top,
                     "fill=\"" + to_hex(colour) + "\" stroke=\"#ffffff\" stroke-width=\"0.6\"");
  }
  if (map.half_zone_mm() > 0.0)
    for (const double limit : {-map.half_zone_mm(), map.half_zone_mm()}) {
      svg += line(x.at(limit), kTop - 8.0, x.at(limit), kBottom,
                  "stroke=\"#1d2126\" stroke-width=\"2\" stroke-dasharray=\"6 4\"");
      svg += text(x.at(limit) + (limit < 0.0 ? -6.0 : 6.0), kTop - 12.0, limit < 0.0 ? "end" : "start",
                  signed_text(limit, 3) + " mm");
    }
  return svg + "</svg>";
}

}  // namespace arris::report
