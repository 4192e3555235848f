#include "registration/seen_bins.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"
#include "registration/arc_bins.hpp"

namespace arris {
namespace {

constexpr double kPointsPerBin = 8.0;
constexpr double kLeastBinMm = 2.0, kFewestBins = 8.0;
constexpr double kLeastExpectedRatio = 0.5;  // of the scan's median density, beside the edge
constexpr double kRimRatio = 0.6;            // of the usual number, beside a gap: not seen

}  // namespace

std::size_t SeenBins::bin_of(double arc_mm) const {
  return arc_bin(arc_mm, bin_mm, seen.size());
}

SeenBins find_seen_bins(const std::vector<BesidePoint>& points, double weight, const StripSize& strip) {
  SeenBins found;
  const double expected_per_mm =
      kLeastExpectedRatio * strip.width_mm / std::max(1e-9, strip.spacing_mm * strip.spacing_mm);
  const double mean_per_mm = std::max({1e-9, weight / strip.length_mm, expected_per_mm});
  found.bin_mm = std::clamp(kPointsPerBin / mean_per_mm, kLeastBinMm,
                            std::max(kLeastBinMm, strip.length_mm / kFewestBins));
  const std::size_t bins =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::floor(strip.length_mm / found.bin_mm)));
  found.bin_mm = strip.length_mm / static_cast<double>(bins);
  found.seen.assign(bins, 1);
  std::vector<double> all(bins, 0.0), near(bins, 0.0);
  for (const BesidePoint& p : points) {
    const std::size_t bin = found.bin_of(p.arc_mm);
    all[bin] += p.weight;
    if (p.across_mm < strip.near_mm) near[bin] += p.weight;
  }
  const double expected = expected_per_mm * found.bin_mm;
  const double usual = std::max(median_of(all), expected);
  const double usual_near = std::max(median_of(near), strip.near_mm / strip.width_mm * expected);
  for (std::size_t b = 0; b < bins; ++b)
    if (near[b] < kEmptyBinRatio * usual_near || all[b] < kEmptyBinRatio * usual) found.seen[b] = 0;
  const std::vector<char> sure = found.seen;
  for (std::size_t b = 0; b < bins; ++b) {
    const bool beside_gap = !sure[(b + 1) % bins] || !sure[(b + bins - 1) % bins];
    if (beside_gap && near[b] < kRimRatio * usual_near) found.seen[b] = 0;
  }
  found.density_per_mm2 = usual / (found.bin_mm * strip.width_mm);
  return found;
}

}  // namespace arris
