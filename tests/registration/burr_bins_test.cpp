#include "registration/burr_bins.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/synthetic/random.hpp"

namespace arris {
namespace {

constexpr double kLengthMm = 400.0, kDensityPerMm2 = 4.0;

std::vector<double> burr(double begin_mm, double end_mm, int count) {
  std::vector<double> arcs_mm;
  for (int i = 0; i < count; ++i) arcs_mm.push_back(begin_mm + (end_mm - begin_mm) * i / count);
  return arcs_mm;
}

TEST(BurrBins, FindTheBurrWithAMarginAndNothingElse) {
  const BurrBins found = find_burr_bins(burr(100.0, 110.0, 20), kLengthMm, kDensityPerMm2);
  for (double s_mm = 100.0; s_mm < 110.0; s_mm += 0.5) EXPECT_TRUE(found.at(s_mm)) << s_mm;
  for (const double s_mm : {0.0, 80.0, 125.0, 399.0}) EXPECT_FALSE(found.at(s_mm)) << s_mm;
  EXPECT_LT(found.length_mm(), 25.0);
}

TEST(BurrBins, ABurrOverTheSeamIsOne) {
  std::vector<double> arcs_mm = burr(395.0, 400.0, 10);
  for (const double s_mm : burr(0.0, 5.0, 10)) arcs_mm.push_back(s_mm);
  const BurrBins found = find_burr_bins(arcs_mm, kLengthMm, kDensityPerMm2);
  EXPECT_TRUE(found.at(399.0));
  EXPECT_TRUE(found.at(1.0));
  EXPECT_FALSE(found.at(200.0));
}

TEST(BurrBins, StraysEvenlyAlongTheEdgeAreNone) {
  synthetic::Random random(5);
  std::vector<double> arcs_mm;
  for (int i = 0; i < 200; ++i) arcs_mm.push_back(random.uniform(0.0, kLengthMm));
  EXPECT_LT(find_burr_bins(arcs_mm, kLengthMm, kDensityPerMm2).length_mm(), 0.15 * kLengthMm);
}

TEST(BurrBins, AStretchLongerThanAnyBurrIsThePartItself) {
  EXPECT_EQ(find_burr_bins(burr(50.0, 200.0, 400), kLengthMm, kDensityPerMm2).length_mm(), 0.0);
}

TEST(BurrBins, WidenTakesAsMuchOnEitherSideOfEachAndOverTheSeam) {
  std::vector<double> arcs_mm = burr(395.0, 400.0, 10);
  for (const double s_mm : burr(200.0, 210.0, 20)) arcs_mm.push_back(s_mm);
  BurrBins found = find_burr_bins(arcs_mm, kLengthMm, kDensityPerMm2);
  const BurrBins narrow = found;
  found.widen(20.0);
  for (double s_mm = 0.5; s_mm < kLengthMm; s_mm += 1.0) {
    bool near = false, far = true;  // of a burr as it was, bins counted whole
    for (double off_mm = -20.0; off_mm <= 20.0; off_mm += 1.0)
      near = near || narrow.at(std::fmod(s_mm + off_mm + kLengthMm, kLengthMm));
    for (double off_mm = -20.0 - narrow.bin_mm; off_mm <= 20.0 + narrow.bin_mm; off_mm += 1.0)
      far = far && !narrow.at(std::fmod(s_mm + off_mm + kLengthMm, kLengthMm));
    EXPECT_FALSE(near && !found.at(s_mm)) << s_mm;
    EXPECT_FALSE(far && found.at(s_mm)) << s_mm;
  }
  BurrBins none = find_burr_bins({}, kLengthMm, kDensityPerMm2);
  none.widen(20.0);
  EXPECT_EQ(none.length_mm(), 0.0);
}

TEST(BurrBins, ACoarseScanCannotTell) {
  EXPECT_TRUE(find_burr_bins(burr(100.0, 110.0, 5), kLengthMm, 0.04).burr.empty());
}

}  // namespace
}  // namespace arris
