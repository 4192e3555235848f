#include <algorithm>

#include "registration/subdivision_icp.hpp"

namespace arris {

ContourMotion::ContourMotion(const Curve& nominal, Subdivision subdivision, std::vector<SegmentFit> fits)
    : nominal_(nominal), subdivision_(std::move(subdivision)), fits_(std::move(fits)) {}

RigidMotion ContourMotion::at(double arc_mm) const {
  const Eigen::Vector3d p_cad_mm = nominal_.point_mm(arc_mm);
  const std::vector<BlendWeight> blend = subdivision_.weights(arc_mm);
  const RigidMotion& first = fits_[static_cast<std::size_t>(blend.front().segment)].scan_from_cad;
  if (blend.size() == 1) return first;
  Eigen::Vector3d image_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // mean rotation vector, relative to the first
  for (const BlendWeight& entry : blend) {
    const RigidMotion& motion = fits_[static_cast<std::size_t>(entry.segment)].scan_from_cad;
    image_mm += entry.weight * (motion * p_cad_mm);
    const Eigen::AngleAxisd relative(Eigen::Matrix3d(first.linear().transpose() * motion.linear()));
    turn += entry.weight * relative.angle() * relative.axis();
  }
  RigidMotion blended = first;
  const double angle_rad = turn.norm();
  if (angle_rad > 0.0) blended.rotate(Eigen::AngleAxisd(angle_rad, turn / angle_rad));
  blended.translation() = image_mm - blended.linear() * p_cad_mm;
  return blended;
}

}  // namespace arris
