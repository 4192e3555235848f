#include "registration/deviation.hpp"

#include <limits>

#include "acquisition/geometry/parallel_for.hpp"

namespace arris {

std::vector<float> signed_deviation_mm(const SurfaceQuery& cad, const RigidMotion& scan_from_cad,
                                       std::span<const Eigen::Vector3f> points_mm, double reach_mm,
                                       int threads) {
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  std::vector<float> deviation(points_mm.size(), std::numeric_limits<float>::quiet_NaN());
  parallel_for(points_mm.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfacePoint foot = cad.closest(cad_from_scan * points_mm[i].cast<double>(), reach_mm);
      if (foot.triangle >= 0 && !foot.on_border) deviation[i] = static_cast<float>(foot.signed_mm);
    }
  });
  return deviation;
}

}  // namespace arris
