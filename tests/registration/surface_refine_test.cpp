#include "registration/surface_refine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "acquisition/types/error.hpp"
#include "registration/surface_field.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using scenes::Trial;
using synthetic::PlatePart;

synthetic::PlateShape bent(double curvature_per_mm) {
  synthetic::PlateShape shape = synthetic::plate_with_rounded_rectangle();
  shape.bend_curvature_per_mm = curvature_per_mm;
  shape.bend_axis_rad = 0.4;
  return shape;
}

SurfaceOptions options_for(const PlatePart& part) {
  SurfaceOptions options;
  options.prior.thickness_mm = part.shape().thickness_mm;
  options.band_mm = 50.0;
  return options;
}

scenes::Distance error_of(const CadModel& cad, const Trial& trial, const SurfaceField& field) {
  return scenes::distance_between(
      scenes::carried(cad.contours[0], 2.0,
                      [&](double, const Eigen::Vector3d& p) { return field.map(p).p_scan_mm; }),
      trial.true_curve_mm);
}

SurfaceField fitted(const CadModel& cad, const Trial& trial, const SurfaceOptions& options,
                    const RigidMotion& start) {
  return {cad, refine_surface(cad, trial.scan, start, options), options.band_mm, options.role};
}

TEST(SurfaceField, FollowsABentPlateToASmallPartOfTheEdgeLimit) {
  const PlatePart part(bent(2e-4));
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {}, 3);
  const SurfaceField field = fitted(cad, trial, options_for(part), RigidMotion::Identity());
  ASSERT_TRUE(field.fit().usable()) << field.fit().reason;
  EXPECT_EQ(field.fit().stop, "converged");
  const scenes::Distance error = error_of(cad, trial, field);
  EXPECT_LT(error.mean_mm, 0.35 * trial.edge_limit_mm);
  EXPECT_LT(error.max_mm, 1.0 * trial.edge_limit_mm);
}

TEST(SurfaceField, DoesNotInventADeformation) {
  const PlatePart part(bent(0.0));
  const CadModel cad = scenes::cad_of(part);
  double most_over_limit = 0.0;
  constexpr std::uint64_t kScans = 3;
  for (std::uint64_t seed = 4; seed < 4 + kScans; ++seed) {
    const Trial trial = scenes::ideal_trial(part, {}, seed);
    const SurfaceField field = fitted(cad, trial, options_for(part), RigidMotion::Identity());
    double most_mm = 0.0;
    for (double s_mm = 0.0; s_mm < cad.contours[0].length_mm(); s_mm += 10.0) {
      const Eigen::Vector3d p = cad.contours[0].point_mm(s_mm);
      const MappedPoint mapped = field.map(p);
      EXPECT_LT(std::abs((mapped.p_scan_mm - p).z()), 0.06);
      EXPECT_LT(Eigen::AngleAxisd(mapped.rotation_scan_from_cad).angle(), 0.003);
      most_mm = std::max(most_mm, (mapped.p_scan_mm - p).norm());
    }
    most_over_limit += most_mm / trial.edge_limit_mm / static_cast<double>(kScans);
  }
  EXPECT_LT(most_over_limit, 1.5);
}

/// Takes what lies within reach_mm of a place out of a scan.
void cut_out(ScanModel& scan, const Eigen::Vector3d& place_mm, double reach_mm) {
  std::vector<Eigen::Vector3d> points, normals;
  for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
    if ((scan.points_mm[i] - place_mm).norm() > reach_mm) {
      points.push_back(scan.points_mm[i]);
      normals.push_back(scan.normals[i]);
    }
  scan.points_mm = points;
  scan.normals = normals;
  scan.tree = NearestPoints(scan.points_mm);
}

TEST(SurfaceField, CarriesAPatchThatWasNotScannedByTheStiffnessOfTheSheet) {
  const PlatePart part(bent(2e-4));
  const CadModel cad = scenes::cad_of(part);
  Trial trial = scenes::ideal_trial(part, {}, 5);
  cut_out(trial.scan, trial.true_curve_mm[trial.true_curve_mm.size() / 3], 35.0);
  const SurfaceField field = fitted(cad, trial, options_for(part), RigidMotion::Identity());
  const scenes::Distance error = error_of(cad, trial, field);
  EXPECT_LT(error.max_mm, 1.5 * trial.edge_limit_mm);
}

/// A sheet that bends alike where the scan shows it is not known to do so where it does not.
TEST(SurfaceField, StatesThatWhatWasNotScannedMayBendAsWasExpected) {
  const PlatePart part(bent(2e-4));
  const CadModel cad = scenes::cad_of(part);
  const synthetic::EdgePoint edge = part.edge(0, 10.0)[4];
  Trial trial = scenes::ideal_trial(part, {.points = 20000}, 6);
  cut_out(trial.scan, edge.true_mm, 60.0);
  const auto sd_mm = [&](double bend_per_mm) {
    SurfaceOptions options = options_for(part);
    options.prior.bend_per_mm = bend_per_mm;
    return fitted(cad, trial, options, RigidMotion::Identity()).map(edge.nominal_mm).sd_mm.x();
  };
  EXPECT_GT(sd_mm(3e-3), 2.0 * sd_mm(3e-4));
  EXPECT_GT(sd_mm(3e-4), 0.03);
}

TEST(SurfaceField, AHoleThatIsTooLargeIsFollowedAndItsSizeReported) {
  synthetic::PlateShape drawn = bent(1e-4), moulded = drawn;
  moulded.holes[0].half_x_mm += 0.6;
  moulded.holes[0].half_y_mm += 0.6;
  moulded.holes[0].corner_radius_mm += 0.6;
  const PlatePart nominal(drawn), real(moulded);
  const CadModel cad = scenes::cad_of(nominal);
  scenes::IdealOptions dense;
  dense.points = 40000;
  const Trial trial = scenes::ideal_trial(real, dense, 6);
  const SurfaceField field = fitted(cad, trial, options_for(nominal), RigidMotion::Identity());
  EXPECT_NEAR(field.fit().offset_mm[0], 0.6, 0.05);  // the edge lies inside the drawing's material
  EXPECT_LT(error_of(cad, trial, field).mean_mm, 0.05);
}

TEST(SurfaceField, MovingTheScanMovesTheAnswerAndNothingElse) {
  const PlatePart part(bent(2e-4));
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {}, 7);
  const SurfaceField plain = fitted(cad, trial, options_for(part), RigidMotion::Identity());
  synthetic::Random random(3);
  const RigidMotion motion = scenes::disturbance(random, {0, 0, 0}, 1.0, 5000.0);
  const Trial far{scenes::moved(trial.scan, motion), motion, {}, trial.edge_limit_mm};
  const SurfaceField moved = fitted(cad, far, options_for(part), motion);
  for (double s_mm = 0.0; s_mm < cad.contours[0].length_mm(); s_mm += 20.0) {
    const Eigen::Vector3d p = cad.contours[0].point_mm(s_mm);
    EXPECT_LT((motion.inverse() * moved.map(p).p_scan_mm - plain.map(p).p_scan_mm).norm(), 1e-6);
  }
}

TEST(SurfaceField, TheOrderOfTheScanPointsDoesNotMatterThoughADenseScanBeginsWithFewOfThem) {
  const PlatePart part(bent(2e-4));
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {.points = 20000}, 9);
  const SurfaceField plain = fitted(cad, trial, options_for(part), RigidMotion::Identity());
  ASSERT_EQ(plain.fit().stop, "converged");
  EXPECT_GT(plain.fit().pairs, 15000U);  // the last rounds use all of them
  Trial shuffled = scenes::ideal_trial(part, {.points = 20000}, 9);
  std::vector<Eigen::Vector3d>&points = shuffled.scan.points_mm, &normals = shuffled.scan.normals;
  std::reverse(points.begin(), points.end());
  std::reverse(normals.begin(), normals.end());
  shuffled.scan.tree = NearestPoints(points);
  const SurfaceField other = fitted(cad, shuffled, options_for(part), RigidMotion::Identity());
  for (double s_mm = 0.0; s_mm < cad.contours[0].length_mm(); s_mm += 20.0) {
    const Eigen::Vector3d p = cad.contours[0].point_mm(s_mm);
    EXPECT_LT((other.map(p).p_scan_mm - plain.map(p).p_scan_mm).norm(), 5e-4);
  }
}

TEST(SurfaceField, IsBlindToBurrs) {
  const PlatePart part(bent(1e-4));
  const CadModel cad = scenes::cad_of(part);
  std::array<double, 2> max_mm{};
  for (const bool with_burrs : {false, true}) {
    synthetic::ScanOptions scan;
    scan.points = 50000;
    scan.band_mm = 30.0;
    scan.random_pose = false;
    scan.burr_ratio = with_burrs ? 0.1 : 0.0;
    const Trial trial = scenes::trial_of(part, scan, 11);
    const SurfaceField field = fitted(cad, trial, options_for(part), trial.scan_from_cad);
    max_mm[with_burrs ? 1 : 0] = error_of(cad, trial, field).max_mm;
  }
  EXPECT_LT(max_mm[1], max_mm[0] + 0.05);
}

TEST(SurfaceField, APlateThatHardlyBendsStaysAsItIsDrawn) {
  const PlatePart part(bent(2e-6));  // 0.01 mm over 100 mm
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {}, 12);
  const SurfaceField field = fitted(cad, trial, options_for(part), RigidMotion::Identity());
  // Normals of a part that does not bend agree everywhere.
  const Eigen::Matrix3d first = field.map(cad.contours[0].point_mm(0.0)).rotation_scan_from_cad;
  for (double s_mm = 0.0; s_mm < cad.contours[0].length_mm(); s_mm += 10.0) {
    const Eigen::Matrix3d here = field.map(cad.contours[0].point_mm(s_mm)).rotation_scan_from_cad;
    EXPECT_LT((first.col(2) - here.col(2)).norm(), 2e-4) << s_mm;
  }
}

TEST(SurfaceField, NodesMoveCloserForADentThatTheyMissed) {
  synthetic::PlateShape shape = bent(1e-4);
  shape.dents.push_back({{115.0, 10.0}, 50.0, 1.2});
  const PlatePart part(shape);
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {.points = 40000}, 13);
  const SurfaceField field = fitted(cad, trial, options_for(part), RigidMotion::Identity());
  EXPECT_LT(field.fit().basis->spacing_mm(), 25.0);
  const PlatePart smooth(bent(1e-4));
  const Trial plain = scenes::ideal_trial(smooth, {.points = 40000}, 13);
  EXPECT_EQ(fitted(cad, plain, options_for(smooth), RigidMotion::Identity()).fit().basis->spacing_mm(), 30.0);
}

/// Root mean square of the height error along the opening, over scans whose neighbouring points share noise.
double height_error_mm(const synthetic::PlateShape& shape) {
  const PlatePart part(shape);
  const CadModel cad = scenes::cad_of(part);
  double sum2 = 0.0, count = 0.0;
  for (std::uint64_t seed = 30; seed < 34; ++seed) {
    const Trial trial = scenes::trial_of(part, {.points = 30000, .noise_length_mm = 4.0}, seed);
    const SurfaceField field = fitted(cad, trial, options_for(part), trial.scan_from_cad);
    for (const synthetic::EdgePoint& edge : part.edge(0, 10.0)) {
      const Eigen::Vector3d off =
          trial.scan_from_cad.inverse() * field.map(edge.nominal_mm).p_scan_mm - edge.true_mm;
      sum2 += std::pow(off.dot(edge.true_normal), 2);
      count += 1.0;
    }
  }
  return std::sqrt(sum2 / count);
}

TEST(SurfaceField, NoiseThatNeighboursShareHardlyBendsASheetThatBendsAlikeEverywhere) {
  const double alike_mm = height_error_mm(bent(3e-4));
  synthetic::PlateShape dented = bent(3e-4);
  dented.dents.push_back({{115.0, 10.0}, 60.0, 1.2});
  const double dented_mm = height_error_mm(dented);
  EXPECT_LT(alike_mm, 0.011);  // nodes 30 mm apart alone: 0.02
  EXPECT_LT(dented_mm, 0.04);  // is followed all the same
}

TEST(SurfaceField, SameBytesForAnyThreadCount) {
  const PlatePart part(bent(2e-4));
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {}, 8);
  SurfaceOptions options = options_for(part);
  options.max_rounds = 4;
  options.threads = 1;
  const std::vector<double> one = fitted(cad, trial, options, RigidMotion::Identity()).parameters();
  for (const int threads : {2, 8}) {
    options.threads = threads;
    EXPECT_EQ(one, fitted(cad, trial, options, RigidMotion::Identity()).parameters()) << threads;
  }
}

TEST(SurfaceField, StatesHowFarItMayBeOff) {
  const PlatePart part(bent(2e-4));
  const CadModel cad = scenes::cad_of(part);
  int inside_normal = 0, inside_across = 0, count = 0;
  for (std::uint64_t seed = 20; seed < 28; ++seed) {
    const Trial trial = scenes::ideal_trial(part, {}, seed);
    const SurfaceField field = fitted(cad, trial, options_for(part), RigidMotion::Identity());
    for (const synthetic::EdgePoint& edge : part.edge(0, 25.0)) {
      const MappedPoint mapped = field.map(edge.nominal_mm);
      const Eigen::Vector3d off = mapped.p_scan_mm - edge.true_mm;
      inside_normal += std::abs(off.dot(edge.true_normal)) < 1.96 * mapped.sd_mm.x() ? 1 : 0;
      inside_across += std::abs(off.dot(edge.true_void)) < 1.96 * mapped.sd_mm.y() ? 1 : 0;
      ++count;
    }
  }
  EXPECT_GT(inside_normal, 0.8 * count);
  EXPECT_GT(inside_across, 0.8 * count);
}

TEST(SurfaceOptions, RefusesNonsenseByName) {
  SurfaceOptions options;
  options.node_spacing_mm = 0.0;
  try {
    options.check();
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("node_spacing_mm"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace arris
