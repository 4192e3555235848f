#include "registration/free_directions.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace arris {
namespace {

constexpr double kFreeEigenvalueRatio = 1e-4;

}  // namespace

std::vector<std::string> free_directions(const Eigen::Matrix<double, 6, 6>& information,
                                         const Eigen::Vector3d& pivot_mm, double size_mm) {
  std::vector<std::string> words;
  Eigen::Matrix<double, 6, 1> scale;
  scale << Eigen::Vector3d::Constant(1.0 / size_mm), Eigen::Vector3d::Ones();
  const Eigen::Matrix<double, 6, 6> scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(scaled);
  for (int i = 0; i < 6; ++i) {
    if (eigen.eigenvalues()[i] > kFreeEigenvalueRatio * eigen.eigenvalues()[5]) continue;
    const Eigen::Vector3d turn = eigen.eigenvectors().col(i).head<3>();
    const Eigen::Vector3d shift = eigen.eigenvectors().col(i).tail<3>();
    const bool is_turn = turn.norm() > 0.5;
    const Eigen::Vector3d axis = (is_turn ? turn : shift).normalized();
    // A screw about the pivot: its axis passes where the shift is undone by the turn.
    const Eigen::Vector3d through =
        is_turn ? Eigen::Vector3d(pivot_mm + axis.cross(shift) * size_mm / turn.norm()) : pivot_mm;
    words.push_back(fmt::format("{} ({:.3f} {:.3f} {:.3f}) through ({:.1f} {:.1f} {:.1f}) mm, CAD frame",
                                is_turn ? "turn about the axis" : "shift along", axis.x(), axis.y(), axis.z(),
                                through.x(), through.y(), through.z()));
  }
  return words;
}

}  // namespace arris
