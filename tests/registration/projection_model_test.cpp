#include "registration/projection_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "registration/projection_field.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using synthetic::PlatePart;
using synthetic::PlateShape;

constexpr double kAlphaPerMm = 4e-4;  // 3 mm at 90 mm from the axis

PlateShape raised(double across_per_mm, double along_per_mm, double axis_rad, double axis_mm) {
  PlateShape out = synthetic::plate_with_rounded_rectangle();
  out.raise_across_per_mm = across_per_mm;
  out.raise_along_per_mm = along_per_mm;
  out.raise_axis_rad = axis_rad;
  out.raise_axis_mm = axis_mm;
  return out;
}

/// One scan of a plate at the drawing's own pose, and what the models are fitted to.
struct Plate {
  explicit Plate(const PlateShape& shape, double noise_mm, std::uint64_t seed = 1)
      : part(shape),
        cad(scenes::cad_of(part)),
        trial(scenes::ideal_trial(part, {.noise_sigma_mm = noise_mm}, seed)),
        samples(measured_heights(cad, 0, trial.scan, RigidMotion::Identity(), 30.0, 1)) {}
  const Curve& curve() const { return cad.contours[0]; }
  BentParabola parabola() const { return std::get<BentParabola>(fit_bent_parabola(curve(), samples).model); }
  PlatePart part;
  CadModel cad;
  scenes::Trial trial;
  std::vector<HeightSample> samples;
};

SurfacePlace flat_place(const Vector3d& p_mm) {
  SurfacePlace place;
  place.p_mm = p_mm;
  place.normal = Vector3d::UnitZ();
  return place;
}

/// Eq. 3 as printed: the drawing, registered, against the plane that approximates it. No scan is asked for.
std::vector<Vector3d> printed_eq_3(const std::vector<Vector3d>& registered_mm) {
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& x : registered_mm) centre += x / static_cast<double>(registered_mm.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& x : registered_mm) spread += (x - centre) * (x - centre).transpose();
  const Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  std::vector<Vector3d> d;
  for (const Vector3d& x : registered_mm) d.push_back(normal.dot(centre - x) * normal);
  return d;
}

TEST(MeasuredHeights, AreTheFormulaOfTheRaisedPlateAndTheFacesAlone) {
  const Plate plate(raised(kAlphaPerMm, 0.0, 0.4, 12.0), 0.0);
  ASSERT_GT(plate.samples.size(), 1000u);
  for (const HeightSample& s : plate.samples) {
    const Vector3d truth = plate.part.at_xy(s.foot_mm.x(), s.foot_mm.y()).true_mm;
    EXPECT_NEAR(s.height_mm, truth.z(), 1e-9);
    EXPECT_LE(plate.curve().nearest(s.foot_mm).distance_mm, 30.0);
    EXPECT_LE(plate.part.void_distance_mm(s.foot_mm.x(), s.foot_mm.y()), 1e-9);
  }
}

TEST(MeasuredHeights, PointsOfAWallAreLeftOut) {
  const Plate plate(raised(kAlphaPerMm, 0.0, 0.4, 12.0), 0.0);
  ScanModel scan = scenes::moved(plate.trial.scan, RigidMotion::Identity());
  for (std::size_t i = 0; i < scan.normals.size(); i += 2) scan.normals[i] = Vector3d::UnitX();
  const auto half = measured_heights(plate.cad, 0, scan, RigidMotion::Identity(), 30.0, 1);
  EXPECT_NEAR(static_cast<double>(half.size()), 0.5 * static_cast<double>(plate.samples.size()),
              0.1 * static_cast<double>(plate.samples.size()));
}

TEST(BentParabola, IsExactOnAPlateRaisedAsOne) {
  for (const double axis_mm : {0.0, -70.0, 150.0}) {
    const Plate plate(raised(kAlphaPerMm, 0.0, 0.7, axis_mm), 0.0);
    const BentParabola found = plate.parabola();
    EXPECT_NEAR(found.alpha_per_mm, kAlphaPerMm, 1e-10) << axis_mm;
    for (double x = -150.0; x <= 150.0; x += 30.0)
      for (double y = -120.0; y <= 120.0; y += 30.0) {
        const synthetic::FacePoint truth = plate.part.at_xy(x, y);
        const SurfaceHeight height = found.at(flat_place({x, y, 0.0}));
        EXPECT_NEAR(height.mm, truth.true_mm.z(), 1e-6);
        EXPECT_LT(((Vector3d::UnitZ() - height.slope).normalized() - truth.true_normal).norm(), 1e-8);
      }
  }
}

TEST(BentParabola, AxisIsFoundWhateverItsDirectionToOneDegreeAndTwoMillimetres) {
  for (int degrees = 0; degrees < 180; degrees += 15)
    for (const double alpha : {kAlphaPerMm, -kAlphaPerMm}) {
      const double angle_rad = degrees * std::numbers::pi / 180.0, axis_mm = 25.0;
      const Plate plate(raised(alpha, 0.0, angle_rad, axis_mm), 0.05, 3);
      const BentParabola found = plate.parabola();
      ASSERT_TRUE(found.axis_known()) << degrees;
      const Vector3d axis(std::cos(angle_rad), std::sin(angle_rad), 0.0);
      const double off_rad = std::acos(std::min(1.0, std::abs(axis.dot(found.along_axis))));
      EXPECT_LT(off_rad, std::numbers::pi / 180.0) << degrees;
      EXPECT_LT(off_rad, 5.0 * found.axis_sd_rad) << degrees;
      const Vector3d across(-axis.y(), axis.x(), 0.0);
      EXPECT_NEAR(across.dot(found.axis_point_mm()), axis_mm, 2.0) << degrees;
      EXPECT_NEAR(found.alpha_per_mm, alpha, 5.0 * found.alpha_sd_per_mm) << degrees;
      EXPECT_LT(found.alpha_sd_per_mm, 0.01 * kAlphaPerMm);
    }
}

TEST(BentParabola, StraysDoNotBendIt) {
  Plate plate(raised(kAlphaPerMm, 0.0, 0.7, 20.0), 0.05);
  for (std::size_t i = 0; i < plate.samples.size(); i += 12) plate.samples[i].height_mm += 8.0;
  EXPECT_NEAR(plate.parabola().alpha_per_mm, kAlphaPerMm, 0.02 * kAlphaPerMm);
}

TEST(BentParabola, KnowsNoAxisOnAFlatPlateNorOnASaddleRoundACircle) {
  EXPECT_FALSE(Plate(raised(0.0, 0.0, 0.0, 0.0), 0.05).parabola().axis_known());
  PlateShape saddle = synthetic::plate_with_circle();
  saddle.holes[0].centre_mm = {0.0, 0.0};
  saddle.raise_across_per_mm = kAlphaPerMm;
  saddle.raise_along_per_mm = -kAlphaPerMm;
  EXPECT_FALSE(Plate(saddle, 0.05).parabola().axis_known());  // either way explains half of it
  saddle.raise_along_per_mm = -0.05 * kAlphaPerMm;
  EXPECT_TRUE(Plate(saddle, 0.05).parabola().axis_known());
}

TEST(BentParabola, RefusesTooFewPointsAndAContourThatWrapsRound) {
  const Plate plate(raised(kAlphaPerMm, 0.0, 0.0, 0.0), 0.05);
  const auto few = std::span(plate.samples).first(29);
  EXPECT_NE(fit_bent_parabola(plate.curve(), few).reason.find("29 scan points"), std::string::npos);
  EXPECT_NE(fit_flat_target(plate.curve(), few).reason.find("29 scan points"), std::string::npos);
  Contour ring;  // round a pipe
  ring.closed = true;
  for (int i = 0; i < 72; ++i) {
    const double angle = i * std::numbers::pi / 36.0;
    ring.normals.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    ring.points_mm.push_back(80.0 * ring.normals.back());
  }
  EXPECT_NE(fit_bent_parabola(Curve(ring), plate.samples).reason.find("60 degrees"), std::string::npos);
  EXPECT_NE(fit_flat_target(Curve(ring), plate.samples).reason.find("60 degrees"), std::string::npos);
}

TEST(FlatTarget, CarriesEveryPointOntoThePlaneOfTheScan) {
  const Plate plate(raised(0.0, 0.0, 0.0, 0.0), 0.0);
  synthetic::Random random(4);
  RigidMotion lean = RigidMotion::Identity();
  lean.linear() = Eigen::AngleAxisd(0.03, Vector3d(1.0, 2.0, 0.0).normalized()).toRotationMatrix();
  lean.translation().z() = 1.5;
  const ScanModel scan = scenes::moved(plate.trial.scan, lean);
  const auto samples = measured_heights(plate.cad, 0, scan, RigidMotion::Identity(), 30.0, 1);
  const FlatTarget found = std::get<FlatTarget>(fit_flat_target(plate.curve(), samples).model);
  const Vector3d normal = lean.linear() * Vector3d::UnitZ();
  EXPECT_LT((found.normal - normal).norm(), 1e-9);
  for (int i = 0; i < 50; ++i) {
    const Vector3d p(random.uniform(-100.0, 100.0), random.uniform(-100.0, 100.0), 0.0);
    const SurfaceHeight height = found.at(flat_place(p));
    EXPECT_NEAR(normal.dot(p + height.mm * Vector3d::UnitZ() - lean.translation()), 0.0, 1e-9);
    EXPECT_LT(((Vector3d::UnitZ() - height.slope).normalized() - normal).norm(), 1e-9);
  }
}

TEST(PrintedEquation3, DoesNotDependOnTheScanAndTheRepairedOneDoes) {
  const PlateShape bent = raised(kAlphaPerMm, 0.0, 0.7, 20.0), flat = raised(0.0, 0.0, 0.0, 0.0);
  // The drawing itself is curved: else the printed deformation would be nothing at all.
  std::vector<Vector3d> drawn_mm = PlatePart(raised(2e-4, 0.0, 0.0, 0.0)).true_curve(0, 5.0);
  synthetic::Random random(8);
  const std::vector<Vector3d> before = printed_eq_3(drawn_mm);
  double most_mm = 0.0;
  for (const Vector3d& d : before) most_mm = std::max(most_mm, d.norm());
  EXPECT_GT(most_mm, 0.2);
  for (int i = 0; i < 5; ++i) {  // whatever scan it is registered to: only R and T come from there
    const RigidMotion pose = scenes::disturbance(random, {0, 0, 0}, 0.3 * i, 100.0);
    std::vector<Vector3d> registered_mm;
    for (const Vector3d& x : drawn_mm) registered_mm.push_back(pose * x);
    const std::vector<Vector3d> after = printed_eq_3(registered_mm);
    for (std::size_t k = 0; k < before.size(); ++k)
      EXPECT_LT((pose.linear().transpose() * after[k] - before[k]).norm(), 1e-9);
  }
  const BentParabola of_bent = Plate(bent, 0.05).parabola(), of_flat = Plate(flat, 0.05).parabola();
  const SurfacePlace far = flat_place({100.0, -60.0, 0.0});
  EXPECT_NEAR(of_bent.at(far).mm, PlatePart(bent).at_xy(100.0, -60.0).true_mm.z(), 0.1);
  EXPECT_NEAR(of_flat.at(far).mm, 0.0, 0.1);
}

}  // namespace
}  // namespace arris
