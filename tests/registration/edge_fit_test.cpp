#include "registration/edge_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "acquisition/contour_extract.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using synthetic::PlatePart;

constexpr double kRadiusMm = 60.0, kSpacingMm = 2.0;

/// Uniform random points of a plate around a round hole at the origin: radius, then whatever a test adds.
struct Ring {
  double radius_mm = kRadiusMm;
  double noise_sigma_mm = 0.05;
  double stray_ratio = 0.0;  ///< inside the hole, uniform over 6 mm beyond the edge
  double wall_ratio = 0.0;   ///< on the wall of the cut, down to 3 mm
  double gap_from_rad = 0.0, gap_to_rad = 0.0;
};

ScanModel scan_of(const Ring& ring, std::uint64_t seed) {
  synthetic::Random random(seed);
  std::vector<Eigen::Vector3d> points;
  const auto add = [&](double r, double angle, double z) {
    if (angle > ring.gap_from_rad && angle < ring.gap_to_rad) return;
    points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  };
  const double outer_mm = kRadiusMm + 40.0, pi = 3.14159265358979323846;
  const int count = static_cast<int>(pi * (outer_mm * outer_mm - ring.radius_mm * ring.radius_mm) /
                                     (kSpacingMm * kSpacingMm));
  for (int i = 0; i < count; ++i) {
    const double r2 = random.uniform(ring.radius_mm * ring.radius_mm, outer_mm * outer_mm);
    add(std::sqrt(r2), random.uniform(0.0, 2.0 * pi), ring.noise_sigma_mm * random.normal());
  }
  for (int i = 0; i < ring.stray_ratio * count; ++i)
    add(ring.radius_mm - random.uniform(0.0, 6.0), random.uniform(0.0, 2.0 * pi), random.uniform(-3.0, 3.0));
  for (int i = 0; i < ring.wall_ratio * count; ++i)
    add(ring.radius_mm, random.uniform(0.0, 2.0 * pi), random.uniform(-3.0, 0.0));
  const std::vector<Eigen::Vector3d> normals(points.size(), Eigen::Vector3d::UnitZ());
  return {points,         normals, NearestPoints(points), {}, {}, {}, kSpacingMm, ring.noise_sigma_mm,
          SideKnown::kYes};
}

class EdgeFitOnRing : public testing::Test {
 protected:
  static synthetic::PlateShape shape() {
    synthetic::PlateShape out = synthetic::plate_with_circle(kRadiusMm);
    out.holes[0].centre_mm.setZero();
    return out;
  }
  EdgeFit fit(const ScanModel& scan) const { return fit_edge(cad_, 0, scan, motion_, {}); }
  /// Distance of the found edge to the true circle, signed: positive when the hole is found too large.
  double error_mm(const EdgeFit& edge, double arc_mm, double radius_mm = kRadiusMm) const {
    const Eigen::Vector3d p = edge_point_mm(cad_, 0, motion_, edge, arc_mm);
    return std::hypot(p.x(), p.y()) - radius_mm;
  }
  double mean_error_mm(const EdgeFit& edge, double radius_mm = kRadiusMm) const {
    double sum = 0.0;
    for (int i = 0; i < 200; ++i) sum += error_mm(edge, length_mm() * i / 200.0, radius_mm) / 200.0;
    return sum;
  }
  double worst_mm(const EdgeFit& edge, bool seen_only) const {
    double worst = 0.0;
    for (int i = 0; i < 400; ++i) {
      const double s = length_mm() * i / 400.0;
      if (!seen_only || edge.seen_at(s)) worst = std::max(worst, std::abs(error_mm(edge, s)));
    }
    return worst;
  }
  double length_mm() const { return cad_.contours.front().length_mm(); }

  PlatePart part_{shape()};
  CadModel cad_ = scenes::cad_of(part_);
  ContourMotion motion_ = scenes::rigid_along(cad_.contours.front(), RigidMotion::Identity());
  // Yardstick of one knot: the last point lies about 1 / (density * 40 mm) from the edge.
  double limit_mm_ = kSpacingMm * kSpacingMm / 40.0;
};

TEST_F(EdgeFitOnRing, IsUnbiasedOnUniformPointsAndItsSdIsHonest) {
  double sum = 0.0, sum2 = 0.0, normalised2 = 0.0, height2 = 0.0;
  const int runs = 50, places = 12;
  for (int run = 0; run < runs; ++run) {
    const EdgeFit edge = fit(scan_of({}, 100 + static_cast<std::uint64_t>(run)));
    const double mean = mean_error_mm(edge);
    sum += mean / runs;
    sum2 += mean * mean / runs;
    for (int i = 0; i < places; ++i) {
      const double s = length_mm() * i / places;
      const SplineRow row = edge.spline.at(s);
      double variance = 0.0;
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
          variance += row.value[a] * row.value[b] * edge.across_covariance(row.index[a], row.index[b]);
      normalised2 += std::pow(error_mm(edge, s), 2) / variance / (runs * places);
      height2 += std::pow(row.dot(edge.height), 2) / (runs * places);
    }
    EXPECT_GT(edge.seen_ratio(), 0.9);
    EXPECT_NEAR(edge.density_per_mm2 * kSpacingMm * kSpacingMm, 1.0, 0.25);
  }
  // The scatter of the mean is real; a bias would be a part of the yardstick that no averaging removes.
  const double standard_error = std::sqrt((sum2 - sum * sum) / runs);
  RecordProperty("bias_um", static_cast<int>(1000 * sum));
  RecordProperty("rms_normalised_permille", static_cast<int>(1000 * std::sqrt(normalised2)));
  EXPECT_LT(std::abs(sum), 2.0 * standard_error + 0.15 * limit_mm_) << "standard error " << standard_error;
  EXPECT_GT(std::sqrt(normalised2), 0.3);
  EXPECT_LT(std::sqrt(normalised2), 2.0);
  EXPECT_LT(std::sqrt(height2), 0.05 / 2.0);  // some 40 points a knot hold each height
}

TEST_F(EdgeFitOnRing, BeatsTheMeanOfBoundaryPointsByFive) {
  double fitted = 0.0, naive = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ScanModel scan = scan_of({}, seed);
    fitted += std::abs(mean_error_mm(fit(scan))) / 5.0;
    const LocalPlanes planes = fit_local_planes(scan.points_mm, scan.tree, 12, 1);
    double sum = 0.0, count = 0.0;
    for (const std::int32_t i : boundary_points(scan.points_mm, scan.tree, planes, {})) {
      const Eigen::Vector3d& p = scan.points_mm[static_cast<std::size_t>(i)];
      const double r = std::hypot(p.x(), p.y());
      if (r < kRadiusMm + 8.0) sum += r - kRadiusMm, count += 1.0;
    }
    naive += sum / count / 5.0;
  }
  EXPECT_GT(naive, 0.2 * kSpacingMm);
  EXPECT_LT(fitted, naive / 5.0);
}

TEST_F(EdgeFitOnRing, FindsAHoleThatIsTooLargeOrTooSmall) {
  for (const double more_mm : {0.3, -0.3, 1.0}) {
    Ring ring;
    ring.radius_mm = kRadiusMm + more_mm;
    double mean = 0.0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed)
      mean += mean_error_mm(fit(scan_of(ring, seed)), ring.radius_mm) / 8.0;
    EXPECT_LT(std::abs(mean), limit_mm_) << more_mm;
  }
}

TEST_F(EdgeFitOnRing, StraysAndWallPointsMoveItByAboutTheYardstick) {
  Ring ring;
  ring.stray_ratio = 0.05;
  ring.wall_ratio = 0.03;
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const EdgeFit edge = fit(scan_of(ring, seed));
    mean += mean_error_mm(edge) / 24.0;
    EXPECT_LT(worst_mm(edge, true), 0.5 * kSpacingMm) << seed;
  }
  RecordProperty("mean_um", static_cast<int>(1000 * mean));
  EXPECT_LT(std::abs(mean), 1.25 * limit_mm_);  // outwards: strays lie there
}

TEST_F(EdgeFitOnRing, GapIsNotSeenAndIsBridgedSmoothly) {
  Ring ring;
  ring.gap_from_rad = 1.0;
  ring.gap_to_rad = 2.0;  // 60 mm of 377
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const EdgeFit edge = fit(scan_of(ring, seed));
    const Curve& curve = cad_.contours.front();
    int wrong = 0, inside = 0;
    for (double angle = 0.05; angle < 6.25; angle += 0.02) {
      const double s = curve.nearest({kRadiusMm * std::cos(angle), kRadiusMm * std::sin(angle), 0.0}).arc_mm;
      // One bin of doubt on either side.
      const double doubt_rad = edge.bin_mm / kRadiusMm;
      if (angle > 1.0 + doubt_rad && angle < 2.0 - doubt_rad) {
        ++inside;
        EXPECT_FALSE(edge.seen_at(s)) << angle;
      } else if (angle < 1.0 - 2 * doubt_rad || angle > 2.0 + 2 * doubt_rad) {
        wrong += edge.seen_at(s) ? 0 : 1;
      }
    }
    EXPECT_GT(inside, 20);
    EXPECT_LT(wrong, 25);  // a tenth of the rest: a bin holds 8 points, some happen to be thin
    EXPECT_LT(worst_mm(edge, false), 0.75 * kSpacingMm) << seed;
  }
}

TEST_F(EdgeFitOnRing, SurfaceBesideTheEdgeIsTakenForScannedWhereThereArePoints) {
  Ring ring;
  ring.gap_from_rad = 1.0;
  ring.gap_to_rad = 2.0;
  ScanModel scan = scan_of(ring, 4);
  // Beyond the gap the last rows before the edge are missing: no edge, but surface.
  std::vector<Eigen::Vector3d> left;
  for (const Eigen::Vector3d& p : scan.points_mm)
    if (std::hypot(p.x(), p.y()) > kRadiusMm + 4.0 * kSpacingMm || p.y() > 0.0) left.push_back(p);
  scan.points_mm = left;
  scan.normals.assign(left.size(), Eigen::Vector3d::UnitZ());
  const EdgeFit edge = fit(scan);
  const auto bin_at = [&](double angle_rad) {
    const Eigen::Vector3d p_mm(kRadiusMm * std::cos(angle_rad), kRadiusMm * std::sin(angle_rad), 0.0);
    return static_cast<std::size_t>(cad_.contours.front().nearest(p_mm).arc_mm / edge.bin_mm);
  };
  EXPECT_FALSE(edge.beside[bin_at(1.5)]) << "a gap";
  EXPECT_TRUE(edge.beside[bin_at(0.5)]) << "edge and surface";
  EXPECT_TRUE(edge.beside[bin_at(4.5)]) << "surface alone";
  EXPECT_FALSE(edge.seen[bin_at(4.5)]);
}

TEST_F(EdgeFitOnRing, ClampOverMostOfTheStripDoesNotSpoilTheHeights) {
  Ring ring;
  const ScanModel bare = scan_of(ring, 6);
  std::vector<Eigen::Vector3d> points = bare.points_mm;
  for (const Eigen::Vector3d& p : bare.points_mm) {  // over two thirds of it, sloping up from 1.5 mm
    if (std::atan2(p.y(), p.x()) > 1.1) continue;
    const double over_mm = 1.5 + 0.15 * (std::hypot(p.x(), p.y()) - kRadiusMm);
    points.insert(points.end(), 2, p + Eigen::Vector3d(0.1, 0.1, over_mm));
  }
  const std::vector<Eigen::Vector3d> normals(points.size(), Eigen::Vector3d::UnitZ());
  const ScanModel scan{points, normals, NearestPoints(points), {}, {}, {}, kSpacingMm, 0.05, SideKnown::kYes};
  EdgeFitOptions options;
  options.start_sigma_mm = 0.05;
  const EdgeFit edge = fit_edge(cad_, 0, scan, motion_, options);
  EXPECT_LT(edge.residual_sigma_mm, 0.2);  // with the clamp in it 1.2
  for (int i = 0; i < 12; ++i)
    EXPECT_NEAR(edge.spline.at(length_mm() * i / 12.0).dot(edge.height), 0.0, 0.1) << i;
}

TEST_F(EdgeFitOnRing, SameBytesForAnyThreadCount) {
  const ScanModel scan = scan_of({}, 3);
  EdgeFitOptions options;
  options.threads = 1;
  const EdgeFit one = fit_edge(cad_, 0, scan, motion_, options);
  for (const int threads : {2, 8}) {
    options.threads = threads;
    const EdgeFit many = fit_edge(cad_, 0, scan, motion_, options);
    EXPECT_EQ(one.across, many.across);
    EXPECT_EQ(one.height, many.height);
    EXPECT_EQ(one.tilt, many.tilt);
  }
}

TEST_F(EdgeFitOnRing, HeightAndTiltOfALiftedEdgeAreFound) {
  ScanModel scan = scan_of({}, 9);
  const double lift_mm = 0.4, slope = 0.02;
  for (Eigen::Vector3d& p : scan.points_mm)
    p.z() += lift_mm + slope * std::max(0.0, std::hypot(p.x(), p.y()) - kRadiusMm);
  const EdgeFit edge = fit(scan);
  for (int i = 0; i < 12; ++i) {
    const SplineRow row = edge.spline.at(length_mm() * i / 12.0);
    EXPECT_NEAR(row.dot(edge.height), lift_mm, 0.06);
    EXPECT_NEAR(row.dot(edge.tilt), slope, 0.01);
  }
}

TEST_F(EdgeFitOnRing, AnEdgeThatMovedIntoTheMaterialIsNoGap) {
  // Half of the hole has grown by 7 mm: from where the edge was, its strip is empty there.
  ScanModel scan = scan_of({}, 12);
  const auto true_radius = [](double angle) { return kRadiusMm + 3.5 * (1.0 + std::cos(angle)); };
  std::vector<Eigen::Vector3d> left;
  for (const Eigen::Vector3d& p : scan.points_mm)
    if (std::hypot(p.x(), p.y()) > true_radius(std::atan2(p.y(), p.x()))) left.push_back(p);
  scan.points_mm = left;
  scan.normals.assign(left.size(), Eigen::Vector3d::UnitZ());
  EdgeFitOptions loose;
  loose.bend_across_per_mm *= 8.0;
  const EdgeFit edge = fit_edge(cad_, 0, scan, motion_, loose);
  EXPECT_GT(edge.seen_ratio(), 0.95);
  for (int i = 0; i < 60; ++i) {
    const double s = length_mm() * i / 60.0;
    const Eigen::Vector3d p = edge_point_mm(cad_, 0, motion_, edge, s);
    EXPECT_NEAR(std::hypot(p.x(), p.y()), true_radius(std::atan2(p.y(), p.x())), 1.0) << s;
  }
}

TEST(EdgeFitOnRows, RowsAlongAnEdgeLeaveItOpenBetweenTwoOfThem) {
  synthetic::PlateShape shape = synthetic::plate_with_rounded_rectangle();
  shape.holes[0].centre_mm.setZero();
  shape.holes[0].turn_rad = 0.0;
  const PlatePart part(shape);
  const CadModel cad = scenes::cad_of(part);
  const double row_mm = 10.0, half_y_mm = shape.holes[0].half_y_mm, half_x_mm = shape.holes[0].half_x_mm;
  std::vector<Eigen::Vector3d> points;  // rows along x, the last one 2 mm above the hole
  for (double y = half_y_mm + 2.0 - 15.0 * row_mm; y < half_y_mm + 40.0; y += row_mm)
    for (double x = -130.0; x < 130.0; x += 0.2 * row_mm)
      if (part.void_distance_mm(x, y) < 0.0) points.emplace_back(x, y, 0.0);
  const std::vector<Eigen::Vector3d> normals(points.size(), Eigen::Vector3d::UnitZ());
  const ScanModel scan{points, normals,        NearestPoints(points), {}, {}, {}, row_mm / std::sqrt(5.0),
                       0.0,    SideKnown::kYes};
  const Curve& curve = cad.contours[0];
  const EdgeFit edge = fit_edge(cad, 0, scan, scenes::rigid_along(curve, RigidMotion::Identity()), {});
  const double top = curve.nearest({0.0, half_y_mm, 0.0}).arc_mm;
  const double right = curve.nearest({half_x_mm, 0.0, 0.0}).arc_mm;
  EXPECT_NEAR(edge.row_gap_at_mm(top), row_mm, 0.01);
  EXPECT_GT(edge.sd_across_mm(top, true), row_mm / std::sqrt(12.0));
  EXPECT_EQ(edge.row_gap_at_mm(right), 0.0);  // there every row ends at the edge
  EXPECT_LT(edge.sd_across_mm(right, true), 1.0);
}

/// Shorter all round than the stretch over which rows are looked for, or than a bin is long.
TEST(EdgeFitOnSmallHole, IsFoundAndSeen) {
  for (const double radius_mm : {2.1, 0.6, 0.25}) {
    synthetic::PlateShape shape = synthetic::plate_with_circle(radius_mm);
    shape.holes[0].centre_mm.setZero();
    const CadModel cad = scenes::cad_of(PlatePart(shape));
    synthetic::Random random(3);
    std::vector<Eigen::Vector3d> points;
    while (points.size() < 4000) {
      const Eigen::Vector3d p(random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0), 0.0);
      if (p.norm() > radius_mm) points.push_back(p);
    }
    const std::vector<Eigen::Vector3d> normals(points.size(), Eigen::Vector3d::UnitZ());
    const ScanModel scan{points, normals, NearestPoints(points), {}, {}, {}, 0.25, 0.0, SideKnown::kYes};
    const EdgeFit edge =
        fit_edge(cad, 0, scan, scenes::rigid_along(cad.contours[0], RigidMotion::Identity()), {});
    EXPECT_GT(edge.seen_ratio(), 0.8) << radius_mm;
    EXPECT_EQ(edge.row_gap_mm.size(), edge.seen.size());
    for (const double gap_mm : edge.row_gap_mm) EXPECT_LT(gap_mm, 0.25) << radius_mm;  // the spacing
  }
}

TEST_F(EdgeFitOnRing, PointsInRandomPlacesAreNoRows) {
  std::size_t bins = 0, called_rows = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const EdgeFit edge = fit(scan_of({}, seed));
    bins += edge.row_gap_mm.size();
    for (const double gap_mm : edge.row_gap_mm) called_rows += gap_mm > 0.0 ? 1 : 0;
  }
  EXPECT_LT(static_cast<double>(called_rows), 0.03 * static_cast<double>(bins));
}

}  // namespace
}  // namespace arris
