#pragma once

#include <Eigen/Core>
#include <array>

#include "registration/surface_basis.hpp"

namespace arris {

/// Six orthonormal symmetric tensors: what all of a sheet may share (a strain, a bend) is a sum of them, and
/// as likely in any direction.
[[nodiscard]] const std::array<Eigen::Matrix3d, 6>& symmetric_modes();

/// Components 11, 12, 22 of a tensor in the tangent frame at a place of the sheet.
[[nodiscard]] Eigen::Vector3d in_frame(const Eigen::Matrix3d& tensor, const BasisRow& row);

}  // namespace arris
