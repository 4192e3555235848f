#include "registration/subdivision_field.hpp"

#include <gtest/gtest.h>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using synthetic::PlatePart;

constexpr double kBandMm = 60.0;

synthetic::PlateShape bent(bool straight) {
  synthetic::PlateShape out = synthetic::plate_with_rounded_rectangle();
  if (straight) return out;
  out.bend_curvature_per_mm = 1.0 / 1500.0;
  out.twist_rad_per_mm = 1e-4;
  return out;
}

class FieldOfPlate : public testing::Test {
 protected:
  std::vector<ContourResult> results() const {
    EdgeData data;
    data.points_mm = trial_.scan.edge_mm;
    data.sigma_across_mm = 0.1;
    std::vector<ContourMotion> motions =
        subdivision_icp(cad_, trial_.scan, data, trial_.scan_from_cad, SubdivisionIcpOptions());
    EdgeFit edge = fit_edge(cad_, 0, trial_.scan, motions[0], {});
    std::vector<ContourResult> out;
    out.push_back({std::move(motions[0]), std::move(edge)});
    return out;
  }
  PlatePart part_{bent(false)};
  CadModel cad_ = scenes::cad_of(part_);
  scenes::Trial trial_ = scenes::ideal_trial(part_, {}, 2);
  const Curve& curve() const { return cad_.contours.front(); }
};

TEST_F(FieldOfPlate, RotationIsOrthonormalAndCarriesOffsetsUnchanged) {
  const SubdivisionField field(cad_, results(), kBandMm, true);
  for (double s = 0.5; s < curve().length_mm(); s += 7.3) {
    const Eigen::Vector3d foot = curve().point_mm(s);
    const MappedPoint at = field.map(foot);
    EXPECT_TRUE(at.in_domain);
    EXPECT_LT(
        (at.rotation_scan_from_cad * at.rotation_scan_from_cad.transpose() - Eigen::Matrix3d::Identity())
            .norm(),
        1e-12);
    EXPECT_NEAR(at.rotation_scan_from_cad.determinant(), 1.0, 1e-12);
    for (const double up_mm : {-10.0, 5.0, 40.0}) {  // over the edge: the foot stays where it is
      const Eigen::Vector3d offset = up_mm * Eigen::Vector3d::UnitZ();
      const MappedPoint off = field.map(foot + offset);
      EXPECT_LT((off.p_scan_mm - at.p_scan_mm - at.rotation_scan_from_cad * offset).norm(), 1e-9) << s;
    }
  }
}

TEST_F(FieldOfPlate, NormalFollowsTheBentFace) {
  const SubdivisionField field(cad_, results(), kBandMm, true);
  double worst_rad = 0.0;
  for (const synthetic::EdgePoint& p : part_.edge(0, 5.0)) {
    const Eigen::Vector3d axis = field.map(p.nominal_mm).rotation_scan_from_cad * p.nominal_normal;
    worst_rad = std::max(worst_rad, std::acos(std::min(1.0, axis.dot(p.true_normal))));
  }
  EXPECT_LT(worst_rad, 0.02);  // the part turns its normals by up to 0.06
}

TEST_F(FieldOfPlate, SaysNothingBeyondItsBand) {
  const SubdivisionField field(cad_, results(), kBandMm, true);
  const Eigen::Vector3d foot = curve().point_mm(50.0), inward = cad_.inward(0, 50.0);
  EXPECT_TRUE(field.map(foot + 0.99 * kBandMm * inward).in_domain);
  EXPECT_FALSE(field.map(foot + 1.01 * kBandMm * inward).in_domain);
  EXPECT_FALSE(field.map({0.0, 0.0, 500.0}).in_domain);
}

TEST_F(FieldOfPlate, FollowingTheEdgeMovesAPointByTheShiftAcross) {
  const std::vector<ContourResult> found = results();
  const SubdivisionField with(cad_, found, kBandMm, true), without(cad_, found, kBandMm, false);
  for (double s = 0.5; s < curve().length_mm(); s += 11.0) {
    const Eigen::Vector3d p = curve().point_mm(s);
    const double across_mm = found[0].edge.spline.at(s).dot(found[0].edge.across);
    const Eigen::Vector3d expected = found[0].motion.at(s).linear() * (across_mm * cad_.inward(0, s));
    EXPECT_LT((with.map(p).p_scan_mm - without.map(p).p_scan_mm - expected).norm(), 1e-6) << s;
    EXPECT_LT((with.map(p).p_scan_mm - edge_point_mm(cad_, 0, found[0].motion, found[0].edge, s)).norm(),
              1e-6);
  }
}

TEST_F(FieldOfPlate, EdgeThatIsCutTooLargeIsFollowedOnlyWhenAsked) {
  // The drawing has the hole 1 mm smaller all round than the part.
  synthetic::PlateShape small = bent(true);
  small.holes[0].half_x_mm -= 1.0;
  small.holes[0].half_y_mm -= 1.0;
  small.holes[0].corner_radius_mm -= 1.0;
  const PlatePart drawn(small), made(bent(true));
  const CadModel cad = scenes::cad_of(drawn);
  const scenes::Trial trial = scenes::ideal_trial(made, {}, 3);
  const ContourMotion motion = scenes::rigid_along(cad.contours.front(), RigidMotion::Identity());
  std::vector<ContourResult> found;
  found.push_back({motion, fit_edge(cad, 0, trial.scan, motion, {})});
  const auto image = [&](bool follow) {
    const SubdivisionField field(cad, found, kBandMm, follow);
    return scenes::distance_between(
               scenes::carried(cad.contours.front(), 3.0,
                               [&](double, const Eigen::Vector3d& p) { return field.map(p).p_scan_mm; }),
               trial.true_curve_mm)
        .mean_mm;
  };
  EXPECT_LT(image(true), 0.25);
  EXPECT_NEAR(image(false), 1.0, 0.05);
}

TEST(RigidFieldOf, IsOneMotionEverywhere) {
  synthetic::Random random(5);
  const RigidMotion motion = scenes::disturbance(random, {0, 0, 0}, 2.0, 300.0);
  const RigidField field(motion);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d p = 1000.0 * random.direction();
    const MappedPoint at = field.map(p);
    EXPECT_LT((at.p_scan_mm - motion * p).norm(), 1e-10);
    EXPECT_EQ(at.rotation_scan_from_cad, motion.linear());
    EXPECT_TRUE(at.in_domain);
  }
  EXPECT_EQ(field.parameters().size(), 12u);
  EXPECT_EQ(field.method(), "rigid");
}

}  // namespace
}  // namespace arris
