#include "registration/arc_spline.hpp"

#include <algorithm>
#include <cmath>

namespace arris {

ArcSpline::ArcSpline(double length_mm, bool closed, double knot_mm) : length_mm_(length_mm), closed_(closed) {
  const int pieces = std::max(closed ? 6 : 2, static_cast<int>(std::ceil(length_mm / knot_mm)));
  knot_mm_ = length_mm / pieces;
  size_ = closed ? pieces : pieces + 3;
}

double ArcSpline::locate(double arc_mm, SplineRow& row) const {
  double position = arc_mm / knot_mm_;
  const int pieces = closed_ ? size_ : size_ - 3;
  if (closed_) {
    position -= std::floor(position / pieces) * pieces;
  } else {
    position = std::clamp(position, 0.0, static_cast<double>(pieces));
  }
  const int piece = std::min(static_cast<int>(position), pieces - 1);
  for (int k = 0; k < 4; ++k)
    row.index[static_cast<std::size_t>(k)] = closed_ ? (piece + k) % size_ : piece + k;
  return position - piece;
}

SplineRow ArcSpline::at(double arc_mm) const {
  SplineRow row;
  const double t = locate(arc_mm, row), u = 1.0 - t;
  row.value = {u * u * u / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
               (-3.0 * t * t * t + 3.0 * t * t + 3.0 * t + 1.0) / 6.0, t * t * t / 6.0};
  return row;
}

SplineRow ArcSpline::slope_at(double arc_mm) const {
  SplineRow row;
  const double t = locate(arc_mm, row), u = 1.0 - t;
  row.value = {-0.5 * u * u, 0.5 * (3.0 * t - 4.0) * t, 0.5 * ((2.0 - 3.0 * t) * t + 1.0), 0.5 * t * t};
  for (double& value : row.value) value /= knot_mm_;
  return row;
}

Eigen::MatrixXd ArcSpline::bending(double scale_per_mm) const {
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(size_, size_);
  const double factor = 1.0 / (knot_mm_ * knot_mm_ * scale_per_mm);
  const int rows = closed_ ? size_ : size_ - 2;
  for (int j = 0; j < rows; ++j) {
    const std::array<int, 3> column = {j, (j + 1) % size_, (j + 2) % size_};
    constexpr std::array<double, 3> kDifference = {1.0, -2.0, 1.0};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        form(column[a], column[b]) += factor * factor * kDifference[a] * kDifference[b];
  }
  return form;
}

}  // namespace arris
