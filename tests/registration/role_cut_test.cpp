#include <gtest/gtest.h>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using scenes::Trial;
using synthetic::PlatePart;

synthetic::PlateShape bent_plate() {
  synthetic::PlateShape shape = synthetic::asymmetric_plate();
  shape.bend_curvature_per_mm = 1.5e-4;
  shape.bend_axis_rad = 0.3;
  return shape;
}

/// The part as it comes: without the opening that the tool is to cut.
PlatePart uncut() {
  synthetic::PlateShape shape = bent_plate();
  shape.holes.erase(shape.holes.begin());
  return PlatePart(shape);
}

RegistrationOptions cut_options(const PlatePart& part) {
  RegistrationOptions options;
  options.method = RegistrationMethod::kSurface;
  options.role = options.surface.role = ContourRole::kCut;
  options.mid_depth_mm = 0.5 * part.shape().thickness_mm;
  return options;
}

synthetic::ScanOptions whole_face(std::int64_t points) {
  synthetic::ScanOptions scan;
  scan.points = points;
  scan.band_mm = 0.0;
  return scan;
}

TEST(RoleCut, TakesItsPlaceFromOutlineAndDatumHoles) {
  const PlatePart drawn(bent_plate()), real = uncut();
  const CadModel cad = scenes::cad_of(drawn);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    Trial trial = scenes::trial_of(real, whole_face(8000), seed);
    const Registration found = register_part(cad, trial.scan, cut_options(drawn));
    ASSERT_TRUE(found.usable()) << (found.refusals.empty() ? "" : found.refusals.front());
    EXPECT_TRUE(found.refusals.empty()) << found.refusals.front();
    double sum_mm = 0.0, worst_mm = 0.0, count = 0.0;
    for (const synthetic::EdgePoint& edge : drawn.edge(0, 5.0)) {
      const MappedPoint mapped = found.field->map(edge.nominal_mm);
      const double off_mm = (mapped.p_scan_mm - trial.scan_from_cad * edge.true_mm).norm();
      EXPECT_TRUE(mapped.from_data);
      sum_mm += off_mm;
      count += 1.0;
      worst_mm = std::max(worst_mm, off_mm);
    }
    EXPECT_LT(sum_mm / count, 0.3);
    EXPECT_LT(worst_mm, 0.6);
  }
}

TEST(RoleCut, ARoughOpeningWithStockIsNoData) {
  // A hole 4 mm too small, and off centre by 2 mm, stands where the tool will cut: the answer stays.
  synthetic::PlateShape rough = bent_plate();
  for (double* half : {&rough.holes[0].half_x_mm, &rough.holes[0].half_y_mm}) *half -= 4.0;
  rough.holes[0].corner_radius_mm -= 4.0;
  rough.holes[0].centre_mm.x() += 2.0;
  const PlatePart drawn(bent_plate()), real(rough);
  const CadModel cad = scenes::cad_of(drawn);
  RegistrationOptions options = cut_options(drawn);
  options.surface.stock_mm = 6.0;
  Trial trial = scenes::trial_of(real, whole_face(8000), 3);
  const Registration found = register_part(cad, trial.scan, options);
  ASSERT_TRUE(found.usable()) << (found.refusals.empty() ? "" : found.refusals.front());
  EXPECT_TRUE(found.refusals.empty()) << found.refusals.front();
  double sum_mm = 0.0, count = 0.0;
  for (const synthetic::EdgePoint& edge : drawn.edge(0, 5.0)) {
    sum_mm += (found.field->map(edge.nominal_mm).p_scan_mm - trial.scan_from_cad * edge.true_mm).norm();
    count += 1.0;
  }
  EXPECT_LT(sum_mm / count, 0.3);
}

TEST(RoleCut, ASlideThatNothingHoldsIsRefusedAndNamed) {
  // Points of the middle of the plate only: no outline, no hole, and a plate slides on itself.
  const PlatePart drawn(bent_plate());
  synthetic::PlateShape plain = bent_plate();
  plain.holes.clear();
  const CadModel cad = scenes::cad_of(drawn);
  const Trial whole = scenes::ideal_trial(PlatePart(plain), {.points = 6000, .band_mm = 0.0}, 4);
  std::vector<Eigen::Vector3d> points, normals;
  for (std::size_t i = 0; i < whole.scan.points_mm.size(); ++i)
    if (std::abs(whole.scan.points_mm[i].x()) < 90.0 && std::abs(whole.scan.points_mm[i].y()) < 70.0) {
      points.push_back(whole.scan.points_mm[i]);
      normals.push_back(whole.scan.normals[i]);
    }
  ScanModel scan{points, normals,        NearestPoints(points), {}, {}, {}, whole.scan.spacing_mm,
                 0.05,   SideKnown::kYes};
  RegistrationOptions options = cut_options(drawn);
  options.coarse.initial_scan_from_cad = RigidMotion::Identity();
  const Registration found = register_part(cad, scan, options);
  ASSERT_FALSE(found.refusals.empty());
  std::string why;
  for (const std::string& refusal : found.refusals) why += refusal + "\n";
  EXPECT_NE(why.find("slide along"), std::string::npos) << why;
}

TEST(RoleCut, AContourWhoseSurroundingsWereNotScannedIsRefused) {
  // The outline and the holes hold the part; of the surface along the contour there is nothing.
  const PlatePart drawn(bent_plate());
  const CadModel cad = scenes::cad_of(drawn);
  Trial trial = scenes::trial_of(uncut(), whole_face(8000), 8);
  const RigidMotion cad_from_scan = trial.scan_from_cad.inverse();
  std::vector<Eigen::Vector3d> points, normals;
  for (std::size_t i = 0; i < trial.scan.points_mm.size(); ++i) {
    if (cad.contours[0].nearest(cad_from_scan * trial.scan.points_mm[i]).distance_mm < 30.0) continue;
    points.push_back(trial.scan.points_mm[i]);
    normals.push_back(trial.scan.normals[i]);
  }
  trial.scan.tree = NearestPoints(points);
  trial.scan.points_mm = points;
  trial.scan.normals = normals;
  const Registration found = register_part(cad, trial.scan, cut_options(drawn));
  std::string why;
  for (const std::string& refusal : found.refusals) why += refusal + "\n";
  EXPECT_NE(why.find("surface along it"), std::string::npos) << why;
}

/// A bent rectangle whose opening, beside the middle, is still to be cut: a half turn lays the outline on
/// itself, and not the path. One hole besides breaks that, where the drawing has it.
synthetic::PlateShape rectangle(bool with_mark) {
  synthetic::PlateShape shape;
  shape.holes.push_back({{40.0, 20.0}, 60.0, 60.0, 60.0, 0.0});
  if (with_mark) shape.holes.push_back({{-150.0, -100.0}, 12.0, 12.0, 12.0, 0.0});
  shape.bend_curvature_per_mm = 1.0 / 1500.0;
  shape.bend_axis_rad = 0.5;
  shape.dents.push_back({{-90.0, 60.0}, 80.0, 2.5});  // no half turn leaves the bent plate as it is
  return shape;
}

Trial uncut_rectangle(bool with_mark, std::uint64_t seed) {
  synthetic::PlateShape shape = rectangle(with_mark);
  shape.holes.erase(shape.holes.begin());
  return scenes::trial_of(PlatePart(shape), whole_face(8000), seed);
}

/// Farthest that a place of the path comes to lie from where the material is.
double most_off_mm(const PlatePart& drawn, const Registration& found, const RigidMotion& scan_from_cad) {
  double most_mm = 0.0;
  for (const synthetic::EdgePoint& edge : drawn.edge(0, 5.0))
    most_mm = std::max(most_mm,
                       (found.field->map(edge.nominal_mm).p_scan_mm - scan_from_cad * edge.true_mm).norm());
  return most_mm;
}

TEST(RoleCut, AHalfTurnThatNothingTellsIsRefusedHoweverThePartIsBent) {
  const CadModel cad = scenes::cad_of(PlatePart(rectangle(false)));
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Trial trial = uncut_rectangle(false, seed);
    RegistrationOptions options = cut_options(PlatePart(rectangle(false)));
    options.coarse.ambiguity_ratio = 1.0;  // whichever pose fits better: the dent alone says so
    const Registration found = register_part(cad, trial.scan, options);
    ASSERT_FALSE(found.refusals.empty()) << seed;
    EXPECT_NE(found.refusals.front().find("two poses fit alike: turned by"), std::string::npos)
        << found.refusals.front();
    EXPECT_NE(found.refusals.front().find("scan.initial"), std::string::npos) << found.refusals.front();
  }
}

TEST(RoleCut, AMarkInTheScanTellsTheHalfTurnsApart) {
  const PlatePart drawn(rectangle(true));
  const CadModel cad = scenes::cad_of(drawn);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    Trial trial = uncut_rectangle(true, seed);
    const Registration found = register_part(cad, trial.scan, cut_options(drawn));
    ASSERT_TRUE(found.usable() && found.refusals.empty())
        << (found.refusals.empty() ? "" : found.refusals.front());
    EXPECT_LT(most_off_mm(drawn, found, trial.scan_from_cad), 0.6) << seed;
  }
  // Drawn, and not in the scan: it tells nothing.
  Trial without = uncut_rectangle(false, 4);
  EXPECT_FALSE(register_part(cad, without.scan, cut_options(drawn)).refusals.empty());
}

TEST(RoleCut, AnInitialPoseChoosesBetweenTheHalfTurns) {
  const PlatePart drawn(rectangle(false));
  const CadModel cad = scenes::cad_of(drawn);
  synthetic::Random random(7);
  Trial trial = uncut_rectangle(false, 1);
  RegistrationOptions options = cut_options(drawn);
  options.coarse.initial_scan_from_cad =
      trial.scan_from_cad * scenes::disturbance(random, {0, 0, 0}, 0.09, 10.0);
  const Registration found = register_part(cad, trial.scan, options);
  ASSERT_TRUE(found.usable() && found.refusals.empty())
      << (found.refusals.empty() ? "" : found.refusals.front());
  EXPECT_LT(most_off_mm(drawn, found, trial.scan_from_cad), 0.6);
}

}  // namespace
}  // namespace arris
