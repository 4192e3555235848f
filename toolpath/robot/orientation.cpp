#include "toolpath/robot/orientation.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d frame_of(const Vector3d& axis, const Vector3d& towards) {
  Matrix3d frame;
  frame.col(2) = -axis;
  frame.col(0) = (towards - towards.dot(axis) * axis).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0)).normalized();
  return frame;
}

// Sine of the smallest angle between a direction and any of the axes.
double clearance_of(const Vector3d& direction, const std::vector<Vector3d>& axes) {
  double least = 1.0;
  for (const Vector3d& axis : axes) least = std::min(least, direction.cross(axis).norm());
  return least;
}

Vector3d fixed_direction(const std::vector<Vector3d>& axes) {
  Vector3d best = Vector3d::UnitX();
  double clearance = -1.0;
  for (const Vector3d& candidate :
       {Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitY()), Vector3d(Vector3d::UnitZ())}) {
    const double found = clearance_of(candidate, axes);
    if (found >= 0.5) return candidate;
    if (found > clearance) {
      clearance = found;
      best = candidate;
    }
  }
  if (clearance < 0.0175)
    throw Error(Fault::kInput, ErrorText{"spin = \"fixed\" has no direction that the tool axes leave free",
                                         "tool path", "axes along x, y and z", "one of them free by 1 degree",
                                         "use spin = \"least_turn\""});
  return best;
}

std::vector<Matrix3d> least_turn(const std::vector<Vector3d>& axes) {
  std::vector<Matrix3d> frames;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (i == 0) {
      frames.push_back(
          frame_of(axes[0], std::abs(axes[0].x()) < 0.866 ? Vector3d::UnitX() : Vector3d::UnitY()));
      continue;
    }
    Vector3d x = frames.back().col(0);
    if (axes[i - 1].dot(axes[i]) > -1.0 + 1e-9)
      x = Eigen::Quaterniond::FromTwoVectors(axes[i - 1], axes[i]) * x;
    frames.push_back(frame_of(axes[i], x));  // of opposite axes x stays as it is: half a turn about it
  }
  return frames;
}

std::vector<Matrix3d> along_travel(const std::vector<Vector3d>& axes, const std::vector<Vector3d>& travel) {
  const std::size_t n = axes.size();
  const auto usable = [&](std::size_t of, std::size_t at) {
    return travel[of].cross(axes[at]).norm() > 0.1 * travel[of].norm() && travel[of].norm() > 0.0;
  };
  std::vector<std::size_t> source(n, n);
  for (std::size_t i = 0; i < n; ++i) source[i] = usable(i, i) ? i : (i > 0 ? source[i - 1] : n);
  for (std::size_t i = n; i-- > 0;)
    if (source[i] == n && i + 1 < n) source[i] = source[i + 1];
  const std::vector<Matrix3d> fallback = least_turn(axes);
  std::vector<Matrix3d> frames;
  for (std::size_t i = 0; i < n; ++i) {
    const bool known = source[i] < n && usable(source[i], i);
    frames.push_back(known ? frame_of(axes[i], travel[source[i]]) : fallback[i]);
  }
  return frames;
}

}  // namespace

Spin spin_from_name(const std::string& name) {
  if (name == "fixed") return Spin::kFixed;
  if (name == "tangent") return Spin::kTangent;
  if (name == "least_turn") return Spin::kLeastTurn;
  throw Error(Fault::kRecipe, "toolpath.spin = \"" + name + "\", need least_turn, fixed or tangent");
}

std::vector<Matrix3d> tool_frames(const std::vector<Vector3d>& axes, const std::vector<Vector3d>& travel,
                                  Spin spin) {
  if (axes.size() != travel.size())
    throw Error(Fault::kBug, "tool_frames: as many axes as directions of travel");
  if (spin == Spin::kLeastTurn) return least_turn(axes);
  if (spin == Spin::kTangent) return along_travel(axes, travel);
  std::vector<Matrix3d> frames;
  const Vector3d direction = fixed_direction(axes);
  for (const Vector3d& axis : axes) frames.push_back(frame_of(axis, direction));
  return frames;
}

}  // namespace arris
