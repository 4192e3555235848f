#include "registration/unit_guess.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace arris {
namespace {

constexpr double kExtentsAgree[] = {0.8,
                                    15.0};  // of scan and contour: no wrong unit is needed to explain them
constexpr double kScaledExtentMost = 6.0;   // and in another unit only this far from the contour's
constexpr std::size_t kLongestLoops = 3;
constexpr double kUnitRatios[] = {25.4, 1000.0, 1.0 / 25.4, 1.0 / 1000.0};

/// Corner to corner of the box around the points; mm.
double extent_mm(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points_mm) box.extend(p);
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

}  // namespace

double unit_that_fits(const CadModel& cad, const ScanModel& scan) {
  const double scan_mm = extent_mm(scan.points_mm);
  double part_mm = 0.0;  // of the largest: a whole plate in inches is as large as a small hole in millimetres
  for (const Curve& curve : cad.contours) part_mm = std::max(part_mm, extent_mm(curve.contour().points_mm));
  if (scan_mm > kExtentsAgree[0] * part_mm && scan_mm < kExtentsAgree[1] * part_mm) return 1.0;
  for (const double ratio : kUnitRatios)
    for (const Curve& curve : cad.contours) {
      const double scaled_extent = scan_mm * ratio / extent_mm(curve.contour().points_mm);
      if (scaled_extent < kExtentsAgree[0] || scaled_extent > kScaledExtentMost) continue;
      for (std::size_t l = 0; l < std::min(kLongestLoops, scan.loops.size()); ++l) {
        const double scaled = length_mm(scan.loops[l]) * ratio / curve.length_mm();
        if (scan.loops[l].closed && scaled > 0.8 && scaled < 1.25) return ratio;
      }
    }
  return 1.0;
}

}  // namespace arris
