#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/definitions.hpp"
#include "report/html_sections.hpp"
#include "report/html_text.hpp"
#include "report/number_text.hpp"
#include "report/path_summary.hpp"
#include "report/picture.hpp"
#include "report/statistics.hpp"
#include "report/svg_chart.hpp"
#include "report/verdict.hpp"
#include "report/worst_points.hpp"

namespace arris::report::html {
namespace {

constexpr Rgb kBefore{150, 150, 150}, kAfter{0, 90, 170}, kNormal{0, 130, 95}, kAcross{190, 70, 150};
constexpr Rgb kGap{226, 228, 231}, kPriorBand{255, 226, 196};
constexpr std::size_t kMostContourCharts = 6;

std::string swatch(const std::string& colour) {
  return "<span class=\"swatch\" style=\"background:" + colour + "\"></span>";
}

// Points of each step of the scale: the histogram's counts as a table.
std::string counts_table(const RunRecord& record, const ColourMap& map) {
  const auto& steps = map.steps();
  std::vector<std::size_t> counts(steps.size() + 2, 0);
  std::size_t no_data = 0;
  for (const float d : record.deviation_mm) {
    if (std::isfinite(d))
      ++counts[static_cast<std::size_t>(map.step_of(static_cast<double>(d)) + 1)];
    else
      ++no_data;
  }
  std::size_t total = 0;
  for (const std::size_t count : counts) total += count;
  const auto share = [&](std::size_t count) {
    return percent(total == 0 ? std::nan("") : static_cast<double>(count) / static_cast<double>(total), 2);
  };
  const auto row = [&](const std::string& mark, const std::string& from, const std::string& to,
                       std::size_t count) {
    return number_row({mark, from, to, grouped_text(count), share(count)});
  };
  std::string rows = number_row({"colour", "from, mm", "to, mm", "points", "share"}, "th");
  rows += row(swatch(to_hex(ColourMap::over_scale())) + " over scale", signed_mm(map.limit_mm(), 4), "",
              counts.back());
  for (std::size_t i = steps.size(); i-- > 0;) {
    const bool in_zone = std::abs(steps[i].from_mm + steps[i].to_mm) < 2.0 * map.half_zone_mm();
    rows += row(swatch(to_hex(steps[i].colour)) + (in_zone ? " in tolerance" : ""),
                signed_mm(steps[i].from_mm, 4), signed_mm(steps[i].to_mm, 4), counts[i + 1]);
  }
  rows += row(swatch(to_hex(ColourMap::under_scale())) + " under scale", "", signed_mm(-map.limit_mm(), 4),
              counts[0]);
  rows += number_row({"<span class=\"swatch hatch\"></span> no data", "", "", grouped_text(no_data), ""});
  return tag("table", rows);
}

std::string contour_charts(const ContourError& error) {
  std::vector<bool> unseen;
  for (const double e : error.rigid_mm) unseen.push_back(!std::isfinite(e));
  const ChartBands gaps = {"no edge seen", kGap, spans_where(error.arc_mm, unseen)};
  LineChart sizes;
  sizes.x_label = error.contour + ": arc length, mm";
  sizes.y_label = "error, mm";
  sizes.x = error.arc_mm;
  sizes.series = {{"before (rigid)", kBefore, 2.0, false, error.rigid_mm},
                  {"after", kAfter, 2.0, false, after_mm(error)}};
  sizes.bands = {gaps};
  LineChart parts = sizes;
  parts.y_label = "signed error after, mm";
  parts.series = {{"across, in the surface", kAcross, 1.6, false, error.across_mm},
                  {"along the normal", kNormal, 1.6, false, error.normal_mm}};
  parts.height_px = 240.0;
  return chart(line_chart(sizes),
               "Distance from the edge found in the scan to the nominal contour, carried rigidly "
               "(before) and by the chosen method (after). Touch the chart to read values.") +
         chart(line_chart(parts),
               "The error after, taken apart: the edge that was found, seen from the corrected contour. "
               "Positive across: "
               "towards the void (more material than nominal); positive normal: outside the material.");
}

std::string error_cells(const std::string& name, const ContourErrorSummary& s) {
  const auto value = [](const ErrorSummary& e, double ErrorSummary::*field) {
    return mm(e.count > 0 ? e.*field : std::nan(""));
  };
  std::string rows;
  for (const auto& [stage, e] : {std::pair<const char*, const ErrorSummary*>{"before (rigid)", &s.rigid},
                                 {"after", &s.after},
                                 {"after, across", &s.across},
                                 {"after, normal", &s.normal}})
    rows += number_row({escaped(name) + ", " + stage,
                        std::to_string(e->count) + " of " + std::to_string(s.points),
                        value(*e, &ErrorSummary::mean_mm), value(*e, &ErrorSummary::rms_mm),
                        value(*e, &ErrorSummary::p95_mm), value(*e, &ErrorSummary::max_mm)});
  return rows;
}

std::string improvement(const ContourErrorSummary& s) {
  if (s.rigid.count == 0 || s.after.count == 0 || !(s.rigid.mean_mm > 0.0)) return {};
  const auto change = [](double before, double after) {
    return (after <= before ? "\u2212" : "+") + fixed_text(std::abs(100.0 * (after - before) / before), 0) +
           " %";
  };
  return tag("p", "Against the rigid alignment: mean " + change(s.rigid.mean_mm, s.after.mean_mm) +
                      ", largest " + change(s.rigid.max_mm, s.after.max_mm) + ".");
}

std::string shift_chart(const RunRecord& record) {
  const auto& points = record.correction.points;
  if (points.empty() || points.size() != record.nominal_path.points.size()) return {};
  LineChart shifts;
  shifts.x_label = "length along the nominal path, mm";
  shifts.y_label = "shift, mm";
  shifts.x = path_arc_mm(record.nominal_path);
  std::vector<double> size, normal, across;
  std::vector<bool> prior, air;
  for (const CorrectedPoint& p : points) {
    const double nan = std::nan("");
    size.push_back(p.air_move ? nan : p.shift_mm);
    normal.push_back(p.air_move ? nan : p.shift_normal_mm);
    across.push_back(p.air_move ? nan : p.shift_across_mm);
    prior.push_back(!p.air_move && !p.from_data);
    air.push_back(p.air_move);
  }
  shifts.series = {{"size", kAfter, 2.4, false, size},
                   {"normal", kNormal, 1.6, false, normal},
                   {"across", kAcross, 1.6, true, across}};
  shifts.bands = {{"from prior", kPriorBand, spans_where(shifts.x, prior)},
                  {"air move", kGap, spans_where(shifts.x, air)}};
  if (record.max_correction_mm > 0.0) shifts.limits = {record.max_correction_mm};
  shifts.limit_name = "limit";
  std::string caption = "Shift beyond the rigid alignment, row by row; white ground: decided by scan data.";
  if (record.max_correction_mm > 0.0)
    caption += " Limit of the recipe: " + mm(record.max_correction_mm, 2) + " mm.";
  return chart(line_chart(shifts), caption);
}

std::string path_table(const RunRecord& record) {
  const PathSummary s = path_summary(record);
  std::string rows = number_row({"corrected path", "value"}, "th");
  rows += number_row({"rows, in polylines", std::to_string(s.points) + " in " + std::to_string(s.polylines)});
  rows += number_row({"rows from data / from prior / air moves", std::to_string(s.from_data) + " / " +
                                                                     std::to_string(s.from_prior) + " / " +
                                                                     std::to_string(s.air_moves)});
  rows += number_row(
      {"largest shift, mm",
       mm(s.max_shift_mm) + (s.max_shift_row > 0 ? " (row " + std::to_string(s.max_shift_row) + ")" : "")});
  rows += number_row({"mean shift, mm", mm(s.mean_shift_mm)});
  rows += number_row({"largest turn of the axis, degrees", mm(s.max_tilt_rad * 57.29577951308232, 2)});
  const auto sd = [](double value) { return value > 0.0 ? mm(value) : "not known"; };
  rows += number_row({"largest standard deviation, normal / across, mm",
                      sd(s.max_sd_normal_mm) + " / " + sd(s.max_sd_across_mm)});
  rows += number_row(
      {"edge limit E / surface limit, mm", sd(record.edge_limit_mm) + " / " + sd(record.surface_limit_mm)});
  return tag("table", rows);
}

std::string coordinates(const Eigen::Vector3d& p) {
  return mm(p.x(), 2) + ", " + mm(p.y(), 2) + ", " + mm(p.z(), 2);
}

std::string bending_text(const RunRecord::ProjectionSummary& p) {
  if (!p.bending) return {};
  return tag("p", "Contour " + std::to_string(p.contour) + ": bending radius " +
                      mm(0.5 / p.bending->alpha_per_mm, 0) + " mm, about an axis through (" +
                      coordinates(p.bending->axis_point_mm) +
                      ") in the CAD frame, whose direction is known to " +
                      mm(p.bending->axis_sd_rad * 180.0 / std::numbers::pi, 1) + "&deg;.");
}

std::string projection_table(const RunRecord& record) {
  if (record.projection.empty()) return {};
  std::string bendings, rows = number_row({"contour", "model", "points", "scatter, mm",
                                           "height, rms / max, mm", "across, rms / max, mm"},
                                          "th");
  for (const auto& p : record.projection) {
    rows += number_row({std::to_string(p.contour), escaped(p.model), std::to_string(p.points),
                        mm(p.scatter_mm), mm(p.height_rms_mm) + " / " + mm(p.height_max_mm),
                        mm(p.across_rms_mm) + " / " + mm(p.across_max_mm)});
    bendings += bending_text(p);
  }
  return tag("h3", "Projection") +
         tag("p",
             "What the model leaves between itself and the scan. An edge that moved in the surface "
             "(across) is not followed by a projection.") +
         tag("div", tag("table", rows), "scroll") + bendings;
}

}  // namespace

std::string deviation_section(const RunRecord& record) {
  std::string html = tag("h2", "Shape as scanned (ii): deviation from the CAD");
  const bool has_data = record.as_scanned.count > 0;
  if (has_data)
    html += tag(
        "p",
        "Positive: outside the material." +
            std::string(record.surface_profile_mm > 0.0 ? " Green is exactly the tolerance zone." : "") +
            " Hatched: the CAD shows there, and the scan has no data. H and L mark the highest and lowest "
            "points listed below.");
  html += picture(deviation_picture(record, Look::kAlong), "scan coloured by deviation, from above", "");
  if (!has_data) return html + tag("p", "No deviation was computed for this run.");
  html += picture(deviation_picture(record, Look::kOblique), "scan coloured by deviation, oblique", "");
  const ColourMap map = colour_map_for(record.deviation_mm, record.surface_profile_mm);
  const Histogram counts = histogram(record.deviation_mm, record.surface_profile_mm, map.limit_mm());
  html += tag("h3", "Distribution");
  html += chart(histogram_chart(counts, map), std::to_string(counts.under) + " points lie under and " +
                                                  std::to_string(counts.over) + " over the range shown.");
  return html + counts_table(record, map);
}

std::string contour_error_section(const RunRecord& record) {
  std::string html = tag("h2", "Error along the contour, before and after");
  if (record.contour_errors.empty())
    return html + tag("p", record.role == "cut"
                               ? "The tool makes this contour: there is no edge to compare with yet."
                               : "No edge was found in the scan to compare with.");
  const ContourErrorSummary all = contour_error_summary(record.contour_errors);
  html += improvement(all);
  std::vector<const ContourError*> worst;
  for (const ContourError& error : record.contour_errors) worst.push_back(&error);
  if (worst.size() > kMostContourCharts) {
    const auto peak = [](const ContourError* e) { return contour_error_summary({e, 1}).after.max_mm; };
    std::stable_sort(worst.begin(), worst.end(),
                     [&](const auto* a, const auto* b) { return peak(a) > peak(b); });
    worst.resize(kMostContourCharts);
    html += tag(
        "p", "Drawn: the " + std::to_string(kMostContourCharts) + " contours with the largest error after.");
  }
  for (const ContourError* error : worst) html += contour_charts(*error);
  std::string rows = number_row({"error, mm", "seen", "mean", "rms", "95 %", "max"}, "th");
  for (const ContourError& error : record.contour_errors)
    rows += error_cells(error.contour, contour_error_summary({&error, 1}));
  if (record.contour_errors.size() > 1) rows += error_cells("all", all);
  return html + tag("table", rows);
}

std::string path_section(const RunRecord& record) {
  if (!record.has_toolpath) return {};
  std::string html = tag("h2", "Tool path");
  if (!record.accepted()) {
    html += tag("p", tag("strong", "No program was written.") +
                         " The corrected path is refused and must not be used, so it is not drawn.");
    const std::string diagnosis = shift_chart(record);
    return diagnosis.empty() ? html
                             : html + tag("h3", "For diagnosis: the shift that was computed") + diagnosis;
  }
  html += picture(path_shift_picture(record), "nominal and corrected tool path", "");
  html += shift_chart(record);
  html += picture(path_axes_picture(record), "corrected tool path with tool axes", "");
  html += path_table(record);
  return html +
         tag("p", "Robot program: " + escaped(record.program_note.empty() ? "none" : record.program_note));
}

std::string worst_points_section(const RunRecord& record) {
  const std::vector<WorstPoint> points = worst_points(record);
  if (points.empty()) return {};
  const bool has_zone = record.surface_profile_mm > 0.0;
  std::string rows =
      "<tr><th>id</th><th class=\"n\">deviation</th><th class=\"n\">nominal, CAD frame</th>"
      "<th class=\"n\">actual, CAD frame</th><th class=\"n\">actual, scan file</th><th>zone</th></tr>\n";
  for (const WorstPoint& p : points)
    rows += tag("tr", tag("td", tag("strong", escaped(p.id))) + tag("td", signed_mm(p.deviation_mm), "n") +
                          tag("td", p.has_nominal ? coordinates(p.nominal_cad_mm) : "&ndash;", "n") +
                          tag("td", coordinates(p.p_cad_mm), "n") + tag("td", coordinates(p.p_scan_mm), "n") +
                          (!has_zone        ? tag("td", "&ndash;")
                           : p.in_tolerance ? tag("td", "inside")
                                            : tag("td", "outside", "out"))) +
            "\n";
  std::string html = tag("h2", "Worst points");
  html +=
      tag("p", "The highest (H) and lowest (L) scan points, each at least " + mm(flag_spacing_mm(record), 1) +
                   " mm from the next; x, y, z in mm. They belong to result (ii).");
  return html + tag("div", tag("table", rows), "scroll");
}

std::string refinement_tables(const RefinementSummary& summary) {
  if (!summary.asked) return {};
  std::string rounds = number_row(
      {"round", "scale, sigmas", "cost before", "cost after", "steps", "ended", "largest move, mm"}, "th");
  for (std::size_t i = 0; i < summary.rounds.size(); ++i) {
    const RefinementSummary::Round& r = summary.rounds[i];
    rounds +=
        number_row({std::to_string(i + 1), mm(r.scale_sigmas, 1), mm(r.cost_before, 2), mm(r.cost_after, 2),
                    std::to_string(r.iterations), escaped(r.termination), mm(r.move_mm, 4)});
  }
  std::string html = tag("h3", "Joint fit of the segments") + tag("p", escaped(summary.statement)) +
                     tag("div", tag("table", rounds), "scroll");
  if (!summary.used) return html;
  std::string segments =
      number_row({"contour", "from, mm", "to, mm", "edge points", "rms before, mm", "rms after, mm"}, "th");
  for (const auto& s : summary.segments)
    segments += number_row({std::to_string(s.contour), mm(s.from_mm, 1), mm(s.to_mm, 1),
                            std::to_string(s.pairs), mm(s.rms_before_mm), mm(s.rms_after_mm)});
  std::string seams = number_row({"contour", "seam at, mm", "jump before, mm", "jump after, mm",
                                  "turn before, mrad", "turn after, mrad"},
                                 "th");
  for (const auto& s : summary.seams)
    seams += number_row({std::to_string(s.contour), mm(s.arc_mm, 1), mm(s.jump_before_mm),
                         mm(s.jump_after_mm), mm(1e3 * s.turn_before_rad, 1), mm(1e3 * s.turn_after_rad, 1)});
  return html + tag("div", tag("table", segments), "scroll") +
         tag("p",
             "Residuals are distances to the edge as it was found before, across and normal to it. They may "
             "grow: a segment gives up some of its own points where its neighbours contradict them. Then the "
             "edge is found once more, and the path follows it.") +
         tag("div", tag("table", seams), "scroll");
}

std::string registration_section(const RunRecord& record) {
  std::string html;
  if (!record.stage_residual_mm.empty()) {
    std::string rows = number_row({"stage", "rms of the edge pairs, mm"}, "th");
    for (const auto& [stage, rms_mm] : record.stage_residual_mm)
      rows += number_row({escaped(stage), mm(rms_mm)});
    html += tag("h3", "Residual after each stage") + tag("table", rows);
  }
  if (!record.segments.empty()) {
    std::string rows = number_row(
        {"contour", "from, mm", "to, mm", "rms, mm", "steps", "pairs", "decided by", "stopped"}, "th");
    for (const auto& s : record.segments)
      rows += number_row({std::to_string(s.contour), mm(s.from_mm, 1), mm(s.to_mm, 1), mm(s.rms_mm),
                          std::to_string(s.iterations), std::to_string(s.pairs),
                          s.from_data ? "data" : "prior", escaped(s.stop)});
    html += tag("h3", "Segments") + tag("div", tag("table", rows), "scroll");
  }
  html += projection_table(record);
  html += refinement_tables(record.refinement);
  if (record.method != "rigid" && record.accepted())
    html += tag("p", "Mean in-surface strain along the contours: " + escaped(strain_text(record)) + ".");
  return html.empty() ? html : tag("h2", "Registration: " + escaped(record.method)) + html;
}

std::string notes_and_definitions(const RunRecord& record) {
  std::string html;
  if (!record.notes.empty()) {
    std::string items;
    for (const std::string& note : record.notes) items += tag("li", escaped(note));
    html += tag("h2", "Notes") + tag("ul", items);
  }
  std::string rows;
  for (const Definition& definition : definitions())
    rows += tag("tr", tag("th", escaped(definition.name)) + tag("td", escaped(definition.meaning))) + "\n";
  return html + tag("h2", "What each number is") + tag("table", rows, "terms");
}

}  // namespace arris::report::html
