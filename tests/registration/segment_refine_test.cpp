#include "registration/segment_refine.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "registration/rigid_icp.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using scenes::Trial;
using synthetic::PlatePart;

/// Root mean square of all jumps at the seams.
double jump_rms_mm(const ContourMotion& motion) {
  double sum2 = 0.0;
  const std::vector<Seam> seams = seams_of(motion);
  for (const Seam& seam : seams) sum2 += seam.jump_mm * seam.jump_mm;
  return std::sqrt(sum2 / static_cast<double>(seams.size()));
}

/// Largest distance, across the contour, between the images of a contour under two motions.
double apart_mm(const ContourMotion& a, const ContourMotion& b) {
  const Curve& curve = a.nominal();
  double most_mm = 0.0;
  for (double s = 0.0; s < curve.length_mm(); s += 1.0) {
    Eigen::Vector3d apart = a.at(s) * curve.point_mm(s) - b.at(s) * curve.point_mm(s);
    const Eigen::Vector3d tangent = b.at(s).linear() * curve.tangent(s);
    apart -= apart.dot(tangent) * tangent;
    most_mm = std::max(most_mm, apart.norm());
  }
  return most_mm;
}

/// A flat plate whose segments move rigidly and meet at their common cuts: the model of the method, so that
/// an exact answer exists. Scan and edge are its images by the blend, without noise.
class HingedPlate : public testing::Test {
 protected:
  /// Folded about chords between two cuts: what lies between them turns, and the cuts stay where they are.
  static ContourMotion hinged(const Curve& curve, double turn_rad, const RigidMotion& pose) {
    const Subdivision subdivision(curve, {});
    const std::vector<Segment>& segments = subdivision.segments();
    std::vector<SegmentFit> fits(segments.size());
    for (SegmentFit& fit : fits) fit.scan_from_cad = pose;
    const auto fold = [&](std::size_t first, std::size_t last, double angle_rad) {
      const Eigen::Vector3d from_mm = curve.point_mm(curve.wrap_mm(segments[first].begin_mm));
      const Eigen::Vector3d to_mm = curve.point_mm(curve.wrap_mm(segments[last].end_mm));
      const RigidMotion turned = Eigen::Translation3d(from_mm) *
                                 Eigen::AngleAxisd(angle_rad, (to_mm - from_mm).normalized()) *
                                 Eigen::Translation3d(-from_mm);
      for (std::size_t z = first; z <= last; ++z) fits[z].scan_from_cad = pose * turned;
    };
    fold(1, 2, turn_rad);
    fold(segments.size() - 3, segments.size() - 2, -0.7 * turn_rad);
    return {curve, subdivision, fits};
  }

  ScanModel scan_of(const ContourMotion& truth) const {
    const Curve& curve = truth.nominal();
    std::vector<Eigen::Vector3d> points_mm, normals;
    for (double s = 0.0; s < curve.length_mm(); s += 2.0)
      for (double inside_mm = 3.0; inside_mm < 30.0; inside_mm += 4.0) {
        const RigidMotion here = truth.at(s);
        points_mm.push_back(here * (curve.point_mm(s) + inside_mm * cad_.inward(0, s)));
        normals.push_back(here.linear() * curve.normal(s));
      }
    NearestPoints tree(points_mm);
    return {std::move(points_mm), std::move(normals), std::move(tree), {}, {}, {}, 2.0, 0.05,
            SideKnown::kYes};
  }

  static EdgeData edge_of(const ContourMotion& truth) {
    EdgeData data;
    data.sigma_across_mm = 0.1;
    for (double s = 0.0; s < truth.nominal().length_mm(); s += 2.0) {
      data.points_mm.push_back(truth.at(s) * truth.nominal().point_mm(s));
      data.contour.push_back(0);
      data.arc_mm.push_back(s);
    }
    return data;
  }

  ContourMotion disturbed(const ContourMotion& truth, double turn_rad, double shift_mm) const {
    synthetic::Random random(5);
    std::vector<SegmentFit> fits = truth.fits();
    for (std::size_t z = 0; z < fits.size(); ++z) {
      const Segment& piece = truth.subdivision().segments()[z];
      const Eigen::Vector3d middle_mm =
          fits[z].scan_from_cad *
          truth.nominal().point_mm(truth.nominal().wrap_mm(0.5 * (piece.begin_mm + piece.end_mm)));
      fits[z].scan_from_cad =
          scenes::disturbance(random, middle_mm, turn_rad, shift_mm) * fits[z].scan_from_cad;
    }
    return {truth.nominal(), truth.subdivision(), fits};
  }

  SegmentRefinement refined(const ContourMotion& truth, const EdgeData& data,
                            const SegmentRefineOptions& options) const {
    return refine_segments(cad_, scan_of(truth), data, {disturbed(truth, 0.01, 0.5)}, {}, options);
  }

  static SegmentRefineOptions free_seams() {
    SegmentRefineOptions options;
    options.bend_per_mm = options.strain_ratio = 1e3;
    return options;
  }
  static RigidMotion pose() {
    synthetic::Random random(2);
    return scenes::disturbance(random, {0, 0, 0}, 1.0, 500.0);
  }

  PlatePart part_{synthetic::plate_with_rounded_rectangle()};
  CadModel cad_ = scenes::cad_of(part_);
  const Curve& curve_ = cad_.contours[0];
};

TEST_F(HingedPlate, OneMotionForAllSegmentsIsFoundExactlyWhateverTheSeamsCost) {
  const ContourMotion truth = hinged(curve_, 0.0, pose());
  for (const SegmentRefineOptions& options : {SegmentRefineOptions{}, free_seams()}) {
    const SegmentRefinement found = refined(truth, edge_of(truth), options);
    ASSERT_TRUE(found.usable()) << found.reason;
    EXPECT_EQ(found.stop, "converged");
    EXPECT_LT(apart_mm(found.motions[0], truth), 2e-3);
    EXPECT_LT(jump_rms_mm(found.motions[0]), 2e-3);
  }
}

TEST_F(HingedPlate, HingedSegmentsAreFoundExactlyWhenSeamsAreFreeAndNearlySoWhenTheyAreNot) {
  const ContourMotion truth = hinged(curve_, 0.02, pose());
  const SegmentRefinement loose = refined(truth, edge_of(truth), free_seams());
  const SegmentRefinement tied = refined(truth, edge_of(truth), {});
  ASSERT_TRUE(loose.usable() && tied.usable());
  EXPECT_LT(apart_mm(loose.motions[0], truth), 5e-3);
  EXPECT_LT(apart_mm(tied.motions[0], truth), 0.03);
}

TEST_F(HingedPlate, StrayEdgePointsDoNotPull) {
  const ContourMotion truth = hinged(curve_, 0.02, pose());
  EdgeData data = edge_of(truth);
  const SegmentRefinement clean = refined(truth, data, {});
  for (std::size_t i = 0; i < data.points_mm.size(); i += 8) {  // burrs: one point in eight, 4 mm off
    const RigidMotion here = truth.at(data.arc_mm[i]);
    data.points_mm[i] -= 4.0 * here.linear() * cad_.inward(0, data.arc_mm[i]);
  }
  const SegmentRefinement found = refined(truth, data, {});
  ASSERT_TRUE(found.usable());
  EXPECT_LT(apart_mm(found.motions[0], clean.motions[0]), 0.02);  // a mean would move by 0.5 mm
}

TEST_F(HingedPlate, SegmentWithoutAnyEdgePointContinuesItsNeighbours) {
  const ContourMotion truth = hinged(curve_, 0.01, pose());
  const EdgeData all = edge_of(truth);
  const Segment& gap = truth.subdivision().segments()[2];
  EdgeData data = all;
  data.points_mm.clear(), data.contour.clear(), data.arc_mm.clear();
  for (std::size_t i = 0; i < all.points_mm.size(); ++i) {
    if (all.arc_mm[i] > gap.reach_begin_mm && all.arc_mm[i] < gap.reach_end_mm) continue;
    data.points_mm.push_back(all.points_mm[i]);
    data.contour.push_back(0);
    data.arc_mm.push_back(all.arc_mm[i]);
  }
  const SegmentRefinement found = refined(truth, data, {});  // it begins 0.5 mm and 0.01 rad off
  ASSERT_TRUE(found.usable());
  EXPECT_EQ(found.segments[2].pairs, 0);
  EXPECT_LT(apart_mm(found.motions[0], truth), 0.1);
}

TEST_F(HingedPlate, FitThatFailsKeepsTheMotionsGivenAndSaysSo) {
  const ContourMotion truth = hinged(curve_, 0.02, pose());
  EdgeData data = edge_of(truth);
  data.sigma_across_mm = 0.0;  // no finite residual
  const ContourMotion given = disturbed(truth, 0.01, 0.5);
  const SegmentRefinement found = refine_segments(cad_, scan_of(truth), data, {given}, {}, {});
  EXPECT_FALSE(found.usable());
  EXPECT_NE(found.reason.find("the motions of subdivision ICP are kept"), std::string::npos) << found.reason;
  ASSERT_EQ(found.motions.size(), 1U);
  for (std::size_t z = 0; z < given.fits().size(); ++z)
    EXPECT_EQ(found.motions[0].fits()[z].scan_from_cad.matrix(), given.fits()[z].scan_from_cad.matrix());
}

/// A plate that bends and twists smoothly, with noise: no segment moves rigidly.
class BentPlate : public testing::Test {
 protected:
  struct Pair {
    ContourMotion before;
    SegmentRefinement after;
  };
  /// Without the edge points from share `from` to share `to` of the contour.
  Pair fitted(const Trial& trial, double from, double to) const {
    EdgeData data;
    data.sigma_across_mm = 0.1;
    const std::size_t n = trial.scan.edge_mm.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(n);
      if (share < from || share > to) data.points_mm.push_back(trial.scan.edge_mm[i]);
    }
    const RigidMotion pose = icp_point_to_plane(cad_, trial.scan, trial.scan_from_cad, {}).scan_from_cad;
    std::vector<ContourMotion> before = subdivision_icp(cad_, trial.scan, data, pose, {});
    SegmentRefinement after = refine_segments(cad_, trial.scan, data, before, {}, {});
    return {before.front(), std::move(after)};
  }
  /// Of the stretch between two shares of the contour.
  scenes::Distance error(const ContourMotion& motion, const Trial& trial, double from = 0.0,
                         double to = 1.0) const {
    const Curve& curve = cad_.contours[0];
    std::vector<Eigen::Vector3d> images_mm;
    for (double s = from * curve.length_mm(); s < to * curve.length_mm(); s += 3.0)
      images_mm.emplace_back(motion.at(s) * curve.point_mm(s));
    return scenes::distance_between(images_mm, trial.true_curve_mm);
  }

  PlatePart part_{scenes::bent_plate_with_circle()};
  CadModel cad_ = scenes::cad_of(part_);
};

TEST_F(BentPlate, SeamsShrinkAndTheEdgeIsFollowedAsWell) {
  double jump_before = 0.0, jump_after = 0.0, mean_before = 0.0, mean_after = 0.0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Trial trial = scenes::ideal_trial(part_, {}, seed);
    const Pair pair = fitted(trial, 2.0, 2.0);
    ASSERT_TRUE(pair.after.usable()) << pair.after.reason;
    jump_before += jump_rms_mm(pair.before), jump_after += jump_rms_mm(pair.after.motions[0]);
    mean_before += error(pair.before, trial).mean_mm;
    mean_after += error(pair.after.motions[0], trial).mean_mm;
  }
  EXPECT_LT(jump_after, jump_before);
  EXPECT_LT(mean_after, 1.05 * mean_before);
}

TEST_F(BentPlate, GapIsBridgedAtLeastAsWellAsWithoutTheJointFit) {
  double before = 0.0, after = 0.0;
  for (const std::uint64_t seed : {4U, 5U, 6U}) {
    const Trial trial = scenes::ideal_trial(part_, {}, seed);
    const Pair pair = fitted(trial, 0.30, 0.45);
    ASSERT_TRUE(pair.after.usable());
    before += error(pair.before, trial, 0.30, 0.45).max_mm;
    after += error(pair.after.motions[0], trial, 0.30, 0.45).max_mm;
  }
  EXPECT_LT(after, before);
}

TEST_F(BentPlate, SummaryTellsEachRoundSegmentAndSeam) {
  const Trial trial = scenes::ideal_trial(part_, {}, 1);
  const Pair pair = fitted(trial, 2.0, 2.0);
  ASSERT_FALSE(pair.after.rounds.empty());
  for (const RefineRound& round : pair.after.rounds) {
    EXPECT_LE(round.solver.cost_after, round.solver.cost_before);
    EXPECT_LE(round.solver.iterations, SegmentRefineOptions{}.steps_a_round);
  }
  EXPECT_EQ(pair.after.segments.size(), pair.before.fits().size());
  EXPECT_EQ(pair.after.seams.size(), pair.before.fits().size());  // closed: one a segment
  EXPECT_DOUBLE_EQ(pair.after.seams[0].before.jump_mm, seams_of(pair.before)[0].jump_mm);
  EXPECT_NE(pair.after.statement().find("rounds; seams jump by"), std::string::npos);
}

}  // namespace
}  // namespace arris
