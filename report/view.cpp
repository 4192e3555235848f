#include "report/view.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace arris::report {
namespace {

constexpr double kRad = 3.14159265358979323846 / 180.0;

// Eigenvectors of the 3 x 3 spread, smallest first, with their eigenvalues.
Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread_of(std::span<const Eigen::Vector3d> points_mm) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points_mm) mean += p;
  mean /= std::max<double>(1.0, static_cast<double>(points_mm.size()));
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points_mm) spread += (p - mean) * (p - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread);
}

Eigen::Vector3d with_fixed_sign(const Eigen::Vector3d& v) {
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  return v[largest] < 0.0 ? Eigen::Vector3d(-v) : v;
}

Eigen::Vector3d across(const Eigen::Vector3d& v, const Eigen::Vector3d& normal) {
  return v - v.dot(normal) * normal;
}

// The frame's axis that lies flattest in the picture: X before Y before Z.
Eigen::Vector3d frame_axis(const Eigen::Vector3d& normal) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(normal[axis]) < 0.7) return across(Eigen::Vector3d::Unit(axis), normal).normalized();
  return across(Eigen::Vector3d::UnitX(), normal).normalized();
}

Eigen::Vector3d faces_normal(const TriangleMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (const auto& t : mesh.triangles) {
    const auto vertex = [&](std::size_t i) { return mesh.vertices_mm[static_cast<std::size_t>(t[i])]; };
    const Eigen::Vector3d normal = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
    sum += normal;
    area += normal.norm();
  }
  return area > 0.0 ? Eigen::Vector3d(sum / area) : Eigen::Vector3d::Zero();
}

}  // namespace

Eigen::Vector3d plane_normal(std::span<const Eigen::Vector3d> points_mm) {
  if (points_mm.size() < 3) return Eigen::Vector3d::UnitZ();
  return with_fixed_sign(spread_of(points_mm).eigenvectors().col(0));
}

Eigen::Vector3d mean_normal(const RunRecord& record, std::span<const Eigen::Vector3d> points_cad_mm) {
  constexpr double kClear = 0.3;  // a shorter mean says nothing: the normals look all around
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const Contour& contour : record.cad_contours)
    for (const Eigen::Vector3d& n : contour.normals) sum += n, ++count;
  if (count > 0 && sum.norm() > kClear * static_cast<double>(count)) return sum.normalized();
  sum.setZero();
  for (const PathPoint& p : record.nominal_path.points) sum += p.axis;
  if (sum.norm() > kClear * static_cast<double>(std::max<std::size_t>(1, record.nominal_path.points.size())))
    return sum.normalized();
  const Eigen::Vector3d faces = faces_normal(record.cad);
  return faces.norm() > kClear ? faces.normalized() : plane_normal(points_cad_mm);
}

Orientation look_along(const Eigen::Vector3d& normal, std::span<const Eigen::Vector3d> points_mm) {
  const Eigen::Vector3d axis = frame_axis(normal);
  Eigen::Vector3d right = axis;
  if (points_mm.size() >= 3) {
    const auto spread = spread_of(points_mm);
    Eigen::Vector3d longest = across(spread.eigenvectors().col(2), normal);
    const bool is_clear = spread.eigenvalues()[2] > 1.5 * spread.eigenvalues()[1] && longest.norm() > 0.5;
    longest.normalize();
    const Eigen::Vector3d other = normal.cross(axis);
    if (is_clear && std::abs(longest.dot(other)) > std::cos(12.0 * kRad))
      right = with_fixed_sign(other);
    else if (is_clear && std::abs(longest.dot(axis)) < std::cos(12.0 * kRad))
      right = with_fixed_sign(longest);
  }
  Orientation rows;
  rows.row(0) = right;
  rows.row(1) = normal.cross(right);
  rows.row(2) = normal;
  return rows;
}

Orientation look_oblique(const Orientation& along) {
  const double turn = 28.0 * kRad, tilt = 58.0 * kRad;
  Eigen::Matrix3d turned, tilted;
  turned << std::cos(turn), std::sin(turn), 0, -std::sin(turn), std::cos(turn), 0, 0, 0, 1;
  tilted << 1, 0, 0, 0, std::cos(tilt), std::sin(tilt), 0, -std::sin(tilt), std::cos(tilt);
  return tilted * turned * along;
}

Eigen::Vector3d View::project(const Eigen::Vector3d& p_mm) const {
  const Eigen::Vector3d seen = orientation * p_mm;
  return {centre_px.x() + (seen.x() - centre_mm.x()) * scale_px_mm,
          centre_px.y() - (seen.y() - centre_mm.y()) * scale_px_mm, seen.z()};
}

void Extent::include(const Eigen::Vector2d& p) {
  low = empty ? p : Eigen::Vector2d(low.cwiseMin(p));
  high = empty ? p : Eigen::Vector2d(high.cwiseMax(p));
  empty = false;
}

Extent extent_of(const Orientation& orientation, std::span<const Eigen::Vector3d> points_mm) {
  Extent extent;
  if (points_mm.empty()) return extent;
  const std::size_t step = std::max<std::size_t>(1, points_mm.size() / 200000);
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> values;
    for (std::size_t i = 0; i < points_mm.size(); i += step)
      values.push_back(orientation.row(axis).dot(points_mm[i]));
    const auto trim = static_cast<std::ptrdiff_t>(0.002 * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + trim, values.end());
    extent.low[axis] = values[static_cast<std::size_t>(trim)];
    std::nth_element(values.begin(), values.end() - 1 - trim, values.end());
    extent.high[axis] = values[values.size() - 1 - static_cast<std::size_t>(trim)];
  }
  extent.empty = false;
  return extent;
}

View fit_view(const Orientation& orientation, const Extent& extent, const Box& box, double margin_px) {
  const Eigen::Vector2d size = extent.size().cwiseMax(1e-6);
  View view;
  view.orientation = orientation;
  view.scale_px_mm =
      std::min((box.width - 2.0 * margin_px) / size.x(), (box.height - 2.0 * margin_px) / size.y());
  view.centre_mm = 0.5 * (extent.low + extent.high);
  view.centre_px = {box.x + 0.5 * box.width, box.y + 0.5 * box.height};
  return view;
}

}  // namespace arris::report
