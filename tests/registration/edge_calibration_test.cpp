#include "registration/edge_calibration.hpp"

#include <gtest/gtest.h>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

/// A stiff gauge plate with two holes, cut larger or smaller than drawn: what a scanner makes of an edge.
synthetic::PlateShape gauge(double material_out_mm) {
  synthetic::PlateShape shape;
  shape.half_x_mm = 120.0 + material_out_mm;
  shape.half_y_mm = 90.0 + material_out_mm;
  for (const double x_mm : {-50.0, 45.0}) {
    synthetic::PlateHole hole;
    hole.centre_mm = {x_mm, 10.0};
    hole.half_x_mm = hole.half_y_mm = hole.corner_radius_mm = (x_mm < 0.0 ? 40.0 : 25.0) - material_out_mm;
    shape.holes.push_back(hole);
  }
  return shape;
}

synthetic::ScanOptions whole_face(std::int64_t points) {
  synthetic::ScanOptions options;
  options.band_mm = 0.0;
  options.points = points;
  return options;
}

Registration registered(const CadModel& cad, const synthetic::PlateShape& scanned, std::int64_t points,
                        std::uint64_t seed, RegistrationMethod method = RegistrationMethod::kRigid,
                        const ScannerEdge& scanner = {0.0, 0.0}) {
  scenes::Trial trial = scenes::trial_of(synthetic::PlatePart(scanned), whole_face(points), seed);
  RegistrationOptions options;
  options.method = method;
  options.edge.scanner = options.surface.scanner = scanner;
  Registration found = register_part(cad, trial.scan, options);
  EXPECT_TRUE(found.usable()) << (found.refusals.empty() ? "" : found.refusals.front());
  return found;
}

const CadModel& drawn() {
  static const CadModel cad = scenes::cad_of(synthetic::PlatePart(gauge(0.0)), {0, 1, 2});
  return cad;
}

TEST(EdgeCalibration, FindsHowFarOutAScannerShowsEdgesOfEitherSign) {
  for (const double out_mm : {-0.2, 0.0, 0.15}) {
    const std::vector<Registration> scans = {registered(drawn(), gauge(out_mm), 60000, 1),
                                             registered(drawn(), gauge(out_mm), 60000, 2)};
    const EdgeCalibration found = calibrate_edge(drawn(), scans, {});
    ASSERT_TRUE(found.usable()) << found.reason;
    EXPECT_NEAR(found.edge.out_mm, out_mm, 3.0 * found.edge.sd_mm) << out_mm;
    EXPECT_LT(found.edge.sd_mm, 0.025);
    EXPECT_EQ(found.contours.size(), 6u);
  }
}

TEST(EdgeCalibration, ReferenceOfAnotherSizeIsRefused) {
  // One hole bored 0.3 mm too large: the holes then disagree, whatever the scanner does.
  synthetic::PlateShape wrong = gauge(0.0);
  synthetic::PlateHole& hole = wrong.holes.front();
  hole.half_x_mm = hole.half_y_mm = hole.corner_radius_mm = hole.half_x_mm + 0.3;
  const std::vector<Registration> scans = {registered(drawn(), wrong, 60000, 3)};
  const EdgeCalibration found = calibrate_edge(drawn(), scans, {});
  EXPECT_FALSE(found.usable());
  EXPECT_NE(found.reason.find("size"), std::string::npos) << found.reason;
}

TEST(EdgeCalibration, BentReferenceIsRefused) {
  synthetic::PlateShape bent = gauge(0.0);
  bent.bend_curvature_per_mm = 1.0 / 3000.0;
  const std::vector<Registration> scans = {registered(drawn(), bent, 40000, 4)};
  const EdgeCalibration found = calibrate_edge(drawn(), scans, {});
  EXPECT_FALSE(found.usable());
  EXPECT_NE(found.reason.find("bent"), std::string::npos) << found.reason;
}

TEST(EdgeCalibration, CoarseScanIsNoBetterThanNone) {
  const std::vector<Registration> scans = {registered(drawn(), gauge(0.0), 2000, 5)};
  const EdgeCalibration found = calibrate_edge(drawn(), scans, {});
  EXPECT_FALSE(found.usable());
  EXPECT_FALSE(found.reason.empty());
}

/// Mean distance, into the material, of what the field makes of the contours from where they are drawn; CAD
/// frame.
double mean_inward_mm(const Registration& found) {
  const RigidMotion cad_from_scan = found.rigid.scan_from_cad.inverse();
  double sum = 0.0, count = 0.0;
  for (std::size_t c = 0; c < drawn().contours.size(); ++c) {
    const Curve& curve = drawn().contours[c];
    for (double s_mm = 0.0; s_mm < curve.length_mm(); s_mm += 5.0) {
      const Eigen::Vector3d moved =
          cad_from_scan * found.field->map(curve.point_mm(s_mm)).p_scan_mm - curve.point_mm(s_mm);
      sum += moved.dot(drawn().inward(c, s_mm));
      count += 1.0;
    }
  }
  return sum / count;
}

TEST(EdgeCalibration, TheOffsetIsTakenOffByEveryMethodThatFollowsTheEdge) {
  const double out_mm = 0.2;
  for (const RegistrationMethod method : {RegistrationMethod::kSubdivision, RegistrationMethod::kSurface}) {
    const double as_shown_mm = mean_inward_mm(registered(drawn(), gauge(out_mm), 20000, 6, method));
    const double corrected_mm =
        mean_inward_mm(registered(drawn(), gauge(out_mm), 20000, 6, method, {out_mm, 0.01}));
    EXPECT_NEAR(as_shown_mm, -out_mm, 0.05) << static_cast<int>(method);
    EXPECT_NEAR(corrected_mm - as_shown_mm, out_mm, 0.01) << static_cast<int>(method);
  }
}

TEST(EdgeCalibration, NoEdgeIsKnownBetterThanTheScanner) {
  for (const RegistrationMethod method : {RegistrationMethod::kSubdivision, RegistrationMethod::kSurface}) {
    const Registration sure = registered(drawn(), gauge(0.0), 20000, 7, method, {0.0, 0.0});
    const Registration unsure = registered(drawn(), gauge(0.0), 20000, 7, method, {0.0, 0.3});
    const Eigen::Vector3d p = drawn().contours[0].point_mm(30.0);
    const double before_mm = sure.field->map(p).sd_mm.y(), after_mm = unsure.field->map(p).sd_mm.y();
    EXPECT_NEAR(after_mm, std::hypot(before_mm, 0.3), 1e-9);
    EXPECT_NEAR(unsure.contours[0].edge.sd_across_mm(30.0, true),
                std::hypot(sure.contours[0].edge.sd_across_mm(30.0, true), 0.3), 1e-9);
  }
}

}  // namespace
}  // namespace arris
