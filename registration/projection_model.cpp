#include "registration/projection_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/geometry/median.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"
#include "registration/normal_equations.hpp"

namespace arris {
namespace {

constexpr double kCosAgree = 0.5;  // normals within 60 degrees
constexpr std::size_t kLeastSamples = 30;
constexpr std::size_t kChunk = 512;
constexpr int kRounds = 20;           // of reweighting
constexpr double kScaleSigmas = 5.0;  // of the robust weight: wide, for the misfit of a model is no stray
constexpr double kLeastSigmaMm = 1e-4, kSigmaOfMedian = 1.4826;
constexpr int kDirections = 180;
constexpr int kRefinements = 60;
constexpr double kAlphaSigmas = 5.0, kAxisKnownRad = 0.2, kRunnerUpRatio = 1.5;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

SurfaceHeight in_surface(double height_mm, const Eigen::Vector3d& gradient, const SurfacePlace& place) {
  return {height_mm, gradient - gradient.dot(place.normal) * place.normal};
}

double robust_scale_mm(std::vector<double> sizes) {
  return kScaleSigmas * std::max(kSigmaOfMedian * median_of(std::move(sizes)), kLeastSigmaMm);
}

/// Weights of the next round from the residuals of this one.
template <class Residual>
std::vector<double> reweighted(std::span<const HeightSample> samples, const Residual& residual_mm) {
  std::vector<double> residuals, sizes;
  for (const HeightSample& sample : samples) {
    residuals.push_back(residual_mm(sample));
    sizes.push_back(std::abs(residuals.back()));
  }
  const double scale_mm = robust_scale_mm(std::move(sizes));
  for (double& r : residuals) r = geman_mcclure_weight(r * r, scale_mm);
  return residuals;
}

std::string too_few(std::size_t samples) {
  return std::to_string(samples) + " scan points beside it, " + std::to_string(kLeastSamples) + " needed";
}

/// The contour's centre and mean normal.
struct BasePlane {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
};
BasePlane base_plane(const Curve& contour) {
  BasePlane plane;
  const Contour even = resample(contour.contour(), contour.length_mm() / 200.0);
  for (std::size_t i = 0; i < even.points_mm.size(); ++i) {
    plane.centre_mm += even.points_mm[i] / static_cast<double>(even.points_mm.size());
    plane.normal += even.normals[i];
  }
  plane.normal.normalize();
  return plane;
}
/// Cosine of the contour's normal that turns farthest from a direction.
double least_cosine(const Curve& contour, const Eigen::Vector3d& normal) {
  double least = 1.0;
  for (const Eigen::Vector3d& n : contour.contour().normals) least = std::min(least, n.dot(normal));
  return least;
}

Eigen::Vector3d any_direction_in(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d guide =
      std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  return (guide - guide.dot(normal) * normal).normalized();
}

/// Least squares of 1, x, y, x^2, xy, y^2, from which each direction's parabola follows.
class Quadric {
 public:
  void add(double x, double y, double height, double weight) {
    Vector6 row;
    row << 1.0, x, y, x * x, x * y, y * y;
    information_.noalias() += weight * row * row.transpose();
    right_ += weight * height * row;
    squares_ += weight * height * height;
    weight_ += weight;
  }

  /// The best 1, v, w, w^2 for w across an axis at this angle from y, v along it.
  struct Profile {
    Eigen::Vector4d coefficients;
    double cost = 0.0;            // weighted squares left
    double alpha_variance = 0.0;  // for a residual of variance 1
  };
  Profile at(double angle_rad) const {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    Eigen::Matrix<double, 6, 4> basis = Eigen::Matrix<double, 6, 4>::Zero();
    basis(0, 0) = 1.0;
    basis(1, 1) = -s, basis(2, 1) = c;
    basis(1, 2) = c, basis(2, 2) = s;
    basis(3, 3) = c * c, basis(4, 3) = 2.0 * c * s, basis(5, 3) = s * s;
    const Eigen::Matrix4d information = basis.transpose() * information_ * basis;
    const Eigen::Vector4d right = basis.transpose() * right_;
    const Eigen::LDLT<Eigen::Matrix4d> solver(information);
    Profile profile;
    profile.coefficients = solver.solve(right);
    profile.cost = squares_ - profile.coefficients.dot(right);
    profile.alpha_variance = solver.solve(Eigen::Vector4d::Unit(3))[3];
    return profile;
  }

  /// The direction that leaves least: best of a grid, then golden section. In [-step, pi).
  double best_angle_rad() const {
    constexpr double kStep = std::numbers::pi / kDirections;
    int best = 0;
    double least = at(0.0).cost;
    for (int i = 1; i < kDirections; ++i) {
      const double cost = at(i * kStep).cost;
      if (cost < least) least = cost, best = i;
    }
    double low = (best - 1) * kStep, high = (best + 1) * kStep;
    for (int i = 0; i < kRefinements; ++i) {
      const double third = (high - low) * (2.0 - std::numbers::phi);
      if (at(low + third).cost <= at(high - third).cost)
        high -= third;
      else
        low += third;
    }
    return 0.5 * (low + high);
  }

  /// What the best direction more than 45 degrees from this one leaves.
  double least_cost_across(double angle_rad) const {
    double least = squares_;
    for (int i = kDirections / 4; i <= kDirections - kDirections / 4; ++i)
      least = std::min(least, at(angle_rad + i * std::numbers::pi / kDirections).cost);
    return least;
  }

  double variance(double cost) const { return std::max(0.0, cost) / std::max(1e-12, weight_); }
  /// Standard deviation of the direction, from how fast the cost rises beside it.
  double angle_sd_rad(double angle_rad) const {
    constexpr double kStep = 0.02;
    const double least = at(angle_rad).cost;
    const double bend =
        (at(angle_rad + kStep).cost - 2.0 * least + at(angle_rad - kStep).cost) / (kStep * kStep);
    if (!(bend > 0.0)) return std::numbers::pi;
    return std::min(std::numbers::pi, std::sqrt(2.0 * variance(least) / bend));
  }

 private:
  Matrix6 information_ = Matrix6::Zero();
  Vector6 right_ = Vector6::Zero();
  double squares_ = 0.0, weight_ = 0.0;
};

/// Best parabola of weighted samples; lengths in the plane are scaled by size_mm to keep the squares even.
BentParabola weighted_parabola(const BasePlane& plane, double size_mm, std::span<const HeightSample> samples,
                               std::span<const double> weights) {
  const Eigen::Vector3d x_axis = any_direction_in(plane.normal), y_axis = plane.normal.cross(x_axis);
  Quadric quadric;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d d = (samples[i].foot_mm - plane.centre_mm) / size_mm;
    quadric.add(d.dot(x_axis), d.dot(y_axis), samples[i].height_mm, weights[i]);
  }
  const double angle_rad = quadric.best_angle_rad();
  const Quadric::Profile profile = quadric.at(angle_rad);
  BentParabola found;
  found.centre_mm = plane.centre_mm;
  found.across_axis = std::cos(angle_rad) * x_axis + std::sin(angle_rad) * y_axis;
  found.along_axis = plane.normal.cross(found.across_axis);
  found.offset_mm = profile.coefficients[0];
  found.lean = profile.coefficients[1] / size_mm;
  found.rise = profile.coefficients[2] / size_mm;
  found.alpha_per_mm = profile.coefficients[3] / (size_mm * size_mm);
  found.alpha_sd_per_mm =
      std::sqrt(quadric.variance(profile.cost) * profile.alpha_variance) / (size_mm * size_mm);
  found.axis_sd_rad = quadric.angle_sd_rad(angle_rad);
  found.runner_up_ratio = quadric.least_cost_across(angle_rad) / std::max(1e-12, profile.cost);
  return found;
}

/// Weighted total least squares; the normal on the side of `up`.
FlatTarget weighted_plane(std::span<const HeightSample> samples, std::span<const double> weights,
                          const Eigen::Vector3d& up) {
  const auto scanned = [](const HeightSample& s) -> Eigen::Vector3d {
    return s.foot_mm + s.height_mm * s.normal;
  };
  FlatTarget plane;
  double sum = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    plane.point_mm += weights[i] * scanned(samples[i]);
    sum += weights[i];
  }
  plane.point_mm /= sum;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d d = scanned(samples[i]) - plane.point_mm;
    spread.noalias() += weights[i] * d * d.transpose();
  }
  plane.normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  if (plane.normal.dot(up) < 0.0) plane.normal = -plane.normal;
  return plane;
}

}  // namespace

std::string word_of(ProjectionKind kind) {
  if (kind == ProjectionKind::kPlane) return "plane";
  return kind == ProjectionKind::kParabola ? "parabola" : "spline";
}

void ProjectionOptions::check() const {
  const auto refuse = [](const char* field, double found) {
    throw Error(Fault::kRecipe, {.what = std::string("registration.projection.") + field + " is out of range",
                                 .found = std::to_string(found),
                                 .needed = "a length above 0"});
  };
  if (!(distance_mm > 0.0)) refuse("distance_mm", distance_mm);
  if (!(max_residual_mm > 0.0)) refuse("max_residual_mm", max_residual_mm);
}

std::vector<HeightSample> measured_heights(const CadModel& cad, std::size_t contour, const ScanModel& scan,
                                           const RigidMotion& scan_from_cad, double distance_mm,
                                           int threads) {
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  std::vector<HeightSample> all(scan.points_mm.size());
  std::vector<char> taken(scan.points_mm.size(), 0);
  parallel_for(all.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d x = cad_from_scan * scan.points_mm[i];
      const SurfacePoint foot = cad.surface.closest(x, distance_mm);
      if (foot.triangle < 0 || foot.on_border) continue;
      if (foot.normal.dot(cad_from_scan.linear() * scan.normals[i]) < kCosAgree) continue;
      if (cad.contours[contour].nearest(foot.foot_mm).distance_mm > distance_mm) continue;
      all[i] = {foot.foot_mm, foot.normal, foot.normal.dot(x - foot.foot_mm)};
      taken[i] = 1;
    }
  });
  std::vector<HeightSample> samples;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (taken[i]) samples.push_back(all[i]);
  return samples;
}

SurfaceHeight FlatTarget::at(const SurfacePlace& place) const {
  const double facing = normal.dot(place.normal);
  return in_surface(normal.dot(point_mm - place.p_mm) / facing, -normal / facing, place);
}

SurfaceHeight BentParabola::at(const SurfacePlace& place) const {
  const double w_mm = across_axis.dot(place.p_mm - centre_mm), v_mm = along_axis.dot(place.p_mm - centre_mm);
  return in_surface(offset_mm + lean * v_mm + (rise + alpha_per_mm * w_mm) * w_mm,
                    lean * along_axis + (rise + 2.0 * alpha_per_mm * w_mm) * across_axis, place);
}

bool BentParabola::axis_known() const {
  return std::abs(alpha_per_mm) > kAlphaSigmas * alpha_sd_per_mm && axis_sd_rad < kAxisKnownRad &&
         runner_up_ratio > kRunnerUpRatio;
}

Eigen::Vector3d BentParabola::axis_point_mm() const {
  return centre_mm - rise / (2.0 * alpha_per_mm) * across_axis;
}

SurfaceHeight HeightSpline::at(const SurfacePlace& place) const {
  const SplineRow value = spline.at(place.arc_mm), slope = spline.slope_at(place.arc_mm);
  const double tilt = value.dot(tilt_rad);
  const double along = slope.dot(height_mm) + slope.dot(tilt_rad) * place.across_mm;
  return {value.dot(height_mm) + tilt * place.across_mm, along * place.tangent + tilt * place.inward};
}

SurfaceHeight height_at(const ProjectionModel& model, const SurfacePlace& place) {
  return std::visit([&](const auto& one) { return one.at(place); }, model);
}

ProjectionFit fit_flat_target(const Curve& contour, std::span<const HeightSample> samples) {
  ProjectionFit fit;
  fit.points = samples.size();
  if (samples.size() < kLeastSamples) {
    fit.reason = too_few(samples.size());
    return fit;
  }
  const Eigen::Vector3d up = base_plane(contour).normal;
  std::vector<double> weights(samples.size(), 1.0);
  FlatTarget plane;
  for (int round = 0; round < kRounds; ++round) {
    plane = weighted_plane(samples, weights, up);
    weights = reweighted(samples, [&](const HeightSample& s) {
      return plane.normal.dot(s.foot_mm + s.height_mm * s.normal - plane.point_mm);
    });
  }
  if (least_cosine(contour, plane.normal) < kCosAgree)
    fit.reason = "the drawing's face turns more than 60 degrees from the plane of the scan";
  fit.model = plane;
  return fit;
}

ProjectionFit fit_bent_parabola(const Curve& contour, std::span<const HeightSample> samples) {
  ProjectionFit fit;
  fit.points = samples.size();
  const BasePlane plane = base_plane(contour);
  if (samples.size() < kLeastSamples) fit.reason = too_few(samples.size());
  if (least_cosine(contour, plane.normal) < kCosAgree)
    fit.reason = "its face turns more than 60 degrees along it, so no plane can hold a bending axis";
  if (!fit.usable()) return fit;
  double size_mm = 1.0;
  for (const HeightSample& s : samples) size_mm = std::max(size_mm, (s.foot_mm - plane.centre_mm).norm());
  std::vector<double> weights(samples.size(), 1.0);
  BentParabola parabola;
  for (int round = 0; round < kRounds; ++round) {
    parabola = weighted_parabola(plane, size_mm, samples, weights);
    weights = reweighted(samples, [&](const HeightSample& s) {
      SurfacePlace place;
      place.p_mm = s.foot_mm;
      place.normal = s.normal;
      return s.height_mm - parabola.at(place).mm;
    });
  }
  fit.model = parabola;
  return fit;
}

ProjectionFit height_spline_of(const EdgeFit& edge) {
  ProjectionFit fit;
  fit.points = edge.points;
  if (edge.points < kLeastSamples) fit.reason = too_few(edge.points);
  fit.model = HeightSpline{edge.spline, edge.height, edge.tilt};
  return fit;
}

}  // namespace arris
