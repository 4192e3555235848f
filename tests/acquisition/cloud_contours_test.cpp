#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>
#include <set>
#include <tuple>

#include "acquisition/clean.hpp"
#include "tests/acquisition/plate_clouds.hpp"

namespace arris {
namespace {

using testing::circle;
using testing::contours_of;
using testing::error_of_loop;
using testing::LoopError;
using testing::Plate;
using testing::Random;
using testing::Rounded;
using testing::sampled;
using testing::Sampling;

constexpr Sampling kSamplings[] = {Sampling::kGrid, Sampling::kRandom, Sampling::kRows};
constexpr double kSpacing_mm = 1.0;  // of every sampled plate

/// The found loop that lies on the curve; null when there is not exactly one.
const FoundContour* loop_on(const ContourSet& set, const Rounded& curve, bool void_is_inside) {
  const FoundContour* loop = nullptr;
  for (const FoundContour& found : set.found) {
    if (std::abs(error_of_loop(found.contour, curve, void_is_inside).mean_mm) > 3.0 * kSpacing_mm) continue;
    if (loop != nullptr) return nullptr;
    loop = &found;
  }
  return loop;
}

/// One closed loop on the curve, as long as it within 15 %, its points 0.2 to 1.5 spacings inside the
/// material.
void expect_shows(const ContourSet& set, const Rounded& curve, bool void_is_inside) {
  const FoundContour* loop = loop_on(set, curve, void_is_inside);
  ASSERT_NE(loop, nullptr) << set.found.size() << " loops found";
  EXPECT_TRUE(loop->contour.closed);
  EXPECT_NEAR(loop->length_mm / curve.length_mm(), 1.0, 0.15);
  const LoopError error = error_of_loop(loop->contour, curve, void_is_inside);
  EXPECT_GT(error.mean_mm, 0.2 * kSpacing_mm);
  EXPECT_LT(error.mean_mm, 1.5 * kSpacing_mm);
}

/// The points of all loops, each as often as it is in one, in an order of their own.
std::multiset<std::tuple<double, double, double>> points_of(const ContourSet& set) {
  std::multiset<std::tuple<double, double, double>> points;
  for (const FoundContour& found : set.found)
    for (const Eigen::Vector3d& p_mm : found.contour.points_mm) points.emplace(p_mm.x(), p_mm.y(), p_mm.z());
  return points;
}

TEST(CloudContours, FindsARoundHoleHoweverItIsSampled) {
  for (const Sampling sampling : kSamplings)
    for (unsigned seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(static_cast<int>(sampling));
      const Plate plate;
      const ContourSet set = contours_of(sampled(plate, sampling, seed));
      EXPECT_EQ(set.found.size(), 2U);
      expect_shows(set, plate.holes[0], true);
      expect_shows(set, plate.outline, false);
      EXPECT_EQ(set.found[0].contour.id, 1);
      EXPECT_GE(set.found[0].length_mm, set.found[1].length_mm);
    }
}

TEST(CloudContours, WalksAroundAHoleInOrder) {
  for (const Sampling sampling : kSamplings) {
    const Plate plate;
    const ContourSet set = contours_of(sampled(plate, sampling));
    const FoundContour* loop = loop_on(set, plate.holes[0], true);
    ASSERT_NE(loop, nullptr);
    const auto& points_mm = loop->contour.points_mm;
    double turned_rad = 0.0, back_rad = 0.0;
    for (std::size_t i = 0; i < points_mm.size(); ++i) {
      const Eigen::Vector2d a = points_mm[i].head<2>() - plate.holes[0].centre_mm;
      const Eigen::Vector2d b = points_mm[(i + 1) % points_mm.size()].head<2>() - plate.holes[0].centre_mm;
      const double step_rad = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
      turned_rad += step_rad;
      back_rad = std::max(back_rad, step_rad);
    }
    // Clockwise about the air side's normal: the material is on the left. Once around.
    EXPECT_NEAR(turned_rad, -2.0 * std::numbers::pi, 1e-9);
    EXPECT_LT(back_rad, 1e-9 + 0.5 * kSpacing_mm / 30.0);
  }
}

TEST(CloudContours, PutsTheMaterialOnTheLeftAgainstTheNormals) {
  const Plate plate;
  const auto points_mm = sampled(plate, Sampling::kRandom);
  for (const double side : {1.0, -1.0}) {
    const ContourSet set = contours_of(points_mm, {}, {0.0, 0.0, side * 1e4});
    ASSERT_EQ(set.found.size(), 2U);
    EXPECT_GT(side * testing::turn_mm2(set.found[0].contour), 0.0);  // outline
    EXPECT_LT(side * testing::turn_mm2(set.found[1].contour), 0.0);  // hole
    for (const Eigen::Vector3d& n : set.found[0].contour.normals) EXPECT_GT(side * n.z(), 0.99);
  }
}

TEST(CloudContours, FindsARoundedRectangleAndItsBend) {
  Plate plate;
  plate.holes = {{{2.0, 3.0}, 40.0, 25.0, 12.0}};
  for (const Sampling sampling : kSamplings) {
    SCOPED_TRACE(static_cast<int>(sampling));
    const ContourSet set = contours_of(sampled(plate, sampling));
    EXPECT_EQ(set.found.size(), 2U);
    expect_shows(set, plate.holes[0], true);
    // A ragged edge shows its bend to within a factor of two.
    EXPECT_GT(set.found.back().min_bend_radius_mm, 0.5 * 12.0);
    EXPECT_LT(set.found.back().min_bend_radius_mm, 2.0 * 12.0);
  }
}

TEST(CloudContours, TellsTwoHolesAndTheOutlineApart) {
  Plate plate;
  plate.holes = {circle(-25.0, 5.0, 18.0), circle(25.0, -8.0, 10.0)};
  for (const Sampling sampling : kSamplings) {
    SCOPED_TRACE(static_cast<int>(sampling));
    const ContourSet set = contours_of(sampled(plate, sampling));
    EXPECT_EQ(set.found.size(), 3U);
    for (const Rounded& hole : plate.holes) expect_shows(set, hole, true);
    expect_shows(set, plate.outline, false);
  }
}

TEST(CloudContours, StaysAtTheEdgeWithNoise) {
  const Plate plate;
  for (const Sampling sampling : kSamplings)
    for (const double sigma_mm : {0.02, 0.05, 0.1}) {
      SCOPED_TRACE(sigma_mm);
      auto points_mm = sampled(plate, sampling, 3);
      testing::add_noise(points_mm, sigma_mm);
      const ContourSet set = contours_of(points_mm);
      EXPECT_EQ(set.found.size(), 2U);
      expect_shows(set, plate.holes[0], true);
    }
}

TEST(CloudContours, GoesAroundMissingPatches) {
  const Plate plate;
  for (const Sampling sampling : kSamplings) {
    SCOPED_TRACE(static_cast<int>(sampling));
    auto points_mm = sampled(plate, sampling, 2);
    // Two patches cut the hole's edge, one lies in the material.
    const Rounded gone[] = {circle(30.0, 0.0, 6.0), circle(-20.0, -22.0, 7.0), circle(-45.0, 45.0, 6.0)};
    std::erase_if(points_mm, [&](const Eigen::Vector3d& p_mm) {
      return std::any_of(std::begin(gone), std::end(gone),
                         [&](const Rounded& g) { return g.signed_mm(p_mm) < 0.0; });
    });
    const ContourSet set = contours_of(points_mm);
    ASSERT_EQ(set.found.size(), 3U);
    const FoundContour* loop = loop_on(set, plate.holes[0], true);
    ASSERT_NE(loop, nullptr);
    EXPECT_TRUE(loop->contour.closed);
    // What the patches cover of the edge is not shown by it; all the rest is.
    const double lost_ratio = (2.0 * 6.0 + 2.0 * 7.0) / plate.holes[0].length_mm();
    EXPECT_NEAR(testing::covered_ratio(loop->contour, plate.holes[0], 2.5), 1.0 - lost_ratio, 0.06);
    expect_shows(set, gone[2], true);
  }
}

TEST(CloudContours, IgnoresStraysAndTheWallOfTheCut) {
  const Plate plate;
  for (const Sampling sampling : kSamplings)
    for (unsigned seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(static_cast<int>(sampling));
      auto points_mm = sampled(plate, sampling, seed);
      testing::add_noise(points_mm, 0.03, seed);
      const std::size_t good = points_mm.size();
      Random random(seed + 10);
      const auto on_the_edge = [&](double beyond_mm) {
        const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
        const double radius_mm = 30.0 - beyond_mm;
        return Eigen::Vector3d(0.3 + radius_mm * std::cos(angle), -0.4 + radius_mm * std::sin(angle), 0.0);
      };
      for (std::size_t i = 0; i < good / 100; ++i)  // beyond the edge, near it
        points_mm.push_back(on_the_edge(random.uniform(0.5, 4.0)) +
                            Eigen::Vector3d(0.0, 0.0, random.uniform(-3.0, 3.0)));
      for (std::size_t i = 0; i < good / 100; ++i)  // anywhere
        points_mm.push_back(random.in_cube_mm(60.0));
      for (std::size_t i = 0; i < good / 50; ++i)  // on the wall, up to 3 mm below
        points_mm.push_back(on_the_edge(0.0) - Eigen::Vector3d(0.0, 0.0, random.uniform(0.3, 3.0)));
      const ContourSet set = contours_of(points_mm);
      const FoundContour* loop = loop_on(set, plate.holes[0], true);
      ASSERT_NE(loop, nullptr) << set.found.size();
      EXPECT_TRUE(loop->contour.closed);
      // A stray beyond the edge that happens to lie in the plane is a point of the edge to any reader.
      EXPECT_NEAR(loop->length_mm / plate.holes[0].length_mm(), 1.0, 0.3);
      EXPECT_GT(testing::covered_ratio(loop->contour, plate.holes[0], 2.5), 0.9);
      EXPECT_LT(set.found.size(), 4U);
    }
}

TEST(CloudContours, HardlyDependOnTheDisc) {
  Plate plate;
  plate.holes = {circle(-20.0, 0.0, 25.0), circle(35.0, 20.0, 8.0)};
  for (const Sampling sampling : kSamplings)
    for (unsigned seed = 1; seed <= 2; ++seed) {
      const auto points_mm = sampled(plate, sampling, seed);
      const ContourSet usual = contours_of(points_mm);
      ASSERT_EQ(usual.found.size(), 3U);
      for (const double ratio : {0.8, 1.2}) {
        SCOPED_TRACE(ratio);
        ContourOptions options;
        options.disc_spacings_ratio *= ratio;
        const ContourSet other = contours_of(points_mm, options);
        ASSERT_EQ(other.found.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(other.found[i].length_mm / usual.found[i].length_mm, 1.0, 0.1);
      }
    }
}

TEST(CloudContours, MoveWithThePart) {
  const Plate plate;
  const auto points_mm = sampled(plate, Sampling::kRandom);
  const ContourSet usual = contours_of(points_mm);
  Random random(4);
  for (int i = 0; i < 5; ++i) {
    RigidMotion motion = RigidMotion::Identity();
    motion.linear() = Eigen::AngleAxisd(random.uniform(0.1, 3.0), random.direction()).toRotationMatrix();
    motion.translation() = random.in_cube_mm(500.0);
    auto moved_mm = points_mm;
    testing::move(moved_mm, motion);
    const ContourSet moved = contours_of(moved_mm, {}, motion * Eigen::Vector3d(0.0, 0.0, 1e4));
    ASSERT_EQ(moved.found.size(), usual.found.size());
    for (std::size_t c = 0; c < usual.found.size(); ++c) {
      const auto& expected_mm = usual.found[c].contour.points_mm;
      const auto& found_mm = moved.found[c].contour.points_mm;
      ASSERT_EQ(found_mm.size(), expected_mm.size());
      for (std::size_t k = 0; k < expected_mm.size(); ++k)
        EXPECT_LT((found_mm[k] - motion * expected_mm[k]).norm(), 1e-9);
    }
  }
}

TEST(CloudContours, AreTheSamePointsWhateverTheirOrder) {
  const Plate plate;
  for (const Sampling sampling : {Sampling::kRandom, Sampling::kRows}) {
    auto points_mm = sampled(plate, sampling);
    testing::add_noise(points_mm, 0.05);
    const auto expected = points_of(contours_of(points_mm));
    Random random(6);
    for (std::size_t i = points_mm.size() - 1; i > 0; --i)
      std::swap(points_mm[i],
                points_mm[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i + 1)))]);
    EXPECT_EQ(points_of(contours_of(points_mm)), expected);
  }
}

TEST(CloudContours, AreTheSameBytesForAnyThreadCount) {
  auto points_mm = sampled({}, Sampling::kRandom);
  testing::add_noise(points_mm, 0.05);
  ContourOptions options;
  options.threads = 1;
  const ContourSet one = contours_of(points_mm, options);
  for (const int threads : {2, 8}) {
    options.threads = threads;
    const ContourSet many = contours_of(points_mm, options);
    ASSERT_EQ(many.found.size(), one.found.size());
    for (std::size_t c = 0; c < one.found.size(); ++c) {
      EXPECT_EQ(many.found[c].contour.points_mm, one.found[c].contour.points_mm);
      EXPECT_EQ(many.found[c].contour.normals, one.found[c].contour.normals);
      EXPECT_EQ(many.found[c].min_bend_radius_mm, one.found[c].min_bend_radius_mm);
    }
  }
}

TEST(CloudContours, SayWhatWasDropped) {
  ContourOptions options;
  options.min_length_mm = 300.0;
  const ContourSet set = contours_of(sampled({}, Sampling::kGrid), options);
  ASSERT_EQ(set.found.size(), 1U);
  ASSERT_EQ(set.dropped.size(), 1U);
  EXPECT_NE(set.dropped[0].note.find("at least 300.0 mm needed"), std::string::npos) << set.dropped[0].note;
}

TEST(CloudContours, NameACloudOfRowsAndAreRightOnceItIsThinned) {
  const Plate plate;
  for (const Sampling sampling : kSamplings) EXPECT_TRUE(contours_of(sampled(plate, sampling)).notes.empty());
  for (const double finer : {7.0, 10.0, 20.0}) {
    SCOPED_TRACE(finer);
    Random random(3);
    const double pitch_mm = 2.0, along_mm = pitch_mm / finer;
    PointCloud cloud;
    for (double y = -59.0; y < 60.0; y += pitch_mm) {
      const double shift_mm = random.uniform(0.0, along_mm);
      for (double x = -60.0 + shift_mm; x < 60.0; x += along_mm)
        if (plate.material_at({x, y, 0.0})) cloud.points_mm.emplace_back(x, y, 0.02 * random.normal());
    }
    const ContourSet rows = contours_of(local_points_mm(cloud));
    ASSERT_EQ(rows.notes.size(), 1U);
    EXPECT_NE(rows.notes[0].find("rows"), std::string::npos);
    CleanOptions thin;
    thin.voxel_mm = 0.5 * pitch_mm;
    const ContourSet set = contours_of(local_points_mm(clean(cloud, thin).cloud));
    EXPECT_TRUE(set.notes.empty());
    ASSERT_EQ(set.found.size(), 2U);
    const FoundContour* loop = loop_on(set, plate.holes[0], true);
    ASSERT_NE(loop, nullptr);
    EXPECT_TRUE(loop->contour.closed);
    EXPECT_LT(error_of_loop(loop->contour, plate.holes[0], true).mean_mm, 0.5 * pitch_mm);
  }
}

TEST(CloudContours, FindTheEdgesOfUnevenDensity) {
  const Plate plate;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    std::vector<Eigen::Vector3d> points_mm;
    for (int i = 0; i < 28800; ++i) {
      const Eigen::Vector3d p_mm =
          Eigen::Vector3d(random.uniform(-60.0, 60.0), random.uniform(-60.0, 60.0), 0.0);
      const double kept_ratio = std::pow(4.0, -(p_mm.x() + 60.0) / 120.0);  // 4 : 1 from left to right
      if (random.uniform(0.0, 1.0) < kept_ratio && plate.material_at(p_mm)) points_mm.push_back(p_mm);
    }
    const ContourSet set = contours_of(points_mm);
    EXPECT_EQ(set.found.size(), 2U);
    expect_shows(set, plate.holes[0], true);
    expect_shows(set, plate.outline, false);
  }
}

TEST(CloudContours, FollowARoundPart) {
  // A dome of 15 spacings radius, cut off at 60 degrees: one loop, the rim.
  Random random(8);
  std::vector<Eigen::Vector3d> points_mm;
  for (int i = 0; i < 1400; ++i) {
    const Eigen::Vector3d d = random.direction();
    if (d.z() > 0.5) points_mm.push_back(15.0 * d);
  }
  const ContourSet set = contours_of(points_mm);
  ASSERT_EQ(set.found.size(), 1U);
  EXPECT_TRUE(set.found[0].contour.closed);
  EXPECT_NEAR(set.found[0].length_mm / (2.0 * std::numbers::pi * 15.0 * std::sqrt(0.75)), 1.0, 0.15);
}

TEST(CloudContours, TakeCloudsTooSmallToHaveAny) {
  Random random(9);
  for (int count = 1; count < 20; ++count) {
    std::vector<Eigen::Vector3d> points_mm;
    for (int i = 0; i < count; ++i) points_mm.push_back(random.in_cube_mm(10.0));
    EXPECT_NO_THROW((void)contours_of(points_mm)) << count;
    points_mm.assign(static_cast<std::size_t>(count), Eigen::Vector3d::Ones());
    EXPECT_TRUE(contours_of(points_mm).found.empty()) << count;
  }
}

TEST(BoundaryPoints, LieAtTheEdgeAndNowhereElse) {
  const Plate plate;
  const auto points_mm = sampled(plate, Sampling::kGrid);
  const NearestPoints tree(points_mm);
  const auto found = boundary_points(points_mm, tree, fit_local_planes(points_mm, tree, 12, 1), {});
  std::set<std::int32_t> boundary(found.begin(), found.end());
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    const double depth_mm =
        std::min(plate.holes[0].signed_mm(points_mm[i]), -plate.outline.signed_mm(points_mm[i]));
    const bool is_boundary = boundary.count(static_cast<std::int32_t>(i)) > 0;
    EXPECT_FALSE(is_boundary && depth_mm > 2.0) << depth_mm;
    EXPECT_FALSE(!is_boundary && depth_mm < 0.4) << depth_mm;
  }
}

}  // namespace
}  // namespace arris
