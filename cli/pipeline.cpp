#include "cli/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "acquisition/types/error.hpp"
#include "cli/prepare.hpp"
#include "cli/recipe_options.hpp"
#include "cli/register_scan.hpp"
#include "cli/results.hpp"
#include "cli/version.hpp"
#include "registration/deviation.hpp"
#include "toolpath/correct.hpp"

namespace arris {
namespace {

constexpr double kDeviationReachMm = 25.0;
constexpr double kMirrorAlikeRatio = 1.3;  // score of the mirror image over the scan's own

void describe_inputs(const Recipe& recipe, const Drawing& drawing, const Measurement& measurement,
                     RunRecord& record) {
  record.part_number = recipe.part.number;
  record.version = version();
  record.state = recipe.part.state;
  record.role = recipe.contour.role;
  record.method = recipe.registration.method;
  record.surface_profile_mm = recipe.tolerance.surface_profile_mm;
  record.contour_profile_mm = recipe.tolerance.contour_profile_mm;
  record.max_correction_mm = recipe.tolerance.max_correction_mm;
  record.points_nonfinite = measurement.points_nonfinite;
  record.points_outlier = measurement.points_outlier;
  record.points_read = measurement.cloud.size() + measurement.points_nonfinite;
  record.points_used = measurement.prepared.model.points_mm.size();
  record.spacing_mm = measurement.prepared.model.spacing_mm;
  record.noise_sigma_mm = measurement.prepared.model.noise_sigma_mm;
  record.notes = drawing.notes;
  record.face_lines = drawing.face_lines;
  record.notes.insert(record.notes.end(), drawing.face_lines.begin(), drawing.face_lines.end());
  record.notes.insert(record.notes.end(), measurement.notes.begin(), measurement.notes.end());
  record.cloud = measurement.cloud;
  record.cad = drawing.mesh;
  record.cad_contours = drawing.accepted;
  record.nominal_path = drawing.path;
  record.frame = measurement.frame;
  if (const std::optional<EdgeFile>& known = measurement.edge)
    record.edge_offset = {true, known->edge, known->spacing_mm, known->date, known->scanner, known->serial};
}

/// Polyline by polyline, the tool's axes as normals.
std::vector<Contour> polylines_of(const ToolPath& path) {
  std::vector<Contour> lines;
  for (const PathRange& range : polylines(path)) {
    Contour& line = lines.emplace_back();
    line.closed = range.closed;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      line.points_mm.push_back(path.points[i].tip_mm);
      line.normals.push_back(path.points[i].axis);
    }
  }
  return lines;
}

/// The recipe's, with the tool path and what is known of the scanner.
RegistrationOptions options_of(const Recipe& recipe, const ToolPath& path, const Measurement& measurement,
                               int threads) {
  RegistrationOptions options = registration_options(recipe, threads);
  options.coarse.path = polylines_of(path);
  if (measurement.edge) options.edge.scanner = options.surface.scanner = measurement.edge->edge;
  return options;
}

void describe_alignment(const Registration& found, const Measurement& measurement,
                        AlignmentSummary& alignment) {
  alignment.scan_from_cad = found.rigid.scan_from_cad;
  if (!found.usable()) alignment.scan_from_cad = found.coarse.scan_from_cad;
  alignment.scan_from_cad.pretranslate(measurement.cloud.offset_mm);
  alignment.rms_mm = found.rigid.surface_rms_mm;
  alignment.pairs = found.rigid.pairs;
  alignment.runner_up_ratio = found.coarse.runner_up_ratio;
  alignment.equal_poses = found.coarse.equal_poses;
  alignment.start = found.coarse.start;
  alignment.side_decided_by = measurement.prepared.side_decided_by;
  if (alignment.side_decided_by.empty())
    alignment.side_decided_by = found.coarse.start == "initial pose" ? "initial pose" : "nothing";
  alignment.free_directions = found.free_directions;
  alignment.overlap_ratio = found.seen_ratio;
  if (found.usable() && !found.rigid.covariance.isZero()) {
    const double* first = found.rigid.covariance.data();  // symmetric: columns are rows
    alignment.covariance_6x6.assign(first, first + 36);
    alignment.covariance_about_mm = found.rigid.pivot_mm;
  }
}

void describe_segments(const CadModel& cad, const Registration& found, RunRecord& record) {
  for (std::size_t c = 0; c < found.contours.size(); ++c) {
    const ContourMotion& motion = found.contours[c].motion;
    for (std::size_t z = 0; z < motion.fits().size(); ++z) {
      const Segment& segment = motion.subdivision().segments()[z];
      const SegmentFit& fit = motion.fits()[z];
      record.segments.push_back({cad.contours[c].contour().id, segment.begin_mm, segment.end_mm, fit.rms_mm,
                                 fit.iterations, fit.pairs, fit.from_data, fit.stop});
    }
  }
}

void describe_projection(const CadModel& cad, const Registration& found, const std::string& model,
                         RunRecord& record) {
  for (std::size_t c = 0; c < found.projection.size(); ++c) {
    const ContourProjection& projection = found.projection[c];
    if (!projection.fit.usable()) continue;
    const ProjectionResidual& left = projection.residual;
    const bool is_measure = std::holds_alternative<HeightSpline>(projection.fit.model);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    RunRecord::ProjectionSummary summary;
    summary.contour = cad.contours[c].contour().id;
    summary.model = model;
    summary.points = projection.fit.points;
    summary.height_rms_mm = is_measure ? kNone : left.height_rms_mm;
    summary.height_max_mm = is_measure ? kNone : left.height_max_mm;
    summary.across_rms_mm = left.across_rms_mm;
    summary.across_max_mm = left.across_max_mm;
    summary.scatter_mm = projection.edge.residual_sigma_mm;
    const auto* parabola = std::get_if<BentParabola>(&projection.fit.model);
    if (parabola != nullptr && parabola->axis_known())
      summary.bending = {parabola->alpha_per_mm, parabola->alpha_sd_per_mm, parabola->axis_sd_rad,
                         parabola->axis_point_mm(), parabola->along_axis};
    record.projection.push_back(summary);
  }
}

void describe_strain(const Registration& found, const Drawing& drawing, RunRecord& record) {
  record.mean_strain_ratio = found.mean_strain_ratio;
  record.face_strain_ratio = found.face_strain_ratio;
  record.strain_limit_ratio = found.strain_limit_ratio;
  record.strain_at_mid = drawing.thickness_mm.has_value();
}

void describe_refinement(const CadModel& cad, const SegmentRefinement& found, RunRecord& record) {
  RefinementSummary& told = record.refinement;
  told.asked = found.asked;
  told.used = found.usable();
  told.statement = found.statement();
  if (found.asked && !found.usable()) record.notes.push_back(found.reason);
  for (const RefineRound& r : found.rounds)
    told.rounds.push_back({r.scale_sigmas, r.solver.cost_before, r.solver.cost_after, r.solver.iterations,
                           r.solver.termination, r.move_mm});
  for (const RefinedSegment& s : found.segments) {
    const Segment& piece = found.motions[s.contour].subdivision().segments()[s.segment];
    told.segments.push_back({cad.contours[s.contour].contour().id, piece.begin_mm, piece.end_mm, s.pairs,
                             s.rms_before_mm, s.rms_after_mm});
  }
  for (const RefinedSeam& s : found.seams)
    told.seams.push_back({cad.contours[s.contour].contour().id, s.before.arc_mm, s.before.jump_mm,
                          s.after.jump_mm, s.before.turn_rad, s.after.turn_rad});
}

/// Scan loops that run along an accepted contour, and those that were left out.
void describe_loops(const Registration& found, const ScanModel& scan, RunRecord& record) {
  for (std::size_t l = 0; l < scan.loops.size(); ++l) {
    const bool used = l < found.loops.size() && found.loops[l].contour >= 0;
    (used ? record.found_contours : record.dropped_contours).push_back(scan.loops[l]);
  }
}

}  // namespace

Processed process(const Recipe& as_written, const Drawing& drawing, Measurement& measurement,
                  bool inspect_only, int threads, const StageHook& stage) {
  Recipe recipe = as_written;
  recipe.part.thickness_mm = drawing.thickness_mm;  // a solid says it itself
  Processed processed;
  RunRecord& record = processed.record;
  record.has_toolpath = !inspect_only;
  describe_inputs(recipe, drawing, measurement, record);

  stage("aligning");
  const CadModel cad = prepare_cad(drawing.mesh, drawing.accepted, drawing.others, threads);
  ScanModel& scan = measurement.prepared.model;
  const Registration found =
      register_scan(recipe, cad, measurement, options_of(recipe, drawing.path, measurement, threads));
  record.refusals = found.refusals;
  if (found.coarse.mirror_ratio > 0.0 && found.coarse.mirror_ratio < kMirrorAlikeRatio)
    record.notes.push_back(
        "the part is nearly its own mirror image: a scan that was exported mirrored would not be noticed");
  if (found.coarse.usable() && found.coarse.equal_poses > 1)
    record.notes.push_back(std::to_string(found.coarse.equal_poses) +
                           " poses fit alike, and each lays the whole tool path on itself: the path is the "
                           "same for all of them, the row at which it begins is not told apart");
  describe_alignment(found, measurement, record.alignment);
  describe_loops(found, scan, record);
  if (!found.usable()) return processed;
  record.stage_residual_mm = found.stage_residual_mm;
  describe_strain(found, drawing, record);
  if (record.method == "subdivision") describe_segments(cad, found, record);
  describe_projection(cad, found, recipe.registration.projection.model, record);
  describe_refinement(cad, found.refinement, record);
  processed.field_parameters = found.field->parameters();

  if (!inspect_only) {
    stage("correcting the path");
    record.correction = correct(drawing.path, cad.surface, *found.field, found.rigid.scan_from_cad,
                                correct_options(recipe, threads));
    record.refusals.insert(record.refusals.end(), record.correction.reasons.begin(),
                           record.correction.reasons.end());
    record.notes.insert(record.notes.end(), record.correction.notes.begin(), record.correction.notes.end());
    if (record.accepted() && record.frame && record.frame->usable())
      record.robot_sd = row_uncertainty(record.correction, measurement.cloud.offset_mm, *record.frame);
  }
  stage("measuring deviations");
  record.deviation_mm = signed_deviation_mm(cad.surface, found.rigid.scan_from_cad,
                                            measurement.cloud.points_mm, kDeviationReachMm, threads);
  for (std::size_t i = 0; i < record.deviation_mm.size(); ++i)
    if (!measurement.kept[i]) record.deviation_mm[i] = std::numeric_limits<float>::quiet_NaN();
  judge_results(cad, found, record);
  return processed;
}

}  // namespace arris
