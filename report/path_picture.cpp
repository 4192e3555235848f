#include <algorithm>
#include <array>
#include <cmath>

#include "report/number_text.hpp"
#include "report/path_summary.hpp"
#include "report/picture.hpp"
#include "report/picture_parts.hpp"
#include "report/scene.hpp"

namespace arris::report {
namespace {

constexpr Rgb kFromData{0, 90, 170}, kFromPrior{214, 98, 28}, kNominal{110, 110, 110}, kAxis{0, 120, 90};
const LegendItem kNominalLine{
    "nominal, carried rigidly", {kNominal, 3.0, {12.0, 7.0}, 1.0}, std::nullopt, false};
const LegendItem kDataLine{"corrected, from data", {kFromData, 5.0, {}, 1.0}, std::nullopt, false};
const LegendItem kPriorLine{"corrected, from prior", {kFromPrior, 5.0, {}, 1.0}, std::nullopt, false};
const LegendItem kAirLine{"air move", {{150, 150, 150}, 2.5, {3.0, 6.0}, 1.0}, std::nullopt, false};
const LegendItem kAxisLine{"tool axis, out of the material", {kAxis, 2.0, {}, 1.0}, std::nullopt, false};

// Nominal and corrected rows in the CAD frame.
struct Rows {
  std::vector<Eigen::Vector3d> nominal_mm, corrected_mm;
};

Rows rows_of(const RunRecord& record) {
  Rows rows;
  const std::size_t count = std::min(record.nominal_path.points.size(), record.correction.points.size());
  for (std::size_t i = 0; i < count; ++i) {
    rows.nominal_mm.push_back(record.nominal_path.points[i].tip_mm);
    rows.corrected_mm.push_back(local_to_cad_mm(record, record.correction.points[i].point.tip_mm));
  }
  return rows;
}

bool is_drawable(const RunRecord& record) {
  return record.accepted() && record.has_toolpath && record.correction.points.size() >= 2 &&
         record.nominal_path.points.size() == record.correction.points.size();
}

// 1, 2, 5, 10, ...: the largest at which the longest shift stays under an eighth of the path's extent.
double exaggeration(const RunRecord& record, const Rows& rows) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : rows.nominal_mm) box.extend(p);
  const double longest = std::max(path_summary(record).max_shift_mm, 1e-9);
  double factor = 1.0;
  for (const double next : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0})
    if (next * longest <= 0.125 * box.diagonal().norm()) factor = next;
  return factor;
}

const LegendItem& line_of(const CorrectedPoint& p) {
  if (p.air_move) return kAirLine;
  return p.from_data ? kDataLine : kPriorLine;
}

// Consecutive pieces of one kind as one line; a piece takes the kind of its second row, to and from the air
// is air.
void draw_corrected(Canvas& canvas, const RunRecord& record, const std::vector<Eigen::Vector3d>& rows_mm,
                    const View& view) {
  const auto& points = record.correction.points;
  std::vector<Eigen::Vector2d> run;
  const LegendItem* kind = nullptr;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    const bool joined = i < points.size() && points[i].point.path == points[i - 1].point.path;
    const LegendItem* next = joined ? &line_of(points[i - 1].air_move ? points[i - 1] : points[i]) : nullptr;
    if (next != kind && kind != nullptr) draw_line(canvas, run, false, *kind);
    if (next != kind) run.assign(1, view.pixel(rows_mm[i - 1]));
    if (next != nullptr) run.push_back(view.pixel(rows_mm[i]));
    kind = next;
  }
}

void draw_nominal(Canvas& canvas, const RunRecord& record, const Rows& rows, const View& view) {
  for (const PathRange& range : polylines(record.nominal_path)) {
    std::vector<Eigen::Vector2d> line;
    for (std::size_t i = range.begin; i < range.end; ++i)
      if (!record.correction.points[i].air_move) line.push_back(view.pixel(rows.nominal_mm[i]));
    draw_line(canvas, line, range.closed, kNominalLine);
  }
}

struct Stage {
  Layout layout;
  View view;
  Raster raster;
};

// The part in light grey, framed on the path.
Stage set_stage(const RunRecord& record, const std::vector<Eigen::Vector3d>& shown_mm, double grow_ratio) {
  const std::vector<Eigen::Vector3d> points = points_in_cad_mm(record);
  const Orientation orientation = look_oblique(look_along(mean_normal(record, points), points));
  Extent extent = extent_of(orientation, shown_mm);
  const Eigen::Vector2d grow = grow_ratio * extent.size();
  extent.low -= grow;
  extent.high += grow;
  const Layout layout = lay_out(extent, 1.0);
  const View view = fit_view(orientation, extent, layout.panel, 50.0);
  View inner = view;
  inner.centre_px -= Eigen::Vector2d(layout.panel.x, layout.panel.y);
  const double spacing_mm =
      drawn_spacing_mm(record.spacing_mm, points.size(), extent_of(orientation, points));
  std::vector<Rgb> colours(points.size(), kPlainPoint);
  for (std::size_t i = 0; i < std::min(points.size(), record.deviation_mm.size()); ++i)
    if (!std::isfinite(record.deviation_mm[i])) colours[i] = ColourMap::no_data();
  return {layout, view,
          render_points(points, colours, inner, spacing_mm, static_cast<int>(layout.panel.width),
                        static_cast<int>(layout.panel.height))};
}

std::vector<Eigen::Vector3d> without_air(const RunRecord& record,
                                         const std::vector<Eigen::Vector3d>& rows_mm) {
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < rows_mm.size(); ++i)
    if (!record.correction.points[i].air_move) kept.push_back(rows_mm[i]);
  return kept.empty() ? rows_mm : kept;
}

std::vector<LegendItem> kinds_in(const RunRecord& record) {
  const PathSummary summary = path_summary(record);
  std::vector<LegendItem> items = {kDataLine};
  if (summary.from_prior > 0) items.push_back(kPriorLine);
  if (summary.air_moves > 0) items.push_back(kAirLine);
  return items;
}

void finish(Canvas& canvas, const Stage& stage, const std::vector<LegendItem>& legend) {
  (void)draw_scale_bar(canvas, stage.view, stage.layout.panel);
  (void)draw_axes(canvas, stage.view, stage.layout.panel);
  draw_panel_frame(canvas, stage.layout.panel);
  draw_legend(canvas, legend, kMargin, stage.layout.legend_y, kPictureWidth - 2.0 * kMargin);
}

}  // namespace

std::string path_shift_picture(const RunRecord& record) {
  if (!is_drawable(record)) return {};
  const Rows rows = rows_of(record);
  const double factor = exaggeration(record, rows);
  std::vector<Eigen::Vector3d> shown_mm(rows.nominal_mm.size());
  for (std::size_t i = 0; i < shown_mm.size(); ++i)
    shown_mm[i] = rows.nominal_mm[i] + factor * (rows.corrected_mm[i] - rows.nominal_mm[i]);

  std::vector<Eigen::Vector3d> framed = without_air(record, shown_mm);
  const std::vector<Eigen::Vector3d> nominal = without_air(record, rows.nominal_mm);
  framed.insert(framed.end(), nominal.begin(), nominal.end());
  const Stage stage = set_stage(record, framed, 0.14);
  Canvas canvas(kPictureWidth, stage.layout.height_px, kPaper);
  const std::string times = fixed_text(factor, 0);
  draw_title(canvas,
             factor > 1.0 ? "Tool path: shift beyond the rigid alignment, drawn " + times + " times as large"
                          : "Tool path: shift beyond the rigid alignment, at true size",
             "largest shift " + fixed_text(path_summary(record).max_shift_mm, 2) + " mm at row " +
                 std::to_string(path_summary(record).max_shift_row) + "; grey: the scan");
  canvas.raster(stage.raster, stage.layout.panel.x, stage.layout.panel.y);
  canvas.clip(stage.layout.panel);
  const std::size_t step = std::max<std::size_t>(1, shown_mm.size() / 90);
  for (std::size_t i = 0; i < shown_mm.size(); i += step) {
    if (record.correction.points[i].air_move) continue;
    const std::vector<Eigen::Vector2d> arrow = {stage.view.pixel(rows.nominal_mm[i]),
                                                stage.view.pixel(shown_mm[i])};
    canvas.polyline(arrow, false, {line_of(record.correction.points[i]).stroke.colour, 1.5, {}, 0.6});
  }
  draw_nominal(canvas, record, rows, stage.view);
  draw_corrected(canvas, record, shown_mm, stage.view);
  canvas.unclip();
  std::vector<LegendItem> legend = kinds_in(record);
  legend.insert(legend.begin() + 1, kNominalLine);
  finish(canvas, stage, legend);
  return canvas.png();
}

std::string path_axes_picture(const RunRecord& record) {
  if (!is_drawable(record)) return {};
  const Rows rows = rows_of(record);
  const Eigen::Matrix3d cad_from_scan = record.alignment.scan_from_cad.linear().transpose();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : without_air(record, rows.corrected_mm)) box.extend(p);
  const double axis_mm = 0.1 * box.diagonal().norm();
  std::vector<Eigen::Vector3d> framed, tips_mm(rows.corrected_mm.size());
  for (std::size_t i = 0; i < tips_mm.size(); ++i) {
    tips_mm[i] = rows.corrected_mm[i] + axis_mm * (cad_from_scan * record.correction.points[i].point.axis);
    framed.push_back(rows.corrected_mm[i]);
    framed.push_back(tips_mm[i]);
  }
  const Stage stage = set_stage(record, framed, 0.14);
  Canvas canvas(kPictureWidth, stage.layout.height_px, kPaper);
  draw_title(canvas, "Corrected tool path with the tool's axes, true scale",
             "largest turn of the axis " +
                 fixed_text(path_summary(record).max_tilt_rad * 57.29577951308232, 2) +
                 " deg beyond the rigid alignment; grey: the scan");
  canvas.raster(stage.raster, stage.layout.panel.x, stage.layout.panel.y);
  canvas.clip(stage.layout.panel);
  const std::size_t step = std::max<std::size_t>(1, tips_mm.size() / 90);
  for (std::size_t i = 0; i < tips_mm.size(); i += step) {
    if (record.correction.points[i].air_move) continue;
    const std::vector<Eigen::Vector2d> line = {stage.view.pixel(rows.corrected_mm[i]),
                                               stage.view.pixel(tips_mm[i])};
    canvas.polyline(line, false, kAxisLine.stroke);
  }
  draw_corrected(canvas, record, rows.corrected_mm, stage.view);
  canvas.unclip();
  std::vector<LegendItem> legend = kinds_in(record);
  legend.push_back(kAxisLine);
  finish(canvas, stage, legend);
  return canvas.png();
}

}  // namespace arris::report
