#include "tests/bench/pictures/part_picture.hpp"

#include "report/scene.hpp"
#include "tests/bench/pictures/plot.hpp"

namespace arris::bench {
namespace {

using namespace report;  // NOLINT: the picture kit's words, nothing else here

constexpr double kAroundRatio = 0.12, kScaleWidth = 190.0, kDotPx = 8.0, kScanDotPx = 1.6;
constexpr Rgb kPart{226, 228, 231}, kScanDot{0, 90, 170}, kMark{190, 20, 60}, kAxis{0, 120, 90};

std::vector<Eigen::Vector3d> framed(const PartPicture& picture) {
  if (picture.shows_whole_mesh) return picture.mesh.vertices_mm;
  std::vector<Eigen::Vector3d> points;
  for (const PartLine& line : picture.lines)
    points.insert(points.end(), line.points_mm.begin(), line.points_mm.end());
  for (const auto& [from, to] : picture.axes_mm) points.push_back(to);
  return points;
}

/// The mesh lit, or coloured by its values.
Raster rendered(const PartPicture& picture, const View& inner, const Box& panel, const ColourMap& map) {
  Raster raster(static_cast<int>(panel.width), static_cast<int>(panel.height), kPaper);
  if (picture.value_mm.empty()) {
    render_mesh(raster, picture.mesh, inner, kPart);
    return raster;
  }
  for (std::size_t t = 0; t < picture.mesh.triangles.size(); ++t) {
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] =
          inner.project(picture.mesh.vertices_mm[static_cast<std::size_t>(picture.mesh.triangles[t][k])]);
    raster.triangle(corners, map.colour(static_cast<double>(picture.value_mm[t])));
  }
  return raster;
}

void draw_scan(Canvas& canvas, const PartPicture& picture, const View& view) {
  for (const Eigen::Vector3d& p : picture.points_mm)
    canvas.disc(view.pixel(p), kScanDotPx, kScanDot, {kScanDot, 0.0, {}, 1.0});
}

void draw_marks(Canvas& canvas, const PartPicture& picture, const View& view) {
  for (const auto& [from, to] : picture.axes_mm) {
    const std::vector<Eigen::Vector2d> line = {view.pixel(from), view.pixel(to)};
    canvas.polyline(line, false, {kAxis, 2.0, {}, 1.0});
  }
  for (const PartLine& line : picture.lines) {
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector3d& p : line.points_mm) pixels.push_back(view.pixel(p));
    draw_line(canvas, pixels, line.closed, line.item);
  }
  for (const Eigen::Vector3d& p : picture.dots_mm)
    canvas.disc(view.pixel(p), kDotPx, kMark, {{255, 255, 255}, 2.0, {}, 1.0});
}

std::vector<LegendItem> legend_of(const PartPicture& picture) {
  std::vector<LegendItem> legend;
  for (const PartLine& line : picture.lines)
    if (!line.item.text.empty()) legend.push_back(line.item);
  if (!picture.points_mm.empty()) legend.push_back({"scan", {kScanDot, 3.0, {}, 1.0}, std::nullopt, true});
  if (!picture.dots_mm.empty()) legend.push_back({"cut", {kMark, 3.0, {}, 1.0}, std::nullopt, true});
  if (!picture.axes_mm.empty())
    legend.push_back({"tool axis, out of the material", {kAxis, 2.0, {}, 1.0}, std::nullopt, false});
  return legend;
}

}  // namespace

std::string part_png(const PartPicture& picture) {
  const std::vector<Eigen::Vector3d> shown = framed(picture);
  const Orientation along = look_along(picture.normal, shown);
  const Orientation orientation = picture.is_oblique ? look_oblique(along) : along;
  Extent extent = extent_of(orientation, shown);
  const Eigen::Vector2d around = kAroundRatio * extent.size();
  extent.low -= around;
  extent.high += around;
  const bool has_scale = !picture.value_mm.empty();
  const Layout layout = lay_out(extent, has_scale ? kScaleWidth : 1.0);
  const View view = fit_view(orientation, extent, layout.panel, 0.0);
  View inner = view;
  inner.centre_px -= Eigen::Vector2d(layout.panel.x, layout.panel.y);
  const ColourMap map = colour_map_for(picture.value_mm, 0.0);

  const std::vector<LegendItem> legend = legend_of(picture);
  const int more_rows = static_cast<int>((legend.size() + kLegendItemsARow - 1) / kLegendItemsARow) - 1;
  Canvas canvas(kPictureWidth, layout.height_px + more_rows * kLegendRowPx, kPaper);
  draw_title(canvas, picture.title, picture.subtitle);
  canvas.raster(rendered(picture, inner, layout.panel, map), layout.panel.x, layout.panel.y);
  canvas.clip(layout.panel);
  draw_scan(canvas, picture, view);
  draw_marks(canvas, picture, view);
  canvas.unclip();
  (void)draw_scale_bar(canvas, view, layout.panel);
  (void)draw_axes(canvas, view, layout.panel);
  draw_panel_frame(canvas, layout.panel);
  if (has_scale) draw_colour_bar(canvas, map, layout.side);
  draw_legend_rows(canvas, legend, layout.legend_y);
  return canvas.png();
}

}  // namespace arris::bench
