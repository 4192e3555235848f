#include "report/picture_parts.hpp"

#include <algorithm>
#include <cmath>

#include "report/number_text.hpp"
#include "report/raster.hpp"

namespace arris::report {
namespace {

const TextStyle kLabel{kLabelSize, false, kInk, Anchor::kLeft};

}  // namespace

Layout lay_out(const Extent& extent, double side_width_px) {
  Layout layout;
  const double width = kPictureWidth - 3.0 * kMargin - side_width_px;
  const Eigen::Vector2d size = extent.size().cwiseMax(1e-6);
  const double height = std::clamp(std::round(width * size.y() / size.x() + 110.0), 560.0, 980.0);
  layout.panel = {kMargin, kTitleHeight, width, height};
  layout.side = {2.0 * kMargin + width, kTitleHeight, side_width_px, height};
  layout.legend_y = kTitleHeight + height + 36.0;
  layout.height_px = static_cast<int>(kTitleHeight + height + kLegendHeight);
  return layout;
}

void draw_title(Canvas& canvas, const std::string& title, const std::string& subtitle) {
  const TextStyle head{34.0, true, kInk, Anchor::kLeft}, sub{kLabelSize, false, kSoftInk, Anchor::kLeft};
  const double width = kPictureWidth - 2.0 * kMargin;
  canvas.text(kMargin, 40.0, canvas.fitted(title, head, width), head);
  canvas.text(kMargin, 75.0, canvas.fitted(subtitle, sub, width), sub);
}

void draw_panel_frame(Canvas& canvas, const Box& panel) {
  canvas.frame(panel, {{200, 200, 200}, 1.5, {}, 1.0});
}

Box draw_scale_bar(Canvas& canvas, const View& view, const Box& panel) {
  const double least_mm = 0.08 * panel.width / view.scale_px_mm;
  const double power = std::pow(10.0, std::floor(std::log10(least_mm)));
  const double length_mm =
      least_mm <= power ? power : (least_mm <= 2 * power ? 2 : (least_mm <= 5 * power ? 5 : 10)) * power;
  const double length_px = length_mm * view.scale_px_mm;
  const std::string text = fixed_text(length_mm, digits_for_step(length_mm)) + " mm";
  const double x = panel.x + 24.0, y = panel.y + panel.height - 24.0;
  const Box space{x - 12.0, y - 44.0, std::max(length_px, canvas.text_width(text, kLabel)) + 24.0, 58.0};
  canvas.rectangle(space, {255, 255, 255});
  const std::vector<Eigen::Vector2d> bar = {
      {x, y - 7.0}, {x, y}, {x + length_px, y}, {x + length_px, y - 7.0}};
  canvas.polyline(bar, false, {kInk, 3.0, {}, 1.0});
  canvas.text(x, y - 14.0, text, kLabel);
  return space;
}

Box draw_axes(Canvas& canvas, const View& view, const Box& panel) {
  constexpr double kLength = 58.0, kRoom = 92.0;
  const Eigen::Vector2d origin(panel.x + panel.width - kRoom, panel.y + panel.height - kRoom);
  const Box space{origin.x() - kRoom, origin.y() - kRoom, 2.0 * kRoom, 2.0 * kRoom};
  const char* const names[] = {"X", "Y", "Z"};
  const TextStyle style{23.0, true, kSoftInk, Anchor::kCentre, true};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector2d on_page(view.orientation(0, axis), -view.orientation(1, axis));
    const std::vector<Eigen::Vector2d> line = {origin, origin + kLength * on_page};
    if (on_page.norm() < 0.12) {
      canvas.disc(origin, 4.0, kSoftInk, {kSoftInk, 1.0, {}, 1.0});
      continue;
    }
    canvas.polyline(line, false, {{255, 255, 255}, 8.0, {}, 1.0});
    canvas.polyline(line, false, {kSoftInk, 3.0, {}, 1.0});
    const Eigen::Vector2d at =
        origin + (kLength + 19.0) * on_page.normalized() * std::max(0.55, on_page.norm());
    canvas.text(at.x(), at.y() + 8.0, names[axis], style);
  }
  return space;
}

void draw_colour_bar(Canvas& canvas, const ColourMap& map, const Box& box) {
  const TextStyle bold{kLabelSize, true, kInk, Anchor::kLeft}, soft{22.0, false, kSoftInk, Anchor::kLeft};
  canvas.text(box.x, box.y + 20.0, "deviation, mm", bold);
  canvas.text(box.x, box.y + 50.0, "+ outside material", soft);
  constexpr double kBar = 46.0, kBlock = 26.0, kGap = 20.0;
  const double text_x = box.x + kBar + 22.0;
  const double top = box.y + 74.0 + kBlock + kGap;
  const double bottom = box.y + box.height - 2.0 * (kBlock + kGap) - 4.0;
  const auto y_of = [&](double mm) {
    return 0.5 * (top + bottom) - mm / map.limit_mm() * 0.5 * (bottom - top);
  };
  const Stroke edge{kSoftInk, 1.0, {}, 1.0};
  for (const ColourStep& step : map.steps())
    canvas.rectangle({box.x, y_of(step.to_mm), kBar, y_of(step.from_mm) - y_of(step.to_mm)}, step.colour);
  canvas.frame({box.x, top, kBar, bottom - top}, edge);

  std::vector<double> values, places;
  for (auto step = map.steps().rbegin(); step != map.steps().rend(); ++step) values.push_back(step->to_mm);
  values.push_back(-map.limit_mm());
  int digits = 0;
  for (const double value : values) {
    places.push_back(y_of(value));
    digits = std::max(digits, digits_for_step(value));
  }
  const std::vector<double> spread_places = spread(places, 30.0, top, bottom);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::vector<Eigen::Vector2d> tick = {{box.x + kBar, places[i]}, {text_x - 4.0, spread_places[i]}};
    canvas.polyline(tick, false, {kSoftInk, 1.5, {}, 1.0});
    const bool is_limit =
        map.half_zone_mm() > 0.0 && std::abs(std::abs(values[i]) - map.half_zone_mm()) < 1e-12;
    canvas.text(text_x, spread_places[i] + 9.0, signed_text(values[i], digits), is_limit ? bold : kLabel);
  }
  const auto block = [&](double y, const Rgb& colour, const std::string& text) {
    canvas.rectangle({box.x, y, kBar, kBlock}, colour);
    canvas.frame({box.x, y, kBar, kBlock}, edge);
    canvas.text(text_x, y + 21.0, text, kLabel);
  };
  block(top - kBlock - kGap, ColourMap::over_scale(), "over scale");
  block(bottom + kGap, ColourMap::under_scale(), "under scale");
  canvas.hatched({box.x, bottom + 2.0 * kGap + kBlock, kBar, kBlock});
  canvas.frame({box.x, bottom + 2.0 * kGap + kBlock, kBar, kBlock}, edge);
  canvas.text(text_x, bottom + 2.0 * kGap + kBlock + 21.0, "no data", kLabel);
}

void draw_line(Canvas& canvas, std::span<const Eigen::Vector2d> points, bool closed, const LegendItem& item) {
  if (item.casing) canvas.polyline(points, closed, {*item.casing, item.stroke.width_px + 3.0, {}, 1.0});
  canvas.polyline(points, closed, item.stroke);
}

void draw_legend(Canvas& canvas, const std::vector<LegendItem>& items, double x, double y, double width_px) {
  const double end = x + width_px;
  for (const LegendItem& item : items) {
    const double text_width = canvas.text_width(item.text, kLabel);
    if (x + 66.0 + text_width > end) return;  // never over the edge: the caller orders by importance
    const std::vector<Eigen::Vector2d> sample = {{x, y - 8.0}, {x + 52.0, y - 8.0}};
    if (item.dot)
      canvas.disc({x + 26.0, y - 8.0}, 7.0, item.stroke.colour, {kInk, 1.5, {}, 1.0});
    else
      draw_line(canvas, sample, false, item);
    canvas.text(x + 62.0, y, item.text, kLabel);
    x += 62.0 + text_width + 40.0;
  }
}

void draw_flags(Canvas& canvas, const std::vector<Flag>& flags, const Box& bounds,
                const std::vector<Box>& obstacles) {
  const TextStyle style{kLabelSize, true, kInk, Anchor::kCentre};
  std::vector<Eigen::Vector2d> anchors, sizes;
  for (const Flag& flag : flags) {
    anchors.push_back(flag.anchor);
    sizes.emplace_back(canvas.text_width(flag.text, style) + 24.0, 38.0);
  }
  const std::vector<Box> boxes = place_labels(anchors, sizes, bounds, obstacles);
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (boxes[i].width == 0.0) continue;
    const Eigen::Vector2d middle(boxes[i].x + 0.5 * boxes[i].width, boxes[i].y + 0.5 * boxes[i].height);
    const std::vector<Eigen::Vector2d> leader = {anchors[i], middle};
    canvas.polyline(leader, false, {{255, 255, 255}, 5.0, {}, 0.8});
    canvas.polyline(leader, false, {kInk, 2.0, {}, 1.0});
  }
  for (std::size_t i = 0; i < flags.size(); ++i) {
    canvas.disc(anchors[i], 9.0, {255, 255, 255}, {{255, 255, 255}, 1.0, {}, 1.0});
    canvas.disc(anchors[i], 6.5, flags[i].colour, {kInk, 2.0, {}, 1.0});
    if (boxes[i].width == 0.0) continue;
    canvas.rounded_box(boxes[i], 8.0, {255, 255, 255}, {kInk, 2.0, {}, 1.0});
    canvas.rectangle({boxes[i].x + 3.0, boxes[i].y + 6.0, 7.0, boxes[i].height - 12.0}, flags[i].colour);
    canvas.text(boxes[i].x + 0.5 * boxes[i].width + 4.0, boxes[i].y + 28.0, flags[i].text, style);
  }
}

}  // namespace arris::report
