#include "registration/edge_strips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "registration/surface_nodes.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

constexpr double kStripMm = 10.0, kReachMm = 20.0, kSpacingMm = 2.0, kTauMm = 0.1, kGateMm = 0.2;

/// A flat plate's hole, points of the material beside it and strays in the opening.
struct Strip {
  synthetic::PlatePart part{synthetic::plate_with_rounded_rectangle()};
  CadModel cad = scenes::cad_of(part);
  SurfaceBasis basis{place_nodes({&cad.contours[0]}, band_cells(cad, 40.0, 12.0), 30.0)};
  std::vector<Eigen::Vector3d> still = std::vector<Eigen::Vector3d>(basis.size(), Eigen::Vector3d::Zero());
  EdgeStrips strips{{&cad.contours[0]}, basis, kStripMm, kSpacingMm, 0.0};

  /// wall_per_mm: points below each mm of the edge, down to 2 mm.
  Strip(double stray_ratio, std::uint64_t seed, double wall_per_mm = 0.0) {
    synthetic::Random random(seed);
    const Curve& curve = cad.contours[0];
    std::vector<SurfacePair> pairs;
    const auto shower = [&](double density_per_mm2, double from_mm, double to_mm) {
      const double area_mm2 = curve.length_mm() * (to_mm - from_mm);
      for (double left = density_per_mm2 * area_mm2; left > 0.0; left -= 1.0) {
        const double s_mm = random.uniform(0.0, curve.length_mm()), g_mm = random.uniform(from_mm, to_mm);
        const Eigen::Vector3d inward = cad.inward(0, s_mm);
        SurfacePair pair;
        pair.p_mm = curve.point_mm(s_mm) + g_mm * inward;
        if (std::abs(curve.nearest(pair.p_mm).distance_mm - std::abs(g_mm)) > 1e-6)
          continue;  // straight sides alone: uniform along and across is uniform in area there
        pair.normal = curve.normal(s_mm);
        pair.on_face = g_mm > 0.0;
        pair.residual_mm = 0.95 * kGateMm * std::sin(left);
        pairs.push_back(pair);
      }
    };
    const double density_per_mm2 = 1.0 / (kSpacingMm * kSpacingMm);
    shower(density_per_mm2, 0.0, kStripMm);
    shower(stray_ratio * density_per_mm2, -kReachMm, 0.0);
    for (double s_mm = 0.0; s_mm < curve.length_mm() && wall_per_mm > 0.0; s_mm += 1.0 / wall_per_mm) {
      SurfacePair pair;
      pair.residual_mm = -random.uniform(0.0, 2.0);
      pair.p_mm = curve.point_mm(s_mm) + pair.residual_mm * curve.normal(s_mm);
      pair.normal = curve.normal(s_mm);
      pair.on_face = true;
      pairs.push_back(pair);
    }
    strips.update(pairs, still, {0.0}, kReachMm, kGateMm, true, 1);
  }
};

TEST(EdgeStrips, CountsStraysBesideTheMaterialsDensity) {
  for (const double truth : {0.005, 0.02}) {
    double mean = 0.0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) mean += Strip(truth, seed).strips.stray_ratio() / 8;
    EXPECT_NEAR(mean, truth, 0.3 * truth);
  }
}

TEST(EdgeStrips, WithoutStraysSaysHowFewThereMayBe) {
  const double ratio = Strip(0.0, 1).strips.stray_ratio();
  EXPECT_GT(ratio, 0.0);
  EXPECT_LT(ratio, 2e-3);
}

/// Law: of a wall's points, which scatter across the edge, only those level with it within half the gate are
/// taken for points of the face; without a wall the whole gate is open.
TEST(EdgeStrips, AWallInTheScanHalvesTheGate) {
  for (const double wall_per_mm : {0.5, 0.002}) {
    double highest_mm = 0.0;
    const Strip strip(0.0, 5, wall_per_mm);
    for (const EdgeStrips::Point& point : strip.strips.points())
      if (point.weight > 0.0) highest_mm = std::max(highest_mm, std::abs(point.height_mm));
    const double gate_mm = wall_per_mm > 0.1 ? 0.5 * kGateMm : 0.95 * kGateMm;
    EXPECT_LE(highest_mm, gate_mm);
    EXPECT_GT(highest_mm, 0.9 * gate_mm);
  }
}

TEST(EdgeStrips, APointLevelWithTheFaceMayBeOneOfTheWallTheLowerTheMore) {
  const Strip wall(0.0, 5, 2.0), bare(0.0, 5);
  for (const EdgeStrips::Point& point : bare.strips.points()) EXPECT_EQ(point.wall.width_mm, 0.0);
  const double sigma_mm = 0.25 * kGateMm, per_mm2 = 2.0 / 2.0;
  const double material_per_mm2 = wall.strips.greatest_density_per_mm2();
  int judged = 0;
  for (const EdgeStrips::Point& point : wall.strips.points()) {
    if (point.weight <= 0.0) continue;
    const double z = point.height_mm / sigma_mm;
    const double truth_mm = per_mm2 * 0.5 * std::erfc(z / std::sqrt(2.0)) * sigma_mm *
                            std::sqrt(2.0 * 3.14159265) * std::exp(0.5 * z * z) / material_per_mm2;
    EXPECT_NEAR(point.wall.width_mm / truth_mm, 1.0, 0.2) << z;  // the wall's density is an estimate
    ++judged;
  }
  EXPECT_GT(judged, 100);
}

/// Law: tangents and resistance together are the whole change of the points' cost, worked out here anew.
TEST(EdgeStrips, ResistanceIsWhatTheTangentsLeaveOut) {
  const double stray_ratio = 1e-3;
  const Strip strip(0.0, 3);
  SurfaceSystem tangents(strip.basis.band(), 1);
  strip.strips.add(0, strip.strips.points().size(), {0.0}, kTauMm, stray_ratio, tangents);
  const Eigen::MatrixXd curvature = tangents.dense();
  const auto cost = [&](double inside_mm) {
    const double seen = 1.0 / (1.0 + std::exp(-(inside_mm / kTauMm - 0.541)));
    return -std::log(seen + stray_ratio) + std::clamp(inside_mm, 0.0, kStripMm) / kStripMm;
  };
  for (const double by_mm : {-1.0, -0.2, 1e-3, 0.2, 1.0, 3.0}) {
    Eigen::VectorXd move = Eigen::VectorXd::Zero(tangents.gradient.size());
    move[move.size() - 1] = by_mm;  // all round into the material
    double change = 0.0;
    for (const EdgeStrips::Point& point : strip.strips.points())
      if (point.weight > 0.0)
        change += point.weight * (cost(point.foot.across_mm - by_mm) - cost(point.foot.across_mm));
    const double tangent = tangents.gradient.dot(move) + 0.5 * move.dot(curvature * move);
    const double resistance = strip.strips.resistance(tangents, move, {0.0}, kTauMm, stray_ratio, {});
    EXPECT_NEAR(tangent + resistance, change, 1e-9 + 0.01 * std::abs(change)) << by_mm;
  }
}

}  // namespace
}  // namespace arris
