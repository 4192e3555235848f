#include "report/write_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "report/colour_map.hpp"
#include "report/definitions.hpp"
#include "report/number_text.hpp"
#include "report/path_summary.hpp"
#include "report/statistics.hpp"
#include "report/verdict.hpp"
#include "report/worst_points.hpp"

namespace arris::report {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(rounded(value)) : Json(nullptr);
}
Json number_or_null(double value, bool known) {
  return known ? number(value) : Json(nullptr);
}

Json numbers(std::span<const double> values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(number(value));
  return array;
}

Json vector3(const Eigen::Vector3d& v) {
  return Json::array({number(v.x()), number(v.y()), number(v.z())});
}
double degrees(double rad) {
  return rad * 57.29577951308232;
}

Json matrix(const RigidMotion& motion) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    Json line = Json::array();
    for (int col = 0; col < 4; ++col) line.push_back(number(motion.matrix()(row, col)));
    rows.push_back(line);
  }
  return rows;
}

Json inputs(const RunRecord& record) {
  Json array = Json::array();
  for (const InputFile& input : record.inputs)
    array.push_back({{"role", input.role}, {"name", input.name}, {"sha256", input.sha256}});
  return array;
}

Json acquisition(const RunRecord& record) {
  return {{"points_read", record.points_read},       {"points_nonfinite", record.points_nonfinite},
          {"points_outlier", record.points_outlier}, {"points_used", record.points_used},
          {"spacing_mm", number(record.spacing_mm)}, {"noise_sigma_mm", number(record.noise_sigma_mm)}};
}

Json six_digits(double value) {
  const double scale = value == 0.0 ? 1.0 : std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(value) ? Json(std::round(value * scale) / scale) : Json(nullptr);
}

Json alignment(const RunRecord& record) {
  const AlignmentSummary& a = record.alignment;
  Json json;
  json["scan_from_cad"] = matrix(a.scan_from_cad);
  json["diagnosis_only"] = !record.accepted();
  json["rms_mm"] = number(a.rms_mm);
  json["overlap_ratio"] = number(a.overlap_ratio);
  json["pairs"] = a.pairs;
  json["runner_up_ratio"] = number(a.runner_up_ratio);
  json["equal_poses"] = a.equal_poses;
  json["side_decided_by"] = a.side_decided_by;
  json["start"] = a.start;
  json["free_directions"] = a.free_directions;
  json["covariance_6x6"] = Json(nullptr);
  if (!a.covariance_6x6.empty()) {  // entries reach down to 1e-12 rad^2: not rounded to 1e-6, but to 6 digits
    Json rows = Json::array();
    for (const double value : a.covariance_6x6) rows.push_back(six_digits(value));
    json["covariance_6x6"] = rows;
    const Eigen::Vector3d& about = a.covariance_about_mm;
    json["covariance_about_mm"] = {number(about.x()), number(about.y()), number(about.z())};
  }
  return json;
}

Json target(const TargetSighting& sighting) {
  const bool is_sphere = sighting.target.kind == TargetKind::kSphere, found = sighting.found;
  return {{"id", sighting.target.id},
          {"kind", is_sphere ? "sphere" : "point"},
          {"diameter_mm", number_or_null(sighting.target.diameter_mm, is_sphere)},
          {"robot_mm", vector3(sighting.target.place_mm)},
          {"robot_sd_mm", number(sighting.target.sd_mm)},
          {"found", found},
          {"scan_mm", found ? vector3(sighting.scan_mm) : Json(nullptr)},
          {"scan_sd_mm", number_or_null(sighting.sd_mm, found)},
          {"points", sighting.points},
          {"residual_mm", number_or_null(sighting.residual_mm, found)},
          {"over_limit", sighting.over_limit}};
}

Json edge_offset(const EdgeOffset& offset) {
  const auto known = [&](const Json& value) { return offset.calibrated ? value : Json(nullptr); };
  return {{"calibrated", offset.calibrated},
          {"out_mm", number(offset.edge.out_mm)},
          {"sd_mm", number(offset.edge.sd_mm)},
          {"date", known(offset.date)},
          {"scanner", known(offset.scanner)},
          {"serial", known(offset.serial)},
          {"spacing_mm", known(number(offset.spacing_mm))}};
}

/// The scanner's frame from fixture targets; null without such a cell.
Json cell(const RunRecord& record) {
  if (!record.frame) return nullptr;
  const TargetFrame& frame = *record.frame;
  Json json;
  json["scan_reference"] = "targets";
  json["solved"] = frame.usable();
  json["reasons"] = frame.reasons;
  json["max_residual_mm"] = number(record.frame_max_residual_mm);
  json["targets"] = Json::array();
  for (const TargetSighting& sighting : frame.targets) json["targets"].push_back(target(sighting));
  json["not_in_the_list"] = frame.extra;
  json["robot_from_scan"] = frame.usable() ? matrix(frame.robot_from_scan) : Json(nullptr);
  json["covariance_6x6"] = Json(nullptr);
  json["pivot_robot_mm"] = frame.usable() ? vector3(frame.pivot_mm) : Json(nullptr);
  if (frame.usable()) {
    json["covariance_6x6"] = Json::array();
    for (int i = 0; i < 36; ++i) json["covariance_6x6"].push_back(six_digits(frame.covariance(i / 6, i % 6)));
  }
  json["row_sd_robot_mm"] = Json::array();
  for (const RowUncertainty& row : record.robot_sd)
    json["row_sd_robot_mm"].push_back({{"normal", number(row.normal_mm)},
                                       {"across", number(row.across_mm)},
                                       {"along", number(row.along_mm)},
                                       {"frame", number(row.frame_mm)}});
  return json;
}

Json bending(const RunRecord::ProjectionSummary::Bending& b) {
  // a curvature is far below the 1e-6 that numbers are rounded to: its radius says the same
  return {{"radius_mm", number(0.5 / b.alpha_per_mm)},
          {"radius_sd_mm", number(0.5 * b.alpha_sd_per_mm / (b.alpha_per_mm * b.alpha_per_mm))},
          {"axis_point_cad_mm", vector3(b.axis_point_mm)},
          {"axis_cad", vector3(b.axis)},
          {"axis_sd_rad", number(b.axis_sd_rad)}};
}

Json projection(const RunRecord::ProjectionSummary& p) {
  return {{"contour", p.contour},
          {"model", p.model},
          {"points", p.points},
          {"height_left_rms_mm", number_or_null(p.height_rms_mm, std::isfinite(p.height_rms_mm))},
          {"height_left_max_mm", number_or_null(p.height_max_mm, std::isfinite(p.height_max_mm))},
          {"across_left_rms_mm", number(p.across_rms_mm)},
          {"across_left_max_mm", number(p.across_max_mm)},
          {"scatter_mm", number(p.scatter_mm)},
          {"bending", p.bending ? bending(*p.bending) : Json(nullptr)}};
}

Json refinement(const RefinementSummary& summary) {
  if (!summary.asked) return nullptr;
  Json json = {{"used", summary.used}, {"statement", summary.statement}};
  for (const char* list : {"rounds", "segments", "seams"}) json[list] = Json::array();
  for (const auto& r : summary.rounds)
    json["rounds"].push_back({{"scale_sigmas", number(r.scale_sigmas)},
                              {"cost_before", number(r.cost_before)},
                              {"cost_after", number(r.cost_after)},
                              {"iterations", r.iterations},
                              {"termination", r.termination},
                              {"move_mm", number(r.move_mm)}});
  for (const auto& s : summary.segments)
    json["segments"].push_back({{"contour", s.contour},
                                {"from_mm", number(s.from_mm)},
                                {"to_mm", number(s.to_mm)},
                                {"pairs", s.pairs},
                                {"rms_before_mm", number(s.rms_before_mm)},
                                {"rms_after_mm", number(s.rms_after_mm)}});
  for (const auto& s : summary.seams)
    json["seams"].push_back({{"contour", s.contour},
                             {"arc_mm", number(s.arc_mm)},
                             {"jump_before_mm", number(s.jump_before_mm)},
                             {"jump_after_mm", number(s.jump_after_mm)},
                             {"turn_before_rad", number(s.turn_before_rad)},
                             {"turn_after_rad", number(s.turn_after_rad)}});
  return json;
}

Json registration(const RunRecord& record) {
  Json json;
  json["method"] = record.method;
  json["mean_strain_ratio"] = number(record.mean_strain_ratio);
  json["mean_strain_at"] = record.strain_at_mid ? "mid-surface" : "scanned face";
  json["face_strain_ratio"] = number(record.face_strain_ratio);
  json["strain_limit_ratio"] = number(record.strain_limit_ratio);
  json["release_warning"] = permanence_warning(record);
  json["stage_residual_rms_mm"] = Json::array();
  for (const auto& [stage, rms_mm] : record.stage_residual_mm)
    json["stage_residual_rms_mm"].push_back({{"stage", stage}, {"rms_mm", number(rms_mm)}});
  json["segments"] = Json::array();
  for (const auto& s : record.segments)
    json["segments"].push_back({{"contour", s.contour},
                                {"from_mm", number(s.from_mm)},
                                {"to_mm", number(s.to_mm)},
                                {"rms_mm", number(s.rms_mm)},
                                {"iterations", s.iterations},
                                {"pairs", s.pairs},
                                {"source", s.from_data ? "data" : "prior"},
                                {"stop", s.stop}});
  json["projection"] = Json::array();
  for (const auto& p : record.projection) json["projection"].push_back(projection(p));
  json["refinement"] = refinement(record.refinement);
  return json;
}

Json statistics(const DeviationStatistics& s, double tolerance_mm) {
  const bool some = s.count > 0, judged = some && tolerance_mm > 0.0;
  return {{"count", s.count},
          {"min_mm", number_or_null(s.min_mm, some)},
          {"max_mm", number_or_null(s.max_mm, some)},
          {"mean_mm", number_or_null(s.mean_mm, some)},
          {"rms_mm", number_or_null(s.rms_mm, some)},
          {"sigma_mm", number_or_null(s.sigma_mm, some)},
          {"median_mm", number_or_null(s.median_mm, some)},
          {"p05_mm", number_or_null(s.p05_mm, some)},
          {"p95_mm", number_or_null(s.p95_mm, some)},
          {"in_tolerance_ratio", number_or_null(s.in_tolerance_ratio, judged)},
          {"over_ratio", number_or_null(s.over_ratio, judged)},
          {"under_ratio", number_or_null(s.under_ratio, judged)}};
}

Json judged(const Judged& j) {
  return {{"verdict", verdict_word(j.verdict)},
          {"profile_value_mm", number(j.value_mm)},
          {"tolerance_mm", number_or_null(j.tolerance_mm, j.tolerance_mm > 0.0)},
          {"uncertainty_mm", number_or_null(j.uncertainty_mm, j.uncertainty_stated)},
          {"text", j.text}};
}

Json path(const RunRecord& record) {
  const PathSummary s = path_summary(record);
  return {{"points", s.points},
          {"polylines", s.polylines},
          {"from_data", s.from_data},
          {"from_prior", s.from_prior},
          {"air_moves", s.air_moves},
          {"max_shift_mm", number(s.max_shift_mm)},
          {"max_shift_row", s.max_shift_row == 0 ? Json(nullptr) : Json(s.max_shift_row)},
          {"mean_shift_mm", number(s.mean_shift_mm)},
          {"max_tilt_deg", number(degrees(s.max_tilt_rad))},
          {"max_sd_normal_mm", number(s.max_sd_normal_mm)},
          {"max_sd_across_mm", number(s.max_sd_across_mm)},
          {"limit_shift_mm", number(record.max_correction_mm)}};
}

Json results(const RunRecord& record) {
  Json json;
  json["i_correction"] = {{"verdict", correction_word(record)},
                          {"reasons", record.refusals},
                          {"path", record.has_toolpath ? path(record) : Json(nullptr)}};
  json["ii_shape_as_scanned"] = {{"judged", judged(record.judged_as_scanned)},
                                 {"deviation", statistics(record.as_scanned, record.surface_profile_mm)}};
  json["iii_contour_pulled_back"] = {
      {"judged", judged(record.judged_pulled_back)},
      {"deviation", statistics(record.pulled_back, record.contour_profile_mm)}};
  return json;
}

Json error_row(const ErrorSummary& s) {
  const bool some = s.count > 0;
  return {{"count", s.count},
          {"mean_mm", number_or_null(s.mean_mm, some)},
          {"rms_mm", number_or_null(s.rms_mm, some)},
          {"p95_mm", number_or_null(s.p95_mm, some)},
          {"max_mm", number_or_null(s.max_mm, some)}};
}

Json error_summary_json(std::span<const ContourError> errors) {
  const ContourErrorSummary s = contour_error_summary(errors);
  return {{"points", s.points},
          {"before_rigid", error_row(s.rigid)},
          {"after", error_row(s.after)},
          {"after_across", error_row(s.across)},
          {"after_normal", error_row(s.normal)}};
}

Json contour_errors(const RunRecord& record) {
  Json json;
  json["summary"] = error_summary_json(record.contour_errors);
  json["contours"] = Json::array();
  for (const ContourError& error : record.contour_errors)
    json["contours"].push_back({{"contour", error.contour},
                                {"summary", error_summary_json({&error, 1})},
                                {"arc_mm", numbers(error.arc_mm)},
                                {"before_rigid_mm", numbers(error.rigid_mm)},
                                {"after_across_mm", numbers(error.across_mm)},
                                {"after_normal_mm", numbers(error.normal_mm)}});
  return json;
}

Json worst(const RunRecord& record) {
  Json array = Json::array();
  const bool has_zone = record.surface_profile_mm > 0.0;
  for (const WorstPoint& p : worst_points(record)) {
    Json row;
    row["id"] = p.id;
    row["deviation_mm"] = number(p.deviation_mm);
    row["in_tolerance"] = has_zone ? Json(p.in_tolerance) : Json(nullptr);
    row["scan_mm"] = vector3(p.p_scan_mm);
    row["actual_cad_frame_mm"] = vector3(p.p_cad_mm);
    row["nominal_cad_frame_mm"] = p.has_nominal ? vector3(p.nominal_cad_mm) : Json(nullptr);
    array.push_back(row);
  }
  return array;
}

Json colour_scale(const RunRecord& record) {
  const ColourMap map = colour_map_for(record.deviation_mm, record.surface_profile_mm);
  Json steps = Json::array();
  for (const ColourStep& step : map.steps())
    steps.push_back(
        {{"from_mm", number(step.from_mm)}, {"to_mm", number(step.to_mm)}, {"colour", to_hex(step.colour)}});
  return {{"steps", steps},
          {"over_scale", to_hex(ColourMap::over_scale())},
          {"under_scale", to_hex(ColourMap::under_scale())},
          {"no_data", to_hex(ColourMap::no_data())}};
}

}  // namespace

std::string write_json(const RunRecord& record) {
  Json json;
  json["schema"] = "arris.result/1";
  json["version"] = record.version;
  json["result_hash"] = record.result_hash;
  json["report_time"] = record.report_time;
  json["unit"] = "mm";
  json["part"] = {{"number", record.part_number}, {"state", record.state}, {"contour_role", record.role}};
  json["verdicts"] = {{"correction", correction_word(record)},
                      {"inspection", verdict_word(record.inspection_verdict())},
                      {"exit_code", run_exit_code(record)}};
  json["refusals"] = record.refusals;
  json["inputs"] = inputs(record);
  json["acquisition"] = acquisition(record);
  json["alignment"] = alignment(record);
  json["registration"] = registration(record);
  json["results"] = results(record);
  json["limits"] = {{"edge_limit_mm", number(record.edge_limit_mm)},
                    {"surface_limit_mm", number(record.surface_limit_mm)},
                    {"edge_offset", edge_offset(record.edge_offset)},
                    {"surface_profile_mm", number(record.surface_profile_mm)},
                    {"contour_profile_mm", number(record.contour_profile_mm)},
                    {"max_correction_mm", number(record.max_correction_mm)}};
  json["contour_errors"] = contour_errors(record);
  json["worst_points"] = worst(record);
  json["colour_scale"] = colour_scale(record);
  json["cell"] = cell(record);
  json["program"] = {{"written", record.program_written}, {"note", record.program_note}};
  json["notes"] = record.notes;
  json["definitions"] = Json::object();
  for (const Definition& definition : definitions())
    json["definitions"][definition.name] = definition.meaning;
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace arris::report
