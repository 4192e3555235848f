#include "registration/seams.hpp"

namespace arris {

std::vector<Seam> seams_of(const ContourMotion& motion) {
  const Curve& curve = motion.nominal();
  const std::vector<Segment>& segments = motion.subdivision().segments();
  std::vector<Seam> seams;
  for (std::size_t z = 0; z < segments.size(); ++z) {
    const std::size_t next = (z + 1) % segments.size();
    if (next == z || (next == 0 && !curve.closed())) continue;
    const double s_mm = curve.wrap_mm(segments[z].end_mm);
    const Eigen::Vector3d p = curve.point_mm(s_mm);
    const RigidMotion &before = motion.fits()[z].scan_from_cad, &after = motion.fits()[next].scan_from_cad;
    Eigen::Vector3d apart = before * p - after * p;
    const Eigen::Vector3d tangent = before.linear() * curve.tangent(s_mm);
    apart -= apart.dot(tangent) * tangent;
    seams.push_back({z, next, s_mm, apart.norm(), rotation_between_rad(before, after)});
  }
  return seams;
}

}  // namespace arris
