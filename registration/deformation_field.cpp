#include "registration/deformation_field.hpp"

namespace arris {

MappedPoint RigidField::map(const Eigen::Vector3d& p_cad_mm) const {
  MappedPoint mapped;
  mapped.p_scan_mm = scan_from_cad_ * p_cad_mm;
  mapped.rotation_scan_from_cad = scan_from_cad_.linear();
  mapped.from_data = true;
  mapped.in_domain = true;
  return mapped;
}

std::vector<double> RigidField::parameters() const {
  const Eigen::Matrix<double, 3, 4> top = scan_from_cad_.matrix().topRows<3>();
  return {top.data(), top.data() + top.size()};
}

}  // namespace arris
