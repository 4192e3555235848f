#include "registration/projection_field.hpp"

#include <gtest/gtest.h>

#include "registration/registration.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using synthetic::PlatePart;
using synthetic::PlateShape;

constexpr double kBandMm = 60.0, kAlphaPerMm = 4e-4;

PlateShape raised(double across_per_mm, double along_per_mm) {
  PlateShape out = synthetic::plate_with_rounded_rectangle();
  out.raise_across_per_mm = across_per_mm;
  out.raise_along_per_mm = along_per_mm;
  out.raise_axis_rad = 0.7;
  out.raise_axis_mm = 20.0;
  return out;
}

/// A plate scanned at the drawing's own pose, and one contour's projection for a model.
struct Plate {
  explicit Plate(const PlateShape& shape, double noise_mm = 0.05)
      : part(shape),
        cad(scenes::cad_of(part)),
        trial(scenes::ideal_trial(part, {.noise_sigma_mm = noise_mm}, 2)),
        edge(fit_edge(cad, 0, trial.scan, scenes::rigid_along(curve(), RigidMotion::Identity()), loose())) {}
  static EdgeFitOptions loose() {
    EdgeFitOptions options;
    options.bend_normal_per_mm = 1e-3;
    options.tilt_change_rad = 0.1;
    return options;
  }
  const Curve& curve() const { return cad.contours[0]; }
  ContourProjection projection(ProjectionKind kind) const {
    return project_contour(cad, 0, trial.scan, RigidMotion::Identity(), edge, {.kind = kind});
  }
  ProjectionField field(ProjectionKind kind, const RigidMotion& pose = RigidMotion::Identity()) const {
    return {cad, pose, {projection(kind)}, kBandMm};
  }
  /// Greatest distance from the truth over the contour, material point by material point.
  double worst_mm(const ProjectionField& field) const {
    double worst = 0.0;
    for (const synthetic::EdgePoint& p : part.edge(0, 3.0))
      worst = std::max(worst, (field.map(p.nominal_mm).p_scan_mm - p.true_mm).norm());
    return worst;
  }
  PlatePart part;
  CadModel cad;
  scenes::Trial trial;
  EdgeFit edge;
};

TEST(ProjectionField, ParabolaIsExactOnAPlateBentAsOne) {
  const Plate plate(raised(kAlphaPerMm, 0.0), 0.0);
  const ProjectionField field = plate.field(ProjectionKind::kParabola);
  EXPECT_LT(plate.worst_mm(field), 1e-6);
  for (const synthetic::EdgePoint& p : plate.part.edge(0, 3.0))
    EXPECT_LT((field.map(p.nominal_mm).rotation_scan_from_cad * p.nominal_normal - p.true_normal).norm(),
              1e-8);
}

TEST(ProjectionField, CarriesTheRegisteredDrawingAlongItsNormal) {
  const Plate plate(raised(kAlphaPerMm, 0.0), 0.0);
  synthetic::Random random(3);
  const RigidMotion pose = scenes::disturbance(random, {0, 0, 0}, 1.2, 200.0);
  const ProjectionField here = plate.field(ProjectionKind::kParabola),
                        there = plate.field(ProjectionKind::kParabola, pose);
  for (const synthetic::EdgePoint& p : plate.part.edge(0, 20.0)) {
    const Vector3d moved = there.map(p.nominal_mm).p_scan_mm;
    EXPECT_LT((moved - pose * here.map(p.nominal_mm).p_scan_mm).norm(), 1e-9);
    const Vector3d d = moved - pose * p.nominal_mm;  // along n and nothing else
    EXPECT_LT(d.cross(pose.linear() * p.nominal_normal).norm(), 1e-9);
  }
}

TEST(ProjectionField, EveryModelEqualsRigidOnAnUndeformedPart) {
  const Plate exact(raised(0.0, 0.0), 0.0), noisy(raised(0.0, 0.0), 0.05);
  for (const ProjectionKind kind :
       {ProjectionKind::kPlane, ProjectionKind::kParabola, ProjectionKind::kSpline}) {
    EXPECT_LT(exact.worst_mm(exact.field(kind)), 1e-6) << word_of(kind);
    EXPECT_LT(noisy.worst_mm(noisy.field(kind)), 0.05) << word_of(kind);
  }
}

TEST(ProjectionField, SplineFollowsAHeightThatNoParabolaCan) {
  const Plate saddle(raised(kAlphaPerMm, -kAlphaPerMm));
  const ContourProjection parabola = saddle.projection(ProjectionKind::kParabola),
                          spline = saddle.projection(ProjectionKind::kSpline);
  EXPECT_GT(saddle.worst_mm(saddle.field(ProjectionKind::kParabola)), 1.0);
  EXPECT_LT(saddle.worst_mm(saddle.field(ProjectionKind::kSpline)), 0.25);  // at the corners, within a knot
  EXPECT_GT(parabola.residual.height_rms_mm, 0.5);
  EXPECT_LT(spline.residual.height_rms_mm, 1e-9);
  // and the stated deviation knows: it covers what the parabola is off by
  const ProjectionField field = saddle.field(ProjectionKind::kParabola);
  EXPECT_GT(3.0 * field.map(saddle.curve().point_mm(10.0)).sd_mm[0],
            saddle.worst_mm(saddle.field(ProjectionKind::kParabola)));
}

TEST(ProjectionField, TurnsAreOrthonormalAndKeepTheDistanceFromTheFace) {
  const Plate plate(raised(kAlphaPerMm, 0.5 * kAlphaPerMm));
  for (const ProjectionKind kind :
       {ProjectionKind::kPlane, ProjectionKind::kParabola, ProjectionKind::kSpline}) {
    const ProjectionField field = plate.field(kind);
    for (double s = 0.5; s < plate.curve().length_mm(); s += 9.1) {
      const Vector3d p = plate.curve().point_mm(s) + 3.0 * plate.cad.inward(0, s);
      const MappedPoint at = field.map(p);
      const Eigen::Matrix3d& turn = at.rotation_scan_from_cad;
      EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      EXPECT_NEAR(turn.determinant(), 1.0, 1e-12);
      for (const double up_mm : {-10.0, 5.0, 40.0}) {
        const Vector3d offset = up_mm * Vector3d::UnitZ();
        EXPECT_LT((field.map(p + offset).p_scan_mm - at.p_scan_mm - turn * offset).norm(), 1e-9);
      }
    }
  }
}

TEST(ProjectionField, TurnIsTheSlopeOfTheHeight) {
  const Plate plate(raised(kAlphaPerMm, -kAlphaPerMm));
  for (const ProjectionKind kind : {ProjectionKind::kParabola, ProjectionKind::kSpline}) {
    const ProjectionField field = plate.field(kind);
    for (double s = 20.5; s < plate.curve().length_mm(); s += 31.7) {
      const Vector3d p = plate.curve().point_mm(s), along = plate.curve().tangent(s),
                     across = plate.cad.inward(0, s);
      const auto image = [&](const Vector3d& step) { return field.map(p + step).p_scan_mm; };
      const double h = 1e-3;  // within one chord of the contour
      const Vector3d normal = (image(h * along) - image(-h * along))
                                  .cross(image(2 * h * across) - image(h * across))
                                  .normalized();
      const Vector3d carried = field.map(p).rotation_scan_from_cad * Vector3d::UnitZ();
      EXPECT_LT(std::acos(std::min(1.0, std::abs(normal.dot(carried)))), 2e-3) << word_of(kind) << s;
    }
  }
}

TEST(ProjectionField, SaysNothingBeyondItsBandAndWhatWasNotSeen) {
  Plate plate(raised(kAlphaPerMm, 0.0));
  std::fill(plate.edge.seen.begin(), plate.edge.seen.begin() + 5, 0);
  const ProjectionField field = plate.field(ProjectionKind::kParabola);
  const double gap_mm = 2.5 * plate.edge.bin_mm, seen_mm = 100.0;
  EXPECT_FALSE(field.map(plate.curve().point_mm(gap_mm)).from_data);
  EXPECT_TRUE(field.map(plate.curve().point_mm(seen_mm)).from_data);
  const Vector3d foot = plate.curve().point_mm(seen_mm), inward = plate.cad.inward(0, seen_mm);
  EXPECT_TRUE(field.map(foot + 0.99 * kBandMm * inward).in_domain);
  EXPECT_FALSE(field.map(foot + 1.01 * kBandMm * inward).in_domain);
}

TEST(ProjectionOptions, LengthsAreAboveZero) {
  ProjectionOptions options;
  options.check();
  options.distance_mm = 0.0;
  EXPECT_ANY_THROW(options.check());
  options = {};
  options.max_residual_mm = -1.0;
  EXPECT_ANY_THROW(options.check());
}

/// The whole registration with method projection.
class RegisterByProjection : public testing::Test {
 protected:
  Registration found(const PlateShape& made, const PlateShape& drawn, ProjectionKind kind,
                     double max_residual_mm = 0.5, int threads = 0) {
    const PlatePart part(made), drawing(drawn);
    cad_.emplace(scenes::cad_of(drawing));
    trial_.emplace(scenes::trial_of(part, {.points = 6000}, 4));
    RegistrationOptions options;
    options.method = RegistrationMethod::kProjection;
    options.coarse.initial_scan_from_cad = trial_->scan_from_cad;  // the opening fits half a turn on as well
    options.coarse.within_rad = 0.3;
    options.projection.kind = kind;
    options.projection.max_residual_mm = max_residual_mm;
    options.threads = options.projection.threads = options.edge.threads = threads;
    return register_part(*cad_, trial_->scan, options);
  }
  double mean_mm(const Registration& found) const {
    const auto carry = [&](double, const Vector3d& p) { return found.field->map(p).p_scan_mm; };
    return scenes::distance_between(scenes::carried(cad_->contours[0], 3.0, carry), trial_->true_curve_mm)
        .mean_mm;
  }
  std::optional<CadModel> cad_;
  std::optional<scenes::Trial> trial_;
};

TEST_F(RegisterByProjection, FollowsTheBentPlateToWhatTheScanShows) {
  for (const ProjectionKind kind : {ProjectionKind::kParabola, ProjectionKind::kSpline}) {
    const Registration result = found(raised(kAlphaPerMm, 0.0), raised(0.0, 0.0), kind);
    ASSERT_TRUE(result.usable());
    EXPECT_TRUE(result.refusals.empty()) << result.refusals.front();
    EXPECT_EQ(result.field->method(), "projection");
    EXPECT_EQ(result.stage_residual_mm.back().first, "projection");
    EXPECT_LT(result.stage_residual_mm.back().second, 0.5 * result.stage_residual_mm.front().second);
    EXPECT_LT(mean_mm(result), 1.5 * trial_->edge_limit_mm) << word_of(kind);  // 1.1 mm rigidly
  }
}

TEST_F(RegisterByProjection, RefusesABendingThatItsModelCannotHold) {
  const PlateShape saddle = raised(kAlphaPerMm, -kAlphaPerMm), flat = raised(0.0, 0.0);
  for (const ProjectionKind kind : {ProjectionKind::kPlane, ProjectionKind::kParabola}) {
    const Registration refused = found(saddle, flat, kind);
    ASSERT_EQ(refused.refusals.size(), 1u) << word_of(kind);
    EXPECT_NE(refused.refusals[0].find("is not bent as a " + word_of(kind)), std::string::npos)
        << refused.refusals[0];
  }
  EXPECT_TRUE(found(saddle, flat, ProjectionKind::kSpline).refusals.empty());
  EXPECT_TRUE(found(saddle, flat, ProjectionKind::kParabola, 5.0).refusals.empty());
}

TEST_F(RegisterByProjection, RefusesAnEdgeThatMovedInTheSurface) {
  PlateShape drawn = raised(0.0, 0.0), made = raised(kAlphaPerMm, 0.0);
  for (double* half :
       {&drawn.holes[0].half_x_mm, &drawn.holes[0].half_y_mm, &drawn.holes[0].corner_radius_mm})
    *half -= 2.0;
  const Registration refused = found(made, drawn, ProjectionKind::kSpline);
  ASSERT_EQ(refused.refusals.size(), 1u);
  EXPECT_NE(refused.refusals[0].find("moved in the surface"), std::string::npos) << refused.refusals[0];
  EXPECT_NEAR(refused.projection[0].residual.across_rms_mm, 2.0, 0.3);
}

TEST_F(RegisterByProjection, SameBytesForAnyThreadCount) {
  for (const ProjectionKind kind :
       {ProjectionKind::kPlane, ProjectionKind::kParabola, ProjectionKind::kSpline}) {
    const PlateShape bent = raised(kAlphaPerMm, 0.0), flat = raised(0.0, 0.0);
    EXPECT_EQ(found(bent, flat, kind, 0.5, 1).field->parameters(),
              found(bent, flat, kind, 0.5, 8).field->parameters());
  }
}

}  // namespace
}  // namespace arris
