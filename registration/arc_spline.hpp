#pragma once

#include <Eigen/Core>
#include <array>

namespace arris {

/// The four cubic B-splines that are not zero at one place.
struct SplineRow {
  std::array<int, 4> index{};
  std::array<double, 4> value{};  ///< of ArcSpline::at(): sum 1
  [[nodiscard]] double dot(const Eigen::VectorXd& coefficients) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) sum += value[k] * coefficients[index[k]];
    return sum;
  }
};

/// Uniform cubic B-splines along a contour: a smooth number at each arc length. Periodic on a closed contour.
class ArcSpline {
 public:
  /// Knots at most knot_mm apart; at least 4 functions.
  ArcSpline(double length_mm, bool closed, double knot_mm);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] double knot_mm() const { return knot_mm_; }
  [[nodiscard]] SplineRow at(double arc_mm) const;
  /// Their derivatives by arc length, 1/mm; sum 0. Beyond the ends of an open contour: those at the end.
  [[nodiscard]] SplineRow slope_at(double arc_mm) const;
  /// Quadratic form of (second derivative / scale)^2, one sample a knot; c' P c, 1/scale in 1/mm.
  [[nodiscard]] Eigen::MatrixXd bending(double scale_per_mm) const;

 private:
  /// Fills in the indices; returns the place within the piece, 0 to 1.
  double locate(double arc_mm, SplineRow& row) const;
  double length_mm_, knot_mm_;
  bool closed_;
  int size_;
};

}  // namespace arris
