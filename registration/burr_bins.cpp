#include "registration/burr_bins.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"
#include "registration/arc_bins.hpp"

namespace arris {
namespace {

constexpr double kLeastHeightMm = 0.5, kFewestPoints = 8.0;  // of a burr that must be seen in a bin
constexpr double kLeastBinMm = 4.0, kMostBinMm = 12.0;
constexpr double kLongestMm = 80.0;             // of one burr with its margins
constexpr double kSigmas = 3.0, kFewest = 0.4;  // more than chance leaves in a bin; one or two are no burr

}  // namespace

bool BurrBins::at(double arc_mm) const {
  return !burr.empty() && burr[arc_bin(arc_mm, bin_mm, burr.size())] != 0;
}

double BurrBins::length_mm() const {
  return bin_mm * static_cast<double>(std::count(burr.begin(), burr.end(), 1));
}

void BurrBins::widen(double by_mm) {
  if (burr.empty()) return;
  const std::size_t count = burr.size();
  const auto by = std::min(static_cast<std::size_t>(std::ceil(by_mm / bin_mm)), count / 2);
  const std::vector<char> narrow = burr;
  for (std::size_t b = 0; b < count; ++b)
    for (std::size_t k = 0; narrow[b] != 0 && k <= by; ++k)
      burr[(b + k) % count] = burr[(b + count - k) % count] = 1;
}

BurrBins find_burr_bins(std::span<const double> standing_out_mm, double length_mm, double density_per_mm2) {
  BurrBins found;
  found.bin_mm = std::max(kLeastBinMm, kFewestPoints / (kLeastHeightMm * std::max(1e-9, density_per_mm2)));
  const auto count = static_cast<std::size_t>(length_mm / found.bin_mm);
  if (found.bin_mm > kMostBinMm || count < 8) return found;
  found.bin_mm = length_mm / static_cast<double>(count);
  std::vector<double> points(count, 0.0);
  for (const double arc_mm : standing_out_mm) points[arc_bin(arc_mm, found.bin_mm, count)] += 1.0;
  const double usual = median_of(points);
  const double most = usual + kSigmas * std::sqrt(usual + kFewest);
  std::vector<char> out(count);
  for (std::size_t b = 0; b < count; ++b) out[b] = points[b] > most ? 1 : 0;
  found.burr.assign(count, 0);
  for (std::size_t b = 0; b < count; ++b)
    if (out[b] != 0 || out[(b + 1) % count] != 0 || out[(b + count - 1) % count] != 0) found.burr[b] = 1;
  const auto longest = static_cast<std::size_t>(kLongestMm / found.bin_mm);
  const auto free =
      static_cast<std::size_t>(std::find(found.burr.begin(), found.burr.end(), 0) - found.burr.begin());
  if (free == count) {  // all round: no burr
    found.burr.clear();
    return found;
  }
  for (std::size_t i = 0; i < count;) {
    std::size_t run = 0;
    while (run < count && found.burr[(free + i + run) % count] != 0) ++run;
    for (std::size_t k = 0; run > longest && k < run; ++k) found.burr[(free + i + k) % count] = 0;
    i += run + 1;
  }
  return found;
}

}  // namespace arris
