#include "registration/registration.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using scenes::Trial;

synthetic::ScanOptions hard() {
  synthetic::ScanOptions out;
  out.missing_ratio = 0.15;
  out.stray_ratio = 0.05;
  out.wall_ratio = 0.03;
  out.density_variation_ratio = 2.0;
  return out;
}

RegistrationOptions on_threads(int threads) {
  RegistrationOptions options;
  options.threads = options.coarse.threads = options.rigid.threads = threads;
  options.subdivision.threads = options.edge.threads = threads;
  return options;
}

ScanModel copy_of(const ScanModel& scan) {
  return scenes::moved(scan, RigidMotion::Identity());
}

scenes::Distance field_error(const CadModel& cad, const Trial& trial, const Registration& found) {
  return scenes::distance_between(
      scenes::carried(cad.contours[0], 2.0,
                      [&](double, const Eigen::Vector3d& p) { return found.field->map(p).p_scan_mm; }),
      trial.true_curve_mm);
}

scenes::Distance rigid_error(const CadModel& cad, const Trial& trial, const Registration& found) {
  return scenes::distance_between(scenes::carried(cad.contours[0], 2.0,
                                                  [&](double, const Eigen::Vector3d& p) {
                                                    return Eigen::Vector3d(found.rigid.scan_from_cad * p);
                                                  }),
                                  trial.true_curve_mm);
}

TEST(RegisterPart, SameBytesForAnyThreadCount) {
  const synthetic::FePart part = scenes::fe("sheet");
  const CadModel cad = scenes::cad_of(part);
  Trial trial = scenes::trial_of(part, hard(), 2);
  ScanModel first = copy_of(trial.scan);
  const Registration one = register_part(cad, first, on_threads(1));
  ASSERT_TRUE(one.usable()) << one.refusals.front();
  for (const int threads : {2, 8}) {
    ScanModel again = copy_of(trial.scan);
    const Registration many = register_part(cad, again, on_threads(threads));
    ASSERT_TRUE(many.usable());
    EXPECT_EQ(one.field->parameters(), many.field->parameters()) << threads;
    EXPECT_EQ(one.rigid.scan_from_cad.matrix(), many.rigid.scan_from_cad.matrix());
    EXPECT_EQ(one.stage_residual_mm, many.stage_residual_mm);
  }
}

TEST(RegisterPart, SameBytesForAnyThreadCountWithTheJointFit) {
  const synthetic::FePart part = scenes::fe("sheet");
  const CadModel cad = scenes::cad_of(part);
  Trial trial = scenes::trial_of(part, hard(), 2);
  std::vector<double> first;
  for (const int threads : {1, 2, 8}) {
    RegistrationOptions options = on_threads(threads);
    options.method = RegistrationMethod::kSubdivision;
    options.refine = RefineMethod::kCeres;
    ScanModel scan = copy_of(trial.scan);
    const Registration found = register_part(cad, scan, options);
    ASSERT_TRUE(found.usable());
    EXPECT_TRUE(found.refinement.usable()) << found.refinement.reason;
    if (first.empty()) first = found.field->parameters();
    EXPECT_EQ(found.field->parameters(), first) << threads;
  }
}

TEST(RegisterPart, JointFitIsNotMadeUnlessAskedForAndHelpsOnTheNoseCone) {
  const synthetic::FePart part = scenes::fe("nosecone");
  const CadModel cad = scenes::cad_of(part);
  double without = 0.0, with = 0.0;
  for (const std::uint64_t seed : {31U, 32U}) {
    Trial trial = scenes::trial_of(part, {}, seed);
    ScanModel again = copy_of(trial.scan);
    RegistrationOptions options;
    options.method = RegistrationMethod::kSubdivision;
    const Registration plain = register_part(cad, trial.scan, options);
    options.refine = RefineMethod::kCeres;
    const Registration refined = register_part(cad, again, options);
    ASSERT_TRUE(plain.usable() && refined.usable());
    EXPECT_FALSE(plain.refinement.asked);
    EXPECT_TRUE(plain.refinement.rounds.empty() && plain.refinement.motions.empty());
    without += field_error(cad, trial, plain).mean_mm;
    with += field_error(cad, trial, refined).mean_mm;
  }
  EXPECT_LT(with, 0.8 * without);
}

TEST(RegisterPart, AHoleOfAnotherSizeIsRefusedAndNamed) {
  const synthetic::PlateShape drawn = synthetic::plate_with_rounded_rectangle();
  synthetic::PlateShape moulded = drawn;
  moulded.holes[0].half_x_mm += 2.5;
  moulded.holes[0].half_y_mm += 2.5;
  const synthetic::PlatePart nominal(drawn), part(moulded);
  const CadModel cad = scenes::cad_of(nominal);
  Trial trial = scenes::trial_of(part, {}, 3);
  RegistrationOptions options;
  options.coarse.initial_scan_from_cad = trial.scan_from_cad;
  options.mid_depth_mm = 0.5 * drawn.thickness_mm;
  const Registration found = register_part(cad, trial.scan, options);
  const auto named = [](const std::string& reason) {
    return reason.find("of another size") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(found.refusals.begin(), found.refusals.end(), named))
      << (found.refusals.empty() ? "accepted" : found.refusals.front());
}

TEST(RegisterPart, MovingTheScanMovesTheAnswerAndNothingElse) {
  // Not the sheet: its circle leaves the turn about its axis free, and rounding chooses among equal starts.
  const synthetic::FePart part = scenes::fe("porthole");
  const CadModel cad = scenes::cad_of(part);
  Trial trial = scenes::trial_of(part, {}, 3);
  ScanModel first = copy_of(trial.scan);
  const Registration plain = register_part(cad, first, {});
  ASSERT_TRUE(plain.usable());
  synthetic::Random random(2);
  for (const double far_mm : {100.0, 10000.0}) {
    const RigidMotion motion = scenes::disturbance(random, {0, 0, 0}, random.uniform(0.5, 3.0), far_mm);
    ScanModel scan = scenes::moved(trial.scan, motion);
    const Registration found = register_part(cad, scan, {});
    ASSERT_TRUE(found.usable());
    const RigidMotion back = motion.inverse();
    double most_mm = 0.0;
    for (double s = 0.0; s < cad.contours[0].length_mm(); s += 10.0) {
      const Eigen::Vector3d p = cad.contours[0].point_mm(s);
      most_mm =
          std::max(most_mm, (back * found.field->map(p).p_scan_mm - plain.field->map(p).p_scan_mm).norm());
    }
    EXPECT_LT(most_mm, 1e-6) << far_mm;
  }
}

TEST(RegisterPart, RigidMethodGivesARigidFieldAndTheFoundEdgeAllTheSame) {
  const synthetic::FePart part = scenes::fe("sheet");
  const CadModel cad = scenes::cad_of(part);
  Trial trial = scenes::trial_of(part, {}, 3);
  RegistrationOptions options;
  options.method = RegistrationMethod::kRigid;
  const Registration found = register_part(cad, trial.scan, options);
  ASSERT_TRUE(found.usable());
  EXPECT_EQ(found.field->method(), "rigid");
  ASSERT_EQ(found.contours.size(), 1u);
  // The gap between found edge and rigidly carried nominal is the deformation that the truth shows.
  double gap_mm = 0.0;
  for (int i = 0; i < 100; ++i)
    gap_mm += rigid_gap_mm(cad, 0, found, cad.contours[0].length_mm() * i / 100.0) / 100.0;
  EXPECT_NEAR(gap_mm, rigid_error(cad, trial, found).mean_mm, 0.35);
}

TEST(RegisterPart, SaysWhereTheEdgeWasNotSeen) {
  const synthetic::FePart part = scenes::fe("sheet");
  const CadModel cad = scenes::cad_of(part);
  Trial trial = scenes::trial_of(part, {}, 5);
  RegistrationOptions options;
  options.max_unseen_mm = 0.0;
  options.min_seen_ratio = 1.0;
  Trial gappy = scenes::trial_of(part, hard(), 5);
  const Registration found = register_part(cad, gappy.scan, options);
  ASSERT_TRUE(found.usable());
  ASSERT_EQ(found.refusals.size(), 2u);
  EXPECT_NE(found.refusals[0].find("100 % needed"), std::string::npos) << found.refusals[0];
  EXPECT_NE(found.refusals[1].find("not seen from"), std::string::npos) << found.refusals[1];
}

synthetic::ScanOptions in_rows() {
  synthetic::ScanOptions out;
  out.rows = true;
  return out;
}

/// Scans on which a corrected path was once handed out although it lay far from the truth, or that were
/// refused although they show the whole edge; and a plain one.
struct WatchedScan {
  const char* name;
  const char* part;
  synthetic::ScanOptions options;
  std::uint64_t seed;
  double max_mm;  ///< of the field from the true edge
  bool may_refuse;
  RegistrationMethod method;
};

class WatchedScans : public testing::TestWithParam<WatchedScan> {};

TEST_P(WatchedScans, AreRightOrRefused) {
  const WatchedScan& watched = GetParam();
  const synthetic::FePart part = scenes::fe(watched.part);
  const CadModel cad = scenes::cad_of(part);
  Trial trial = scenes::trial_of(part, watched.options, watched.seed);
  RegistrationOptions options;
  options.method = watched.method;
  options.mid_depth_mm = 0.5 * part.thickness_mm();
  const Registration found = register_part(cad, trial.scan, options);
  if (!found.refusals.empty()) {
    EXPECT_TRUE(watched.may_refuse) << found.refusals.front();
    EXPECT_NE(found.refusals.front().find("s = "), std::string::npos) << found.refusals.front();
    return;
  }
  EXPECT_LT(field_error(cad, trial, found).max_mm, watched.max_mm);
}

// Slid poses: extracted edge points of rows stand up to a row inside, and the rigid pose slid along the oval
// until the edge lay out of reach (12, 12 and 5 mm off). Nose cone, 18: the same at a corner. 113: rows along
// a side.
INSTANTIATE_TEST_SUITE_P(
    Subdivision, WatchedScans,
    testing::Values(
        WatchedScan{"PortholeRows10", "porthole", in_rows(), 10, 2.0, false,
                    RegistrationMethod::kSubdivision},
        WatchedScan{"PortholeRows12", "porthole", in_rows(), 12, 2.0, false,
                    RegistrationMethod::kSubdivision},
        WatchedScan{"PortholeRows105", "porthole", in_rows(), 105, 2.0, false,
                    RegistrationMethod::kSubdivision},
        WatchedScan{"PortholeHard26", "porthole", hard(), 26, 3.2, false, RegistrationMethod::kSubdivision},
        WatchedScan{"NoseconeRows18", "nosecone", in_rows(), 18, 3.0, true, RegistrationMethod::kSubdivision},
        WatchedScan{"NoseconeRows113", "nosecone", in_rows(), 113, 3.0, true,
                    RegistrationMethod::kSubdivision},
        WatchedScan{"NoseconeHard32", "nosecone", hard(), 32, 2.5, false, RegistrationMethod::kSubdivision},
        WatchedScan{"PortholeClean1", "porthole", {}, 1, 1.5, false, RegistrationMethod::kSubdivision}),
    [](const auto& at) { return std::string(at.param.name); });

synthetic::ScanOptions quiet() {
  synthetic::ScanOptions out;
  out.noise_sigma_mm = 0.02;
  return out;
}

synthetic::ScanOptions with_open_gap() {
  synthetic::ScanOptions out;
  out.missing_ratio = 0.1;
  return out;
}

// Open gaps: one patch that is missing from the edge to the border of the scan makes one loop of both; there
// was no start pose, or one from the border. Hard porthole, 16: one stray beside a thin stretch held the
// edge 2.1 mm out; 37: two strays, 3.4 mm. Nose cone, hard 20 and quiet 4: the edge sharpened before the
// field had followed, 1.2 and 1.1 mm.
INSTANTIATE_TEST_SUITE_P(
    Surface, WatchedScans,
    testing::Values(
        WatchedScan{"PortholeHard16", "porthole", hard(), 16, 1.0, true, RegistrationMethod::kSurface},
        WatchedScan{"PortholeHard37", "porthole", hard(), 37, 1.0, true, RegistrationMethod::kSurface},
        WatchedScan{"PortholeRows12", "porthole", in_rows(), 12, 1.0, false, RegistrationMethod::kSurface},
        WatchedScan{"PortholeOpenGap2", "porthole", with_open_gap(), 2, 2.0, true,
                    RegistrationMethod::kSurface},
        WatchedScan{"PortholeOpenGap3", "porthole", with_open_gap(), 3, 2.0, false,
                    RegistrationMethod::kSurface},
        WatchedScan{"NoseconeHard20", "nosecone", hard(), 20, 0.6, false, RegistrationMethod::kSurface},
        WatchedScan{"NoseconeQuiet4", "nosecone", quiet(), 4, 0.6, false, RegistrationMethod::kSurface}),
    [](const auto& at) { return std::string(at.param.name); });

void PrintTo(const WatchedScan& watched, std::ostream* out) {
  *out << watched.name;
}

/// What a part must reach, against the truth; ratios are of rigid ICP's error on the same scan.
struct Bounds {
  const char* part;
  double clean_mean_limits, clean_mean_mm, clean_mean_ratio, clean_max_ratio;  ///< limits: in units of E
  double hard_mean_limits, hard_mean_mm;
};

class SlowFePart : public testing::TestWithParam<Bounds> {
 protected:
  const Bounds& bounds_ = GetParam();
  synthetic::FePart part_ = scenes::fe(bounds_.part);
  CadModel cad_ = scenes::cad_of(part_);

  RegistrationOptions by(RegistrationMethod method) const {
    RegistrationOptions options;
    options.method = method;
    options.mid_depth_mm = 0.5 * part_.thickness_mm();
    return options;
  }
};

TEST_P(SlowFePart, SurfaceFieldReachesAPartOfTheEdgeLimitWithOrWithoutGaps) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const synthetic::ScanOptions& how : {synthetic::ScanOptions{}, hard()}) {
      Trial trial = scenes::trial_of(part_, how, seed);
      const Registration found = register_part(cad_, trial.scan, by(RegistrationMethod::kSurface));
      if (how.missing_ratio > 0.0 && (!found.usable() || !found.refusals.empty())) continue;
      ASSERT_TRUE(found.usable()) << found.refusals.front();
      const scenes::Distance field = field_error(cad_, trial, found);
      EXPECT_LT(field.mean_mm, 0.6 * trial.edge_limit_mm) << seed;
      EXPECT_LT(field.max_mm, 2.0 * trial.edge_limit_mm) << seed;
      EXPECT_LT(std::abs(found.mean_strain_ratio), 0.003);
    }
}

TEST_P(SlowFePart, CleanScanIsCorrectedToTheLimitOfWhatItShows) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Trial trial = scenes::trial_of(part_, {}, seed);
    const Registration found = register_part(cad_, trial.scan, by(RegistrationMethod::kSubdivision));
    ASSERT_TRUE(found.usable()) << found.refusals.front();
    EXPECT_TRUE(found.refusals.empty()) << found.refusals.front();
    const scenes::Distance field = field_error(cad_, trial, found), rigid = rigid_error(cad_, trial, found);
    EXPECT_LT(field.mean_mm, bounds_.clean_mean_limits * trial.edge_limit_mm) << seed;
    EXPECT_LT(field.mean_mm, bounds_.clean_mean_mm) << seed;
    EXPECT_LT(field.mean_mm, bounds_.clean_mean_ratio * rigid.mean_mm) << seed;
    EXPECT_LT(field.max_mm, bounds_.clean_max_ratio * rigid.max_mm) << seed;
    EXPECT_LT(found.stage_residual_mm.back().second, found.stage_residual_mm.front().second);
    EXPECT_LT(std::abs(found.mean_strain_ratio), 0.003);  // the parts bend, they hardly stretch
  }
}

TEST_P(SlowFePart, HardScanIsCorrectedOrRefused) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Trial trial = scenes::trial_of(part_, hard(), seed);
    const Registration found = register_part(cad_, trial.scan, by(RegistrationMethod::kSubdivision));
    if (!found.usable() || !found.refusals.empty()) continue;
    const double mean_mm = field_error(cad_, trial, found).mean_mm;
    EXPECT_LT(mean_mm, bounds_.hard_mean_limits * trial.edge_limit_mm) << seed;
    EXPECT_LT(mean_mm, bounds_.hard_mean_mm) << seed;
  }
}

// Nose cone: the job's own figures (75 % less than rigid ICP in the mean, 65 % in the peak). Sheet: at most
// 0.4 mm. Porthole: 1,500 points over 70 mm, E = 0.6 mm, and one of three scans has a thin stretch: E and a
// quarter. Hard scans lose 15 % of the contour, where only the splines' stiffness decides.
INSTANTIATE_TEST_SUITE_P(All, SlowFePart,
                         testing::Values(Bounds{"nosecone", 1.0, 0.4, 0.25, 0.35, 2.5, 0.9},
                                         Bounds{"sheet", 1.0, 0.4, 0.25, 0.35, 2.0, 0.4},
                                         Bounds{"porthole", 1.25, 0.8, 0.25, 0.35, 2.5, 1.5}),
                         [](const auto& at) { return std::string(at.param.part); });

}  // namespace
}  // namespace arris
