#include "registration/subdivision_icp.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"
#include "registration/rigid_icp.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using scenes::Trial;
using synthetic::PlatePart;

/// A plate with a round hole, bent over its width and twisted; the true edge is known at every point.
class SubdivisionIcpOnPlate : public testing::Test {
 protected:
  /// The true edge, sampled, as edge data.
  EdgeData edge_data(const Trial& trial) const {
    EdgeData data;
    data.points_mm = trial.scan.edge_mm;
    data.sigma_across_mm = 0.1;
    return data;
  }
  RigidMotion rigid(const Trial& trial) const {
    return icp_point_to_plane(cad_, trial.scan, trial.scan_from_cad, {}).scan_from_cad;
  }
  scenes::Distance error(const Trial& trial, const SubdivisionIcpOptions& options) const {
    const ContourMotion motion =
        subdivision_icp(cad_, trial.scan, edge_data(trial), rigid(trial), options).front();
    return error(trial,
                 [&](double s, const Eigen::Vector3d& p) { return Eigen::Vector3d(motion.at(s) * p); });
  }
  scenes::Distance error(const Trial& trial,
                         const std::function<Eigen::Vector3d(double, const Eigen::Vector3d&)>& carry) const {
    return scenes::distance_between(scenes::carried(cad_.contours.front(), 3.0, carry), trial.true_curve_mm);
  }
  static SubdivisionIcpOptions with(SegmentMatch match, StabilityPoints stability) {
    SubdivisionIcpOptions options;
    options.match = match;
    options.stability = stability;
    return options;
  }

  PlatePart part_{scenes::bent_plate_with_circle()};
  CadModel cad_ = scenes::cad_of(part_);
};

TEST_F(SubdivisionIcpOnPlate, DefaultLeavesAFractionOfWhatARigidMotionLeaves) {
  const Trial trial = scenes::ideal_trial(part_, {}, 1);
  const RigidMotion pose = rigid(trial);
  const scenes::Distance before =
      error(trial, [&](double, const Eigen::Vector3d& p) { return Eigen::Vector3d(pose * p); });
  const scenes::Distance after = error(trial, SubdivisionIcpOptions());
  EXPECT_GT(before.mean_mm, 0.5);
  EXPECT_LT(after.mean_mm, 0.25 * before.mean_mm) << before.mean_mm;
  EXPECT_LT(after.max_mm, 0.35 * before.max_mm) << before.max_mm;
}

TEST_F(SubdivisionIcpOnPlate, PaperModeFollowsTheEdgeToo) {
  const Trial trial = scenes::ideal_trial(part_, {}, 1);
  const RigidMotion pose = rigid(trial);
  const scenes::Distance before =
      error(trial, [&](double, const Eigen::Vector3d& p) { return Eigen::Vector3d(pose * p); });
  const scenes::Distance after = error(trial, with(SegmentMatch::kPaper, StabilityPoints::kNone));
  EXPECT_LT(after.mean_mm, 0.5 * before.mean_mm);
}

TEST_F(SubdivisionIcpOnPlate, StabilityPointsFrozenInEverySegmentUndoTheSubdivision) {
  const Trial trial = scenes::ideal_trial(part_, {}, 1);
  const double none = error(trial, with(SegmentMatch::kPaper, StabilityPoints::kNone)).mean_mm;
  const double frozen = error(trial, with(SegmentMatch::kPaper, StabilityPoints::kPaper)).mean_mm;
  const double local = error(trial, with(SegmentMatch::kFoot, StabilityPoints::kLocal)).mean_mm;
  EXPECT_GT(frozen, 3.0 * none);
  EXPECT_GT(frozen, 3.0 * local);
}

TEST_F(SubdivisionIcpOnPlate, UndeformedPartLeavesEverySegmentWithinNoiseOfTheRigidMotion) {
  synthetic::PlateShape flat = scenes::bent_plate_with_circle();
  flat.bend_curvature_per_mm = flat.twist_rad_per_mm = 0.0;
  const PlatePart part(flat);
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {}, 4);  // noise 0.05, edge point every 2 mm
  const std::vector<ContourMotion> motions =
      subdivision_icp(cad, trial.scan, edge_data(trial), RigidMotion::Identity(), {});
  ASSERT_EQ(motions.size(), 1u);
  const Curve& curve = cad.contours.front();
  double most_mm = 0.0, rms = 0.0;
  const int count = 300;
  for (int i = 0; i < count; ++i) {
    const double s = curve.length_mm() * i / count;
    const Eigen::Vector3d moved = motions[0].at(s) * curve.point_mm(s) - curve.point_mm(s);
    const double off =
        std::hypot(moved.dot(cad.inward(0, s)), moved.z());  // along a circle anything may move
    most_mm = std::max(most_mm, off);
    rms += off * off / count;
  }
  // Some 70 edge points a segment hold six numbers: sigma sqrt(6 / 70) and a tail of it.
  EXPECT_LT(std::sqrt(rms), 0.05 * std::sqrt(6.0 / 70.0));
  EXPECT_LT(most_mm, 0.05);
  for (const SegmentFit& fit : motions[0].fits()) {
    EXPECT_TRUE(fit.from_data);
    EXPECT_NEAR(fit.rms_mm, 0.05, 0.02);
  }
}

TEST_F(SubdivisionIcpOnPlate, SegmentWithoutDataFollowsItsNeighboursAndSaysSo) {
  Trial trial = scenes::ideal_trial(part_, {}, 6);
  EdgeData data = edge_data(trial);
  // Nothing of the edge between 30 % and 55 % of the contour.
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < data.points_mm.size(); ++i)
    if (i < data.points_mm.size() * 3 / 10 || i > data.points_mm.size() * 55 / 100)
      kept.push_back(data.points_mm[i]);
  data.points_mm = kept;
  const RigidMotion pose = rigid(trial);
  const ContourMotion motion = subdivision_icp(cad_, trial.scan, data, pose, {}).front();
  int prior = 0;
  for (const SegmentFit& fit : motion.fits()) prior += fit.from_data ? 0 : 1;
  EXPECT_GE(prior, 1);
  EXPECT_LT(prior, static_cast<int>(motion.fits().size()));
  const scenes::Distance before =
      error(trial, [&](double, const Eigen::Vector3d& p) { return Eigen::Vector3d(pose * p); });
  const scenes::Distance after =
      error(trial, [&](double s, const Eigen::Vector3d& p) { return Eigen::Vector3d(motion.at(s) * p); });
  EXPECT_LT(after.mean_mm, 0.5 * before.mean_mm);
  EXPECT_LT(after.max_mm, 1.2 * before.max_mm);  // the gap may not become worse than rigid
}

TEST_F(SubdivisionIcpOnPlate, BlendIsContinuousAndRotationsStayOrthonormal) {
  const Trial trial = scenes::ideal_trial(part_, {}, 1);
  const ContourMotion motion = subdivision_icp(cad_, trial.scan, edge_data(trial), rigid(trial), {}).front();
  const Curve& curve = cad_.contours.front();
  const int count = 5000;
  const double step_mm = curve.length_mm() / count;
  Eigen::Vector3d last = motion.at(0.0) * curve.point_mm(0.0);
  for (int i = 1; i <= count; ++i) {
    const double s = curve.wrap_mm(i * step_mm);
    const RigidMotion at = motion.at(s);
    EXPECT_LT((at.linear() * at.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    const Eigen::Vector3d now = at * curve.point_mm(s);
    EXPECT_NEAR((now - last).norm(), step_mm, 0.2 * step_mm) << s;  // a jump would show as a long step
    last = now;
  }
}

TEST(ContourMotionOf, OneMotionInEverySegmentIsThatMotionEverywhere) {
  const PlatePart part(synthetic::plate_with_rounded_rectangle());
  const Curve curve(part.nominal_contour(0, 1.0));
  synthetic::Random random(3);
  const RigidMotion motion = scenes::disturbance(random, {0, 0, 0}, 2.0, 700.0);
  const ContourMotion along = scenes::rigid_along(curve, motion);
  for (double s = 0.0; s < curve.length_mm(); s += 1.7)
    EXPECT_LT((along.at(s).matrix() - motion.matrix()).norm(), 1e-9) << s;
}

TEST(SubdivisionIcpOptions, RefusesValuesOutOfRange) {
  SubdivisionIcpOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.stability_points = -1;
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.subdivision.overlap_ratio = 0.7;
  EXPECT_THROW(options.check(), Error);
}

}  // namespace
}  // namespace arris
