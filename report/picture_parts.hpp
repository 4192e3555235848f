#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/canvas.hpp"
#include "report/colour_map.hpp"
#include "report/view.hpp"

namespace arris::report {

inline constexpr int kPictureWidth = 1640;  ///< px; shown at half of that, so that text stays sharp
inline constexpr double kMargin = 26.0;
inline constexpr double kTitleHeight = 92.0;
inline constexpr double kLegendHeight = 54.0;
inline constexpr double kLabelSize = 25.0;
inline constexpr Rgb kInk{34, 34, 34};
inline constexpr Rgb kSoftInk{96, 96, 96};

/// Where things go in a picture: title above, the drawing, a column at its right, a legend of lines below.
struct Layout {
  int height_px = 0;
  Box panel, side;
  double legend_y = 0.0;
};
/// The panel gets the height that its content asks for, within limits.
[[nodiscard]] Layout lay_out(const Extent& extent, double side_width_px);

void draw_title(Canvas& canvas, const std::string& title, const std::string& subtitle);
void draw_panel_frame(Canvas& canvas, const Box& panel);

/// Bar of a round length, bottom left of the panel; returns the space it takes.
[[nodiscard]] Box draw_scale_bar(Canvas& canvas, const View& view, const Box& panel);
/// The frame's axes, bottom right of the panel; returns the space it takes.
[[nodiscard]] Box draw_axes(Canvas& canvas, const View& view, const Box& panel);

/// The whole scale with numbers and unit: over scale, steps, under scale, no data.
void draw_colour_bar(Canvas& canvas, const ColourMap& map, const Box& box);

/// A line or a dot of the legend.
struct LegendItem {
  std::string text;
  Stroke stroke;
  std::optional<Rgb> casing;  ///< drawn wider underneath
  bool dot = false;
};
void draw_legend(Canvas& canvas, const std::vector<LegendItem>& items, double x, double y, double width_px);
void draw_line(Canvas& canvas, std::span<const Eigen::Vector2d> points, bool closed, const LegendItem& item);

/// Flags with leaders; text i belongs to anchor i. `obstacles` are left free.
struct Flag {
  Eigen::Vector2d anchor = Eigen::Vector2d::Zero();
  std::string text;
  Rgb colour;
};
void draw_flags(Canvas& canvas, const std::vector<Flag>& flags, const Box& bounds,
                const std::vector<Box>& obstacles);

}  // namespace arris::report
