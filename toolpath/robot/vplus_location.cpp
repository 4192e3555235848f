#include "toolpath/robot/vplus_location.hpp"

#include <cmath>

#include "toolpath/formats/number.hpp"
#include "toolpath/robot/euler_zyz.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr int kDecimals = 4;
constexpr double kUnit = 1e4;
constexpr double kRadPerDeg = 0.017453292519943295769;
constexpr double kOffMm = 0.0005;

double rounded(double value) {
  return std::round(value * kUnit) / kUnit;
}

// The tool's z at a location; roll turns about it.
Vector3d tool_z(const VplusLocation& location) {
  const double yaw = location.turn_deg.x() * kRadPerDeg, pitch = location.turn_deg.y() * kRadPerDeg;
  return {std::cos(yaw) * std::sin(pitch), std::sin(yaw) * std::sin(pitch), std::cos(pitch)};
}

}  // namespace

VplusLocation vplus_location(const RigidMotion& motion) {
  return {motion.translation().unaryExpr(&rounded), yaw_pitch_roll_deg(motion.linear(), kDecimals)};
}

std::string trans_text(const VplusLocation& location) {
  const Vector3d &at_mm = location.at_mm, &turn_deg = location.turn_deg;
  std::string text = "TRANS(";
  for (double value : {at_mm.x(), at_mm.y(), at_mm.z(), turn_deg.x(), turn_deg.y(), turn_deg.z()})
    text += (text.back() == '(' ? "" : ", ") + fixed_text(value, kDecimals);
  return text + ")";
}

std::string vplus_length_text(double length_mm) {
  return fixed_text(length_mm, kDecimals);
}

bool lies_back(const RigidMotion& pose, const RigidMotion& row, double back_mm) {
  const VplusLocation from = vplus_location(row);
  if (vplus_location(pose).turn_deg != from.turn_deg) return false;
  const Vector3d reached_mm = from.at_mm - rounded(back_mm) * tool_z(from);
  return (reached_mm - pose.translation()).norm() <= kOffMm;
}

}  // namespace arris
