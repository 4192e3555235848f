#include "report/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/number_text.hpp"
#include "report/picture_parts.hpp"
#include "report/scene.hpp"
#include "report/worst_points.hpp"

namespace arris::report {
namespace {

constexpr double kBarWidth = 224.0;

const LegendItem kFoundEdge{"edge found in the scan", {{0, 0, 0}, 2.2, {}, 1.0}, std::nullopt, false};
const LegendItem kDroppedLoop{"loop not used", {{60, 60, 60}, 2.0, {9.0, 6.0}, 1.0}, std::nullopt, false};
const LegendItem kToolPath{"corrected path", {{255, 255, 255}, 6.0, {}, 1.0}, Rgb{0, 0, 0}, false};
const LegendItem kWorst{
    "H highest, L lowest points, mm", {{255, 255, 255}, 2.0, {}, 1.0}, std::nullopt, true};

bool has_deviation(const RunRecord& record) {
  return std::any_of(record.deviation_mm.begin(), record.deviation_mm.end(),
                     [](float d) { return std::isfinite(d); });
}

// Points that decide what the picture shows: those on the part, not the table around it.
std::vector<Eigen::Vector3d> points_on_part(const RunRecord& record,
                                            const std::vector<Eigen::Vector3d>& points) {
  if (!has_deviation(record)) return points;
  std::vector<Eigen::Vector3d> on_part;
  for (std::size_t i = 0; i < std::min(points.size(), record.deviation_mm.size()); ++i)
    if (std::isfinite(record.deviation_mm[i])) on_part.push_back(points[i]);
  return on_part;
}

std::vector<Rgb> colours_of(const RunRecord& record, const ColourMap& map) {
  std::vector<Rgb> colours(record.cloud.size(), ColourMap::no_data());
  for (std::size_t i = 0; i < std::min(colours.size(), record.deviation_mm.size()); ++i)
    colours[i] = map.colour(static_cast<double>(record.deviation_mm[i]));
  return colours;
}

std::vector<Eigen::Vector2d> on_page(const RunRecord& record, const std::vector<Eigen::Vector3d>& local_mm,
                                     const View& view) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3d& p : local_mm) pixels.push_back(view.pixel(local_to_cad_mm(record, p)));
  return pixels;
}

void draw_path(Canvas& canvas, const RunRecord& record, const View& view) {
  std::vector<Eigen::Vector3d> run;
  const auto flush = [&] {
    draw_line(canvas, on_page(record, run, view), false, kToolPath);
    run.clear();
  };
  const auto& points = record.correction.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && points[i].point.path != points[i - 1].point.path) flush();
    if (points[i].air_move)
      flush();
    else
      run.push_back(points[i].point.tip_mm);
  }
  flush();
}

// The path below, the edge on top: where they lie on each other both are seen.
void draw_edges_and_path(Canvas& canvas, const RunRecord& record, const View& view) {
  for (const Contour& contour : record.dropped_contours)
    draw_line(canvas, on_page(record, contour.points_mm, view), contour.closed, kDroppedLoop);
  if (record.accepted()) draw_path(canvas, record, view);
  for (const Contour& contour : record.found_contours)
    draw_line(canvas, on_page(record, contour.points_mm, view), contour.closed, kFoundEdge);
}

std::vector<Flag> flags_of(const RunRecord& record, const ColourMap& map, const View& view,
                           const Raster& raster, const Box& panel, double slack_mm) {
  std::vector<Flag> flags;
  for (const WorstPoint& point : worst_points(record)) {
    const Eigen::Vector3d seen = view.project(point.p_cad_mm);
    const Eigen::Vector3d in_raster = seen - Eigen::Vector3d(panel.x, panel.y, 0.0);
    if (!panel.holds(seen.head<2>()) || !raster.sees(in_raster, slack_mm)) continue;
    flags.push_back({seen.head<2>(), point.id + "  " + signed_text(point.deviation_mm, 2),
                     map.colour(point.deviation_mm)});
  }
  return flags;
}

std::string look_text(Look look) {
  return look == Look::kAlong ? "seen against the part's mean normal" : "seen obliquely";
}

// View in panel coordinates moved to where the panel's raster starts.
View in_panel(View view, const Box& panel) {
  view.centre_px -= Eigen::Vector2d(panel.x, panel.y);
  return view;
}

Orientation orientation_of(const RunRecord& record, const std::vector<Eigen::Vector3d>& on_part, Look look) {
  const bool is_aligned = has_deviation(record);
  const Eigen::Vector3d normal = is_aligned ? mean_normal(record, on_part) : plane_normal(on_part);
  const Orientation along = look_along(normal, on_part);
  return look == Look::kAlong ? along : look_oblique(along);
}

}  // namespace

std::string deviation_picture(const RunRecord& record, Look look) {
  if (record.cloud.empty()) return {};
  const bool is_judged = has_deviation(record);
  const std::vector<Eigen::Vector3d> points = points_in_cad_mm(record),
                                     on_part = points_on_part(record, points);
  const Orientation orientation = orientation_of(record, on_part, look);
  const Extent extent = extent_of(orientation, on_part);
  const Layout layout = lay_out(extent, is_judged ? kBarWidth : 1.0);
  const View view = fit_view(orientation, extent, layout.panel, 64.0);
  const ColourMap map = colour_map_for(record.deviation_mm, record.surface_profile_mm);
  const double spacing_mm = drawn_spacing_mm(record.spacing_mm, on_part.size(), extent);

  const std::vector<Rgb> colours = is_judged ? colours_of(record, map) : std::vector<Rgb>{kPlainPoint};
  Raster raster = render_points(points, colours, in_panel(view, layout.panel), spacing_mm,
                                static_cast<int>(layout.panel.width), static_cast<int>(layout.panel.height));
  if (is_judged) hatch_unseen(raster, record.cad, in_panel(view, layout.panel));

  Canvas canvas(kPictureWidth, layout.height_px, kPaper);
  draw_title(canvas,
             is_judged ? "Deviation of the scan from the CAD, after the rigid alignment" : "The scan as read",
             (is_judged ? grouped_text(record.as_scanned.count) + " points with data, "
                        : "no deviation was computed; ") +
                 look_text(look));
  canvas.raster(raster, layout.panel.x, layout.panel.y);
  if (!is_judged) {
    draw_panel_frame(canvas, layout.panel);
    (void)draw_scale_bar(canvas, view, layout.panel);
    return canvas.png();
  }
  canvas.clip(layout.panel);
  draw_edges_and_path(canvas, record, view);
  canvas.unclip();
  const std::vector<Box> taken = {draw_scale_bar(canvas, view, layout.panel),
                                  draw_axes(canvas, view, layout.panel)};
  draw_flags(canvas, flags_of(record, map, view, raster, layout.panel, 3.0 * spacing_mm), layout.panel,
             taken);
  draw_panel_frame(canvas, layout.panel);
  draw_colour_bar(canvas, map, layout.side);
  std::vector<LegendItem> legend = {kWorst, kFoundEdge};
  if (record.accepted() && record.has_toolpath) legend.push_back(kToolPath);
  if (!record.dropped_contours.empty()) legend.push_back(kDroppedLoop);
  draw_legend(canvas, legend, kMargin, layout.legend_y, kPictureWidth - 2.0 * kMargin);
  return canvas.png();
}

}  // namespace arris::report
