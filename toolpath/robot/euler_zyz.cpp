#include "toolpath/robot/euler_zyz.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace arris {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegPerRad = 57.295779513082320877;

double rounded_deg(double angle_rad, double unit) {
  const double angle_deg = std::round(angle_rad * kDegPerRad * unit) / unit;
  return angle_deg <= -180.0 ? 180.0 : angle_deg;
}

// The turn about z that is nearest to m.
double about_z_rad(const Matrix3d& m) {
  return std::atan2(m(1, 0) - m(0, 1), m(0, 0) + m(1, 1));
}

}  // namespace

Vector3d yaw_pitch_roll_deg(const Matrix3d& turn, int decimals) {
  const double unit = std::pow(10.0, decimals);
  const double pitch_deg = rounded_deg(std::atan2(std::hypot(turn(0, 2), turn(1, 2)), turn(2, 2)), unit);
  const Matrix3d pitched = AngleAxisd(pitch_deg / kDegPerRad, Vector3d::UnitY()).toRotationMatrix();
  if (pitch_deg == 0.0 || pitch_deg == 180.0)
    return {rounded_deg(about_z_rad(turn * pitched.transpose()), unit), pitch_deg, 0.0};
  const double yaw_deg = rounded_deg(std::atan2(turn(1, 2), turn(0, 2)), unit);
  const Matrix3d yawed = AngleAxisd(yaw_deg / kDegPerRad, Vector3d::UnitZ()).toRotationMatrix();
  return {yaw_deg, pitch_deg, rounded_deg(about_z_rad((yawed * pitched).transpose() * turn), unit)};
}

}  // namespace arris
