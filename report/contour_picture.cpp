#include <algorithm>
#include <array>
#include <cmath>

#include "report/number_text.hpp"
#include "report/picture.hpp"
#include "report/picture_parts.hpp"
#include "report/scene.hpp"

namespace arris::report {
namespace {

constexpr double kListWidth = 330.0;
constexpr std::array<Rgb, 8> kColours = {{{0, 114, 178},
                                          {213, 94, 0},
                                          {0, 140, 100},
                                          {190, 70, 150},
                                          {200, 140, 0},
                                          {60, 150, 210},
                                          {106, 61, 154},
                                          {120, 80, 50}}};
constexpr Rgb kDropped{120, 120, 120};

Rgb colour_of(std::size_t i) {
  return kColours[i % kColours.size()];
}

std::vector<Eigen::Vector3d> sampled(const ContourDrawing& drawing) {
  std::vector<Eigen::Vector3d> points;
  const std::size_t step = std::max<std::size_t>(1, drawing.points_mm.size() / 200000);
  for (std::size_t i = 0; i < drawing.points_mm.size(); i += step)
    points.push_back(drawing.points_mm[i].cast<double>());
  if (drawing.mesh != nullptr)
    points.insert(points.end(), drawing.mesh->vertices_mm.begin(), drawing.mesh->vertices_mm.end());
  for (const Contour& contour : drawing.contours)
    points.insert(points.end(), contour.points_mm.begin(), contour.points_mm.end());
  return points;
}

// Against the mean normal of the contours when they have one, else against the plane of everything.
Orientation orientation_of(const ContourDrawing& drawing, const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const Contour& contour : drawing.contours)
    for (const Eigen::Vector3d& n : contour.normals) sum += n, count += 1.0;
  const bool is_clear = count > 0.0 && sum.norm() > 0.5 * count;
  const Orientation along = look_along(is_clear ? sum.normalized() : plane_normal(points), points);
  const Extent extent = extent_of(along, points);
  double low = 1e300, high = -1e300;
  for (const Eigen::Vector3d& p : points) {
    low = std::min(low, along.row(2).dot(p));
    high = std::max(high, along.row(2).dot(p));
  }
  return high - low > 0.25 * extent.size().maxCoeff() ? look_oblique(along)
                                                      : along;  // flat parts: straight on
}

Raster render(const ContourDrawing& drawing, const View& view, const Layout& layout, double spacing_mm) {
  View inner = view;
  inner.centre_px -= Eigen::Vector2d(layout.panel.x, layout.panel.y);
  const int width = static_cast<int>(layout.panel.width), height = static_cast<int>(layout.panel.height);
  if (drawing.mesh != nullptr && !drawing.mesh->empty()) {
    Raster raster(width, height, kPaper);
    render_mesh(raster, *drawing.mesh, inner, {226, 228, 231});
    return raster;
  }
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : drawing.points_mm) points.push_back(p.cast<double>());
  const std::array<Rgb, 1> plain = {kPlainPoint};
  return render_points(points, plain, inner, spacing_mm, width, height);
}

std::vector<Eigen::Vector2d> on_page(const Contour& contour, const View& view) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3d& p : contour.points_mm) pixels.push_back(view.pixel(p));
  return pixels;
}

void draw_list(Canvas& canvas, const ContourDrawing& drawing, const Box& side) {
  const TextStyle head{kLabelSize, true, kInk, Anchor::kLeft}, row{kLabelSize, false, kInk, Anchor::kLeft};
  canvas.text(side.x, side.y + 20.0, "id, length in mm", head);
  double y = side.y + 64.0;
  const double last = side.y + side.height - 70.0;
  for (std::size_t i = 0; i < drawing.contours.size(); ++i, y += 40.0) {
    if (y > last) {
      canvas.text(side.x, y, "and " + std::to_string(drawing.contours.size() - i) + " more", row);
      y += 40.0;
      break;
    }
    const Contour& contour = drawing.contours[i];
    canvas.rectangle({side.x, y - 21.0, 30.0, 24.0}, colour_of(i));
    const std::string text = std::to_string(contour.id) + "   " + fixed_text(length_mm(contour), 1) +
                             (contour.closed ? " closed" : " open");
    canvas.text(side.x + 42.0, y, canvas.fitted(text, row, side.width - 42.0), row);
  }
  if (drawing.dropped.empty()) return;
  const std::vector<Eigen::Vector2d> sample = {{side.x, y - 8.0}, {side.x + 30.0, y - 8.0}};
  canvas.polyline(sample, false, {kDropped, 3.0, {6.0, 5.0}, 1.0});
  canvas.text(side.x + 42.0, y, "dropped: " + std::to_string(drawing.dropped.size()), row);
}

}  // namespace

std::string contours_picture(const ContourDrawing& drawing) {
  const std::vector<Eigen::Vector3d> points = sampled(drawing);
  if (points.empty()) return {};
  const Orientation orientation = orientation_of(drawing, points);
  const Extent extent = extent_of(orientation, points);
  const Layout layout = lay_out(extent, kListWidth);
  const View view = fit_view(orientation, extent, layout.panel, 60.0);
  const double spacing_mm = drawn_spacing_mm(0.0, drawing.points_mm.size(), extent);

  Canvas canvas(kPictureWidth, layout.height_px, kPaper);
  draw_title(canvas, drawing.title, drawing.subtitle);
  canvas.raster(render(drawing, view, layout, spacing_mm), layout.panel.x, layout.panel.y);
  canvas.clip(layout.panel);
  for (const Contour& contour : drawing.dropped)
    canvas.polyline(on_page(contour, view), contour.closed, {kDropped, 3.0, {6.0, 5.0}, 1.0});
  std::vector<Flag> flags;
  for (std::size_t i = 0; i < drawing.contours.size(); ++i) {
    const std::vector<Eigen::Vector2d> line = on_page(drawing.contours[i], view);
    canvas.polyline(line, drawing.contours[i].closed, {{255, 255, 255}, 9.0, {}, 0.8});
    canvas.polyline(line, drawing.contours[i].closed, {colour_of(i), 5.0, {}, 1.0});
    if (!line.empty()) flags.push_back({line.front(), std::to_string(drawing.contours[i].id), colour_of(i)});
  }
  canvas.unclip();
  const std::vector<Box> taken = {draw_scale_bar(canvas, view, layout.panel),
                                  draw_axes(canvas, view, layout.panel)};
  draw_flags(canvas, flags, layout.panel, taken);
  draw_panel_frame(canvas, layout.panel);
  draw_list(canvas, drawing, layout.side);
  const TextStyle soft{22.0, false, kSoftInk, Anchor::kLeft};
  canvas.text(kMargin, layout.legend_y, "the dot marks where each contour starts", soft);
  return canvas.png();
}

}  // namespace arris::report
