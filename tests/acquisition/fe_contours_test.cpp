#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "acquisition/clean.hpp"
#include "acquisition/contour_extract.hpp"
#include "acquisition/geometry/polyline.hpp"
#include "fixtures/synthetic/fe_part.hpp"
#include "fixtures/synthetic/scan.hpp"

namespace arris {
namespace {

class FeContours : public ::testing::TestWithParam<const char*> {};

/// Share of the true curve within three spacings of the loop.
double covered_ratio(const Contour& loop, const std::vector<Eigen::Vector3d>& curve_mm, double spacing_mm) {
  const Curve found(loop);
  const auto near = std::count_if(curve_mm.begin(), curve_mm.end(), [&](const Eigen::Vector3d& p_mm) {
    return found.nearest(p_mm).distance_mm < 3.0 * spacing_mm;
  });
  return static_cast<double>(near) / static_cast<double>(curve_mm.size());
}

TEST_P(FeContours, ShowTheOpeningAsOneLoop) {
  const auto part =
      synthetic::load_fe_part(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/fe" / GetParam());
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    synthetic::ScanOptions options;
    options.missing_ratio = 0.15;
    options.stray_ratio = 0.05;
    options.wall_ratio = 0.03;
    options.density_variation_ratio = 2.0;
    const synthetic::SyntheticScan scan = synthetic::sample_scan(part, options, seed);
    const PointCloud cloud = clean(scan.cloud(), {}).cloud;
    const std::vector<Eigen::Vector3d> points_mm = local_points_mm(cloud);
    const NearestPoints tree(points_mm);
    LocalPlanes planes = fit_local_planes(points_mm, tree, 12, 0);
    orient_towards(points_mm, scan.seen_from_mm - cloud.offset_mm, planes.normals);
    const ContourSet set = cloud_contours(points_mm, tree, planes, {});
    EXPECT_LE(set.found.size(), 3U);
    std::vector<Eigen::Vector3d> curve_mm = scan.true_curve_mm();
    for (Eigen::Vector3d& p_mm : curve_mm) p_mm -= cloud.offset_mm;
    std::vector<double> covered;
    for (const FoundContour& found : set.found)
      covered.push_back(covered_ratio(found.contour, curve_mm, planes.spacing_median_mm));
    std::sort(covered.rbegin(), covered.rend());
    ASSERT_FALSE(covered.empty());
    EXPECT_GT(covered[0], 0.7);
    EXPECT_LT(covered.size() > 1 ? covered[1] : 0.0, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, FeContours, ::testing::Values("porthole", "nosecone", "sheet"));

}  // namespace
}  // namespace arris
