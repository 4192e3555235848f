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

ContourMotion sampled_motion(const Curve& nominal, double step_mm,
                             const std::function<RigidMotion(double arc_mm)>& motion_at) {
  SubdivisionOptions pieces;
  pieces.segment_length_max_mm = step_mm;
  pieces.corner_radius_max_mm = 0.0;  // a smooth field needs no cut at corners
  pieces.overlap_ratio = 0.5;
  Subdivision subdivision(nominal, pieces);
  std::vector<SegmentFit> fits(subdivision.segments().size());
  for (std::size_t z = 0; z < fits.size(); ++z) {
    const Segment& segment = subdivision.segments()[z];
    fits[z].scan_from_cad = motion_at(nominal.wrap_mm(0.5 * (segment.begin_mm + segment.end_mm)));
  }
  return {nominal, std::move(subdivision), std::move(fits)};
}

}  // namespace arris
