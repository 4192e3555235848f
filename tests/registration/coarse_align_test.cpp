#include "registration/coarse_align.hpp"

#include <gtest/gtest.h>

#include "registration/loop_match.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using scenes::Trial;
using synthetic::PlatePart;

/// The whole face of the plate; three holes make it unlike its own mirror image and its own half turn.
synthetic::ScanOptions whole_face() {
  synthetic::ScanOptions out;
  out.band_mm = 0.0;
  out.points = 12000;
  return out;
}

const PlatePart& asymmetric() {
  static const PlatePart part(synthetic::asymmetric_plate());
  return part;
}

const CadModel& asymmetric_cad() {
  static const CadModel cad = scenes::cad_of(asymmetric(), {0, 1, 2});
  return cad;
}

/// Farthest that the contours of the drawing lie from where the true pose puts them.
double off_mm(const CadModel& cad, const RigidMotion& found, const RigidMotion& truth) {
  double most = 0.0;
  for (const Curve& curve : cad.contours)
    for (const Eigen::Vector3d& p : curve.contour().points_mm)
      most = std::max(most, (found * p - truth * p).norm());
  return most;
}

TEST(MatchLoops, FindsTheMotionOfALoopAmongOthers) {
  const PlatePart& part = asymmetric();
  synthetic::Random random(3);
  for (int i = 0; i < 20; ++i) {
    const RigidMotion truth = scenes::disturbance(random, {0, 0, 0}, random.uniform(0.0, 3.1), 1000.0);
    std::vector<Contour> cad, scan;
    for (const int c : {0, 1, 2}) {
      cad.push_back(part.nominal_contour(c, 1.0));
      scan.push_back(part.nominal_contour(c, 1.7));
      for (Eigen::Vector3d& p : scan.back().points_mm) p = truth * p;
      const auto start = static_cast<std::ptrdiff_t>(random.index(scan.back().points_mm.size()));
      std::rotate(scan.back().points_mm.begin(), scan.back().points_mm.begin() + start,
                  scan.back().points_mm.end());
    }
    std::reverse(scan.begin(), scan.end());
    const std::vector<LoopMatch> matches = match_loops(cad, scan);
    ASSERT_FALSE(matches.empty());
    double nearest_mm = 1e300, last_mm = 0.0;
    for (const LoopMatch& match : matches) {
      EXPECT_GE(match.rms_mm, last_mm);  // best first
      last_mm = match.rms_mm;
      if (match.cad_loop == 0 && match.scan_loop == 2)
        nearest_mm = std::min(nearest_mm, off_mm(asymmetric_cad(), match.scan_from_cad, truth));
    }
    EXPECT_LT(nearest_mm, 15.0)
        << i;  // a start shift is known to half an arc: 460 mm / 64 / 2, and what it turns
  }
}

TEST(MatchPieces, ALoopThatAGapJoinsToTheBorderIsLaidByTheStretchThatRunsAlongTheContour) {
  const Contour cad = asymmetric().nominal_contour(0, 1.0);
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : cad.points_mm) centre_mm += p / static_cast<double>(cad.points_mm.size());
  Contour joined = cad;  // 70 % of the contour, then out through the gap and back round the border
  const std::size_t along = cad.points_mm.size() * 7 / 10;
  joined.points_mm.resize(along);
  joined.normals.resize(along);
  for (std::size_t i = along; i-- > 0;) {
    joined.points_mm.push_back(centre_mm + 1.8 * (cad.points_mm[i] - centre_mm));
    joined.normals.push_back(cad.normals[i]);
  }
  synthetic::Random random(5);
  const RigidMotion truth = scenes::disturbance(random, {0, 0, 0}, 1.0, 500.0);
  for (Eigen::Vector3d& p : joined.points_mm) p = truth * p;
  for (Eigen::Vector3d& n : joined.normals) n = truth.linear() * n;
  double nearest_mm = 1e300;  // the opening looks the same after half a turn: either may come first
  for (const LoopMatch& match : match_pieces({cad}, {joined}))
    nearest_mm = std::min(nearest_mm, off_mm(asymmetric_cad(), match.scan_from_cad, truth));
  EXPECT_LT(nearest_mm, 15.0);
}

TEST(MatchLoops, LoopsOfOtherLengthsAreNotCompared) {
  Contour small = asymmetric().nominal_contour(2, 1.0), large = asymmetric().nominal_contour(0, 1.0);
  EXPECT_TRUE(match_loops({small}, {large}).empty());
  EXPECT_TRUE(match_loops({large}, {small}).empty());
  EXPECT_TRUE(match_loops({}, {large}).empty());
  EXPECT_TRUE(match_loops({large}, {}).empty());
}

TEST(CoarseAlign, MirroredScanIsCalledMirrored) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Trial trial =
        scenes::changed_trial(asymmetric(), whole_face(), seed, [](Eigen::Vector3f& p, Eigen::Vector3f& n) {
          p.x() = -p.x();
          n.x() = -n.x();
        });
    const CoarseAlignment found = coarse_align(asymmetric_cad(), trial.scan, {});
    EXPECT_FALSE(found.usable());
    EXPECT_TRUE(found.mirrored) << found.reason;
  }
}

TEST(CoarseAlign, InvertedDrawingIsCalledInverted) {
  TriangleMesh mesh = asymmetric().cad_mesh(8.0);
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  std::vector<Contour> contours;
  for (const int c : {0, 1, 2}) {
    contours.push_back(asymmetric().nominal_contour(c, 1.0));
    std::reverse(contours.back().points_mm.begin(), contours.back().points_mm.end());
    std::reverse(contours.back().normals.begin(), contours.back().normals.end());
    for (Eigen::Vector3d& n : contours.back().normals) n = -n;
  }
  const CadModel inverted = prepare_cad(mesh, contours, {});
  const CoarseAlignment found =
      coarse_align(inverted, scenes::trial_of(asymmetric(), whole_face(), 1).scan, {});
  EXPECT_FALSE(found.usable());
  EXPECT_TRUE(found.inverted) << found.reason;
}

TEST(CoarseAlign, ShapeAloneDoesNotSayWhichSideWasSeen) {
  // Mirrored and without normals the scan of a flat part is the part turned over: only the side tells.
  synthetic::ScanOptions options = whole_face();
  options.write_normals = false;
  const Trial trial = scenes::changed_trial(asymmetric(), options, 2,
                                            [](Eigen::Vector3f& p, Eigen::Vector3f&) { p.x() = -p.x(); });
  const CoarseAlignment found = coarse_align(asymmetric_cad(), trial.scan, {});
  EXPECT_FALSE(found.usable());
  EXPECT_NE(found.reason.find("which side"), std::string::npos) << found.reason;
}

TEST(CoarseAlign, ScanInAnotherUnitIsRefusedWithTheUnitThatFits) {
  for (const double ratio : {25.4, 1000.0}) {
    const float shrink = static_cast<float>(1.0 / ratio);
    const Trial trial = scenes::changed_trial(asymmetric(), whole_face(), 4,
                                              [&](Eigen::Vector3f& p, Eigen::Vector3f&) { p *= shrink; });
    const CoarseAlignment found = coarse_align(asymmetric_cad(), trial.scan, {});
    EXPECT_FALSE(found.usable()) << ratio;
    EXPECT_DOUBLE_EQ(found.unit_ratio, ratio);
  }
}

TEST(CoarseAlign, BothSidesOfAFlatPlateAreRefusedWithoutNormalsAndToldApartWithThem) {
  const PlatePart plate(synthetic::plate_with_circle());
  const CadModel cad = scenes::cad_of(plate);
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    synthetic::ScanOptions options;
    const Trial with = scenes::trial_of(plate, options, seed);
    ASSERT_EQ(with.scan.side, SideKnown::kYes);
    const CoarseAlignment sure = coarse_align(cad, with.scan, {});
    ASSERT_TRUE(sure.usable()) << sure.reason;
    EXPECT_GT((sure.scan_from_cad.linear() * Eigen::Vector3d::UnitZ())
                  .dot(with.scan_from_cad.linear() * Eigen::Vector3d::UnitZ()),
              0.99);
    options.write_normals = false;
    const Trial without = scenes::trial_of(plate, options, seed);
    ASSERT_EQ(without.scan.side, SideKnown::kNo);
    const CoarseAlignment open = coarse_align(cad, without.scan, {});
    EXPECT_FALSE(open.usable());
    EXPECT_NE(open.reason.find("side"), std::string::npos) << open.reason;
  }
}

TEST(CoarseAlign, HalfTurnOfASymmetricOpeningIsEqualForAPathRoundItAndRefusedForOneAlongAPart) {
  const PlatePart plate(synthetic::plate_with_rounded_rectangle());
  const CadModel cad = scenes::cad_of(plate);
  const Trial trial = scenes::trial_of(plate, {}, 2);
  const CoarseAlignment round = coarse_align(cad, trial.scan, {});
  ASSERT_TRUE(round.usable()) << round.reason;
  EXPECT_EQ(round.equal_poses, 2);
  Contour part = plate.nominal_contour(0, 1.0);
  part.closed = false;
  part.points_mm.resize(part.points_mm.size() / 3);
  part.normals.resize(part.points_mm.size());
  CoarseAlignOptions options;
  options.path = {part};
  const CoarseAlignment along = coarse_align(cad, trial.scan, options);
  EXPECT_FALSE(along.usable());
  EXPECT_NE(along.reason.find("two poses"), std::string::npos) << along.reason;
}

/// What stands around a part, or hides some of its rim, changes where it is found by a few millimetres at
/// most; a pose in the wrong place would be off by 30 and more.
TEST(CoarseAlign, TablesClampsLumpsAndTheBorderOfTheViewDoNotHideThePart) {
  const PlatePart plate(synthetic::plate_with_rounded_rectangle());
  const CadModel cad = scenes::cad_of(plate);
  const Curve& curve = cad.contours.front();
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const synthetic::Surroundings& around :
         {synthetic::Surroundings{30.0, 0, 0, 0.0}, synthetic::Surroundings{0.0, 1, 4, 0.0},
          synthetic::Surroundings{0.0, 0, 0, 0.1}}) {
      synthetic::ScanOptions options;
      options.around = around;
      const Trial trial = scenes::trial_of(plate, options, seed);
      const CoarseAlignment found = coarse_align(cad, trial.scan, {});
      ASSERT_TRUE(found.usable()) << seed << ": " << found.reason;
      const auto carry = [&](double, const Eigen::Vector3d& p) {
        return Eigen::Vector3d(found.scan_from_cad * p);
      };
      EXPECT_LT(scenes::distance_between(scenes::carried(curve, 10.0, carry), trial.true_curve_mm).mean_mm,
                6.0)
          << seed;
    }
}

TEST(CoarseAlign, AnotherPartIsSaidToFitNowhereNotToBeAmbiguous) {
  const Trial trial = scenes::changed_trial(
      asymmetric(), whole_face(), 5,
      [](Eigen::Vector3f& p, Eigen::Vector3f&) { p.z() = 0.004F * p.x() * p.x() - 0.004F * p.y() * p.y(); });
  const CoarseAlignment found = coarse_align(asymmetric_cad(), trial.scan, {});
  EXPECT_FALSE(found.usable());
  EXPECT_NE(found.reason.find("no pose fits"), std::string::npos) << found.reason;
}

TEST(CoarseAlign, InitialPoseIsUsedWhereItIsNearAndNeverAcceptedWrongWhereItIsFar) {
  const PlatePart plate(synthetic::plate_with_rounded_rectangle());
  const CadModel cad = scenes::cad_of(plate);
  const Trial trial = scenes::trial_of(plate, {}, 2);
  synthetic::Random random(6);
  for (int i = 0; i < 10; ++i) {
    CoarseAlignOptions options;
    const Eigen::Vector3d centre_mm(20.0, 10.0, 0.0);
    options.initial_scan_from_cad = trial.scan_from_cad * scenes::disturbance(random, centre_mm, 0.17, 10.0);
    const CoarseAlignment found = coarse_align(cad, trial.scan, options);
    ASSERT_TRUE(found.usable()) << found.reason;
    EXPECT_EQ(found.start, "initial pose");
    EXPECT_LT(off_mm(cad, found.scan_from_cad, trial.scan_from_cad), 6.0);
    // Turned by a right angle about the normal: the long side lies on the short one.
    RigidMotion turned = *options.initial_scan_from_cad;
    turned.translate(centre_mm)
        .rotate(Eigen::AngleAxisd(1.5707963, Eigen::Vector3d::UnitZ()))
        .translate(-centre_mm);
    options.initial_scan_from_cad = turned;
    const CoarseAlignment wrong = coarse_align(cad, trial.scan, options);
    EXPECT_FALSE(wrong.usable()) << "off by " << off_mm(cad, wrong.scan_from_cad, trial.scan_from_cad)
                                 << " mm, score " << wrong.score_mm;
  }
  CoarseAlignOptions far;
  far.initial_scan_from_cad = trial.scan_from_cad;
  far.initial_scan_from_cad->translation().x() += 3000.0;
  EXPECT_FALSE(coarse_align(cad, trial.scan, far).usable());
}

TEST(CoarseAlign, NoLoopIsRefusedInWords) {
  Trial trial = scenes::trial_of(PlatePart(synthetic::plate_with_circle()), {}, 1);
  trial.scan.loops.clear();
  const CoarseAlignment found = coarse_align(asymmetric_cad(), trial.scan, {});
  EXPECT_FALSE(found.usable());
  EXPECT_NE(found.reason.find("contour"), std::string::npos) << found.reason;
}

/// 100 scans, each with its own sampling and its own pose: every one that is accepted lies in the right
/// place.
TEST(SlowCoarseAlign, HundredPosesOfTheAsymmetricPlateAreRightOrRefused) {
  const synthetic::ScanOptions options = whole_face();
  int accepted = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Trial trial = scenes::trial_of(asymmetric(), options, seed);
    const CoarseAlignment found = coarse_align(asymmetric_cad(), trial.scan, {});
    if (!found.usable()) continue;
    ++accepted;
    // The bent plate itself leaves some 10 mm against its drawing; a wrong pose is off by 100 mm and more.
    EXPECT_LT(off_mm(asymmetric_cad(), found.scan_from_cad, trial.scan_from_cad), 40.0) << seed;
  }
  RecordProperty("accepted", accepted);
  EXPECT_GE(accepted, 90);
}

class SlowCoarseAlignOfFe : public testing::TestWithParam<const char*> {};

TEST_P(SlowCoarseAlignOfFe, HundredPosesAreRightOrRefused) {
  const synthetic::FePart part = scenes::fe(GetParam());
  const CadModel cad = scenes::cad_of(part);
  int accepted = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    synthetic::ScanOptions options;
    if (seed % 4 == 0) options.missing_ratio = 0.1, options.stray_ratio = 0.03;
    const Trial trial = scenes::trial_of(part, options, seed);
    const CoarseAlignment found = coarse_align(cad, trial.scan, {});
    EXPECT_FALSE(found.mirrored) << seed;  // a refusal may not accuse a right scan
    EXPECT_EQ(found.unit_ratio, 1.0) << seed;
    if (!found.usable()) continue;
    ++accepted;
    const Curve& curve = cad.contours.front();
    const scenes::Distance d = scenes::distance_between(
        scenes::carried(
            curve, 10.0,
            [&](double, const Eigen::Vector3d& p) { return Eigen::Vector3d(found.scan_from_cad * p); }),
        trial.true_curve_mm);
    // As a curve: a turn along the sheet's circle is no error. The parts' own deformation is up to 11 mm.
    if (d.mean_mm > 15.0) ++wrong;
    EXPECT_LT(d.mean_mm, 15.0) << seed;
  }
  RecordProperty("accepted", accepted);
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(accepted, 60);
}

INSTANTIATE_TEST_SUITE_P(All, SlowCoarseAlignOfFe, testing::Values("porthole", "nosecone", "sheet"),
                         [](const auto& at) { return std::string(at.param); });

}  // namespace
}  // namespace arris
