#include "cli/recipe_options.hpp"

#include <cmath>
#include <numbers>

namespace arris {
namespace {

double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

StabilityPoints stability_of(const std::string& word) {
  if (word == "none") return StabilityPoints::kNone;
  return word == "paper" ? StabilityPoints::kPaper : StabilityPoints::kLocal;
}

RegistrationMethod method_of(const std::string& word) {
  if (word == "rigid") return RegistrationMethod::kRigid;
  if (word == "projection") return RegistrationMethod::kProjection;
  return word == "subdivision" ? RegistrationMethod::kSubdivision : RegistrationMethod::kSurface;
}

ProjectionKind projection_of(const std::string& word) {
  if (word == "plane") return ProjectionKind::kPlane;
  return word == "parabola" ? ProjectionKind::kParabola : ProjectionKind::kSpline;
}

RigidMotion motion_from_matrix(const std::string& key, const std::vector<double>& numbers) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    matrix(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = numbers[i];
  const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>();
  const auto refuse = [&](const std::string& found) {
    throw Error(Fault::kRecipe,
                ErrorText{key + " is no rigid motion",
                          {},
                          found,
                          "a rotation (columns of length 1, right-handed) and a translation"});
  };
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() > 1e-9)
    refuse("a last row that is not 0 0 0 1");
  if ((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm() > 1e-3) refuse("a scale or shear");
  if (turn.determinant() < 0.0) refuse("a mirror");
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() = Eigen::Quaterniond(turn).normalized().toRotationMatrix();  // rounded numbers made exact
  motion.translation() = matrix.topRightCorner<3, 1>();
  return motion;
}

}  // namespace

RigidMotion motion_from_numbers(const std::string& key, const std::vector<double>& numbers) {
  if (numbers.size() != 7) return motion_from_matrix(key, numbers);
  const Eigen::Quaterniond turn(numbers[3], numbers[4], numbers[5], numbers[6]);
  if (std::abs(turn.norm() - 1.0) > 1e-3)
    throw Error(Fault::kRecipe, ErrorText{key + " is no rigid motion",
                                          {},
                                          "a quaternion of length " + std::to_string(turn.norm()),
                                          "length 1"});
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() = turn.normalized().toRotationMatrix();
  motion.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return motion;
}

CleanOptions clean_options(const Recipe& recipe, int threads) {
  CleanOptions options;
  options.outlier_sigmas = recipe.scan.outlier_sigmas;
  options.voxel_mm = recipe.scan.voxel_mm;
  options.threads = threads;
  return options;
}

ContourOptions contour_options(const Recipe& recipe, int threads) {
  ContourOptions options;
  options.sharp_edge_rad = radians(recipe.contour.sharp_edge_deg);
  options.angle_gap_rad = radians(recipe.contour.angle_gap_deg);
  options.disc_spacings_ratio = recipe.contour.disc_spacings_ratio;
  options.outsized_edge_ratio = recipe.contour.outsized_edge_ratio;
  options.min_length_mm = recipe.contour.min_length_mm;
  options.threads = threads;
  return options;
}

RegistrationOptions registration_options(const Recipe& recipe, int threads) {
  const Recipe::Subdivision& s = recipe.registration.subdivision;
  RegistrationOptions options;
  options.method = method_of(recipe.registration.method);
  options.role = options.surface.role =
      recipe.contour.role == "edge" ? ContourRole::kEdge : ContourRole::kCut;
  options.surface.stock_mm = recipe.contour.stock_mm;
  options.projection.kind = projection_of(recipe.registration.projection.model);
  options.projection.distance_mm = recipe.registration.projection.distance_mm;
  options.projection.max_residual_mm = recipe.registration.projection.max_residual_mm;
  const bool surface = options.method == RegistrationMethod::kSurface;
  options.min_seen_ratio =
      recipe.registration.min_seen_ratio.value_or(surface ? kSurfaceSeenRatio : kSeenRatio);
  options.max_unseen_mm = recipe.registration.max_unseen_mm.value_or(surface ? kSurfaceUnseenMm : kUnseenMm);
  options.mid_depth_mm = 0.5 * recipe.part.thickness_mm.value_or(0.0);
  options.band_mm = options.coarse.band_mm = options.rigid.band_mm = options.surface.band_mm = s.band_mm;
  options.max_sd_mm = recipe.registration.max_sd_mm;
  options.surface.node_spacing_mm = recipe.registration.surface.node_spacing_mm;
  options.surface.prior.strain_ratio = recipe.registration.surface.strain_ratio;
  options.surface.prior.bend_per_mm = recipe.registration.surface.bend_per_mm;
  options.surface.offset_sd_mm = recipe.registration.surface.offset_sd_mm;
  if (recipe.scan.initial.given) {
    options.coarse.initial_scan_from_cad =
        motion_from_numbers("scan.initial.scan_from_cad", recipe.scan.initial.scan_from_cad);
    options.coarse.within_rad = radians(recipe.scan.initial.within_deg);
  }
  options.subdivision.subdivision.corner_radius_max_mm = s.corner_radius_max_mm;
  options.subdivision.subdivision.segment_length_max_mm = s.segment_length_max_mm;
  options.subdivision.subdivision.overlap_ratio = s.overlap_ratio;
  options.subdivision.match = s.match == "paper" ? SegmentMatch::kPaper : SegmentMatch::kFoot;
  options.subdivision.stability = stability_of(s.stability_points);
  options.subdivision.stability_points = s.stability_count;
  options.subdivision.stability_distance_mm = s.stability_distance_mm;
  options.refine = s.refine == "ceres" ? RefineMethod::kCeres : RefineMethod::kNone;
  options.subdivision.max_iterations = s.max_iterations;
  options.subdivision.stop_change_ratio = s.stop_change_ratio;
  options.threads = options.coarse.threads = options.rigid.threads = options.subdivision.threads =
      options.edge.threads = options.projection.threads = options.surface.threads = threads;
  return options;
}

CorrectOptions correct_options(const Recipe& recipe, int threads) {
  CorrectOptions options;
  options.max_correction_mm = recipe.tolerance.max_correction_mm;
  options.max_tilt_rad = radians(recipe.tolerance.max_tilt_deg);
  options.max_step_ratio = recipe.tolerance.max_step_ratio;
  options.path_reach_mm = recipe.toolpath.path_reach_mm;
  options.far_face_mm = recipe.toolpath.face == "other" ? recipe.part.thickness_mm.value_or(0.0) : 0.0;
  options.threads = threads;
  return options;
}

FromContourOptions from_contour_options(const Recipe& recipe) {
  const Recipe::FromContour& from = recipe.toolpath.from_contour;
  FromContourOptions options;
  options.offset_mm = from.offset_mm;
  options.depth_mm = from.depth_mm;
  options.step_mm = from.step_mm;
  options.chord_error_mm = from.chord_error_mm;
  options.lateral_rad = radians(from.tilt_deg);
  options.lead_rad = radians(from.lead_deg);
  options.seam_mm = from.seam_mm;
  options.reversed = from.reversed;
  options.approach_mm = from.approach_mm;
  options.retract_mm = from.retract_mm;
  options.feed_mm_s = recipe.toolpath.feed_mm_s;
  return options;
}

}  // namespace arris
