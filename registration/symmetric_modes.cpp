#include "registration/symmetric_modes.hpp"

#include <cmath>

namespace arris {
namespace {

std::array<Eigen::Matrix3d, 6> made() {
  std::array<Eigen::Matrix3d, 6> modes;
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = i; k < 3; ++k) {
      Eigen::Matrix3d mode = Eigen::Matrix3d::Zero();
      mode(i, k) = mode(k, i) = i == k ? 1.0 : std::sqrt(0.5);
      modes[at++] = mode;
    }
  return modes;
}

}  // namespace

const std::array<Eigen::Matrix3d, 6>& symmetric_modes() {
  static const std::array<Eigen::Matrix3d, 6> modes = made();
  return modes;
}

Eigen::Vector3d in_frame(const Eigen::Matrix3d& tensor, const BasisRow& row) {
  return {row.t1.dot(tensor * row.t1), row.t1.dot(tensor * row.t2), row.t2.dot(tensor * row.t2)};
}

}  // namespace arris
