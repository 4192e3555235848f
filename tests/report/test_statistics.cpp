#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "report/statistics.hpp"
#include "report/worst_points.hpp"

namespace arris::report {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<float> random_deviations(std::size_t count) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0.2F, 0.4F);
  std::vector<float> values(count);
  for (float& value : values) value = normal(random);
  return values;
}

TEST(DeviationStatistics, KnownValues) {
  const std::vector<double> values = {-1.0, 0.0, 1.0, 2.0, 3.0};
  const DeviationStatistics s = deviation_statistics(std::span<const double>(values), 2.0);
  EXPECT_EQ(s.count, 5U);
  EXPECT_DOUBLE_EQ(s.min_mm, -1.0);
  EXPECT_DOUBLE_EQ(s.max_mm, 3.0);
  EXPECT_DOUBLE_EQ(s.mean_mm, 1.0);
  EXPECT_DOUBLE_EQ(s.median_mm, 1.0);
  EXPECT_DOUBLE_EQ(s.p05_mm, -0.8);
  EXPECT_DOUBLE_EQ(s.p95_mm, 2.8);
  EXPECT_NEAR(s.sigma_mm, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(s.rms_mm, std::sqrt(3.0), 1e-12);
  EXPECT_DOUBLE_EQ(s.in_tolerance_ratio, 0.6);  // the limits -1 and 1 are inside
  EXPECT_DOUBLE_EQ(s.over_ratio, 0.4);
  EXPECT_DOUBLE_EQ(s.under_ratio, 0.0);
}

TEST(DeviationStatistics, RmsAgainstMeanAndSigma) {
  const std::vector<float> values = random_deviations(10000);
  const DeviationStatistics s = deviation_statistics(std::span<const float>(values), 1.0);
  EXPECT_NEAR(s.rms_mm * s.rms_mm, s.mean_mm * s.mean_mm + s.sigma_mm * s.sigma_mm, 1e-12);
  double sum2 = 0.0;
  for (const float value : values) sum2 += static_cast<double>(value) * static_cast<double>(value);
  EXPECT_NEAR(s.rms_mm, std::sqrt(sum2 / 10000.0), 1e-9);
  EXPECT_NEAR(s.in_tolerance_ratio + s.over_ratio + s.under_ratio, 1.0, 1e-12);
}

TEST(DeviationStatistics, OrderOfPointsDoesNotMatter) {
  std::vector<float> values = random_deviations(5000);
  const DeviationStatistics before = deviation_statistics(std::span<const float>(values), 1.0);
  std::shuffle(values.begin(), values.end(), std::mt19937(5));
  const DeviationStatistics after = deviation_statistics(std::span<const float>(values), 1.0);
  EXPECT_EQ(before.mean_mm, after.mean_mm);
  EXPECT_EQ(before.sigma_mm, after.sigma_mm);
}

TEST(DeviationStatistics, NoDataIsSkipped) {
  const std::vector<float> values = {kNan, 1.0F, kNan, 3.0F};
  const DeviationStatistics s = deviation_statistics(std::span<const float>(values), 1.0);
  EXPECT_EQ(s.count, 2U);
  EXPECT_DOUBLE_EQ(s.mean_mm, 2.0);
  const std::vector<float> none = {kNan, kNan};
  const DeviationStatistics empty = deviation_statistics(std::span<const float>(none), 1.0);
  EXPECT_EQ(empty.count, 0U);
  EXPECT_TRUE(std::isnan(max_abs_mm(empty)));
}

TEST(ErrorSummary, SizesAndGaps) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> errors = {-3.0, 4.0, gap};
  const ErrorSummary s = error_summary(errors);
  EXPECT_EQ(s.count, 2U);
  EXPECT_DOUBLE_EQ(s.mean_mm, 3.5);
  EXPECT_NEAR(s.rms_mm, std::sqrt(12.5), 1e-12);
  EXPECT_DOUBLE_EQ(s.max_mm, 4.0);

  ContourError contour;
  contour.arc_mm = {0.0, 1.0};
  contour.rigid_mm = {5.0, gap};
  contour.across_mm = {3.0, gap};
  contour.normal_mm = {-4.0, 1.0};
  const ContourErrorSummary all = contour_error_summary({&contour, 1});
  EXPECT_EQ(all.points, 2U);
  EXPECT_EQ(all.after.count, 1U);
  EXPECT_DOUBLE_EQ(all.after.max_mm, 5.0);
  EXPECT_EQ(all.normal.count, 2U);
}

TEST(Histogram, CountsSumAndZoneIsExact) {
  std::vector<float> values = random_deviations(20000);
  values.insert(values.end(), {0.5F, -0.5F, 0.0F, kNan, 9.0F, -9.0F});
  for (const double limit_mm : {0.5, 0.7, 1.3, 4.0, 40.0}) {
    const Histogram h = histogram(values, 1.0, limit_mm);
    EXPECT_EQ(h.total(), values.size() - 1);
    EXPECT_EQ(h.no_data, 1U);
    ASSERT_EQ(h.edges_mm.size(), h.counts.size() + 1);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < h.counts.size(); ++i) {
      EXPECT_DOUBLE_EQ(h.edges_mm[i], -h.edges_mm[h.edges_mm.size() - 1 - i]);
      if (h.edges_mm[i] >= -0.5 && h.edges_mm[i + 1] <= 0.5) inside += h.counts[i];
    }
    const DeviationStatistics s = deviation_statistics(std::span<const float>(values), 1.0);
    EXPECT_NEAR(static_cast<double>(inside), s.in_tolerance_ratio * static_cast<double>(s.count), 1e-6);
    EXPECT_EQ(std::count(h.edges_mm.begin(), h.edges_mm.end(), 0.5), 1) << limit_mm;
  }
}

TEST(Histogram, WithoutToleranceOrData) {
  const Histogram h = histogram(std::vector<float>{0.1F, -0.2F, kNan}, 0.0, 1.0);
  EXPECT_EQ(h.total(), 2U);
  EXPECT_EQ(histogram({}, 1.0, 1.0).total(), 0U);
}

TEST(WorstPoints, SpacedApartWorstFirst) {
  // Two burrs: the neighbours of the worst point must not take all flags.
  std::vector<Eigen::Vector3f> points;
  std::vector<float> deviation;
  for (int i = 0; i < 100; ++i) {
    points.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    deviation.push_back(i < 10 ? 5.0F - 0.1F * static_cast<float>(i)
                               : (i == 60 ? 2.0F : -0.001F * static_cast<float>(i)));
  }
  deviation[50] = kNan;
  const auto high = spaced_extremes(points, deviation, 3, 20.0, true);
  EXPECT_EQ(high, (std::vector<std::size_t>{0, 60}));  // no third positive one
  const auto low = spaced_extremes(points, deviation, 3, 20.0, false);
  EXPECT_EQ(low, (std::vector<std::size_t>{99, 79, 59}));
  EXPECT_TRUE(spaced_extremes({}, {}, 3, 20.0, true).empty());
}

TEST(WorstPoints, NominalIsTheFootOnTheCad) {
  RunRecord record;
  record.surface_profile_mm = 1.0;
  record.cad.vertices_mm = {{0, 0, 0}, {100, 0, 0}, {0, 100, 0}};
  record.cad.triangles = {{0, 1, 2}};
  record.alignment.scan_from_cad.translation() = Eigen::Vector3d(1000.0, 0.0, 5.0);
  record.cloud.offset_mm = Eigen::Vector3d(1000.0, 0.0, 0.0);
  record.cloud.points_mm = {{20.0F, 30.0F, 5.75F}, {10.0F, 10.0F, 4.875F}};
  record.deviation_mm = {0.75F, -0.125F};
  const auto points = worst_points(record, 5);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].id, "H1");
  EXPECT_FALSE(points[0].in_tolerance);
  EXPECT_TRUE(points[0].p_scan_mm.isApprox(Eigen::Vector3d(1020.0, 30.0, 5.75), 1e-9));
  ASSERT_TRUE(points[0].has_nominal);
  EXPECT_NEAR((points[0].nominal_cad_mm - Eigen::Vector3d(20, 30, 0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(points[1].id, "L1");
  EXPECT_TRUE(points[1].in_tolerance);
  record.deviation_mm = {0.9F, -0.125F};  // not the distance to this CAD: no nominal is invented
  EXPECT_FALSE(worst_points(record, 5)[0].has_nominal);
}

}  // namespace
}  // namespace arris::report
