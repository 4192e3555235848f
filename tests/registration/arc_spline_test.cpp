#include "registration/arc_spline.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "fixtures/synthetic/random.hpp"

namespace arris {
namespace {

constexpr double kLengthMm = 500.0, kKnotMm = 40.0;

Eigen::VectorXd random_coefficients(int size, std::uint64_t seed) {
  synthetic::Random random(seed);
  Eigen::VectorXd c(size);
  for (double& value : c) value = random.normal();
  return c;
}

TEST(ArcSpline, PartitionOfUnityWithValidIndices) {
  for (const bool closed : {false, true})
    for (const double length_mm : {3.0, 100.0, kLengthMm}) {
      const ArcSpline spline(length_mm, closed, kKnotMm);
      EXPECT_LE(spline.knot_mm(), kKnotMm);
      EXPECT_GE(spline.size(), 4);
      for (int i = 0; i <= 1000; ++i) {
        const SplineRow row = spline.at(length_mm * i / 1000.0);
        double sum = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
          sum += row.value[k];
          EXPECT_GE(row.value[k], -1e-15);
          EXPECT_GE(row.index[k], 0);
          EXPECT_LT(row.index[k], spline.size());
        }
        EXPECT_NEAR(sum, 1.0, 1e-14);
      }
    }
}

TEST(ArcSpline, OpenReproducesConstantsLinesAndParabolas) {
  const ArcSpline spline(kLengthMm, false, kKnotMm);
  const double k = spline.knot_mm();
  Eigen::VectorXd line(spline.size()), parabola(spline.size());
  for (int j = 0; j < spline.size(); ++j) {  // coefficients from the blossoms of s and s^2
    line[j] = 3.0 + 0.7 * (j - 1) * k;
    parabola[j] = ((j - 1) * (j - 1) - 1.0 / 3.0) * k * k;
  }
  for (double s = 0.0; s <= kLengthMm; s += 0.37) {
    EXPECT_NEAR(spline.at(s).dot(Eigen::VectorXd::Constant(spline.size(), 2.5)), 2.5, 1e-12);
    EXPECT_NEAR(spline.at(s).dot(line), 3.0 + 0.7 * s, 1e-9);
    EXPECT_NEAR(spline.at(s).dot(parabola), s * s, 1e-7);
  }
  // Beyond the ends: the value at the end.
  EXPECT_NEAR(spline.at(kLengthMm + 5.0).dot(line), 3.0 + 0.7 * kLengthMm, 1e-9);
  EXPECT_NEAR(spline.at(-5.0).dot(line), 3.0, 1e-9);
}

TEST(ArcSpline, SlopeIsTheDerivativeOfTheValue) {
  for (const bool closed : {false, true}) {
    const ArcSpline spline(kLengthMm, closed, kKnotMm);
    const Eigen::VectorXd c = random_coefficients(spline.size(), 9);
    constexpr double kStepMm = 1e-4;
    for (double s = 1.3; s < kLengthMm; s += 3.7) {
      const double secant = (spline.at(s + kStepMm).dot(c) - spline.at(s - kStepMm).dot(c)) / (2.0 * kStepMm);
      EXPECT_NEAR(spline.slope_at(s).dot(c), secant, 1e-8) << closed << s;
    }
  }
}

/// Value, slope and second derivative at s of the cubic through s, s + h, s + 2 h, s + 3 h.
Eigen::Vector3d one_sided(const ArcSpline& spline, const Eigen::VectorXd& c, double s, double h) {
  double f[4];
  for (int i = 0; i < 4; ++i) f[i] = spline.at(s + i * h + 1e-9 * h).dot(c);
  return {f[0], (-11 * f[0] + 18 * f[1] - 9 * f[2] + 2 * f[3]) / (6 * h),
          (2 * f[0] - 5 * f[1] + 4 * f[2] - f[3]) / (h * h)};
}

TEST(ArcSpline, IsTwiceContinuousAtEveryKnotAndAcrossTheSeam) {
  const ArcSpline spline(kLengthMm, true, kKnotMm);
  const Eigen::VectorXd c = random_coefficients(spline.size(), 3);
  const double k = spline.knot_mm(), h = k / 4.0;
  for (int j = 0; j < spline.size(); ++j) {  // j = 0 is the seam
    const Eigen::Vector3d right = one_sided(spline, c, j * k, h), left = one_sided(spline, c, j * k, -h);
    EXPECT_NEAR(right[0], left[0], 1e-7) << j;
    EXPECT_NEAR(right[1], left[1], 1e-7) << j;
    EXPECT_NEAR(right[2], left[2], 1e-7) << j;
  }
  EXPECT_NEAR(spline.at(17.0).dot(c), spline.at(17.0 + kLengthMm).dot(c), 1e-12);
  EXPECT_NEAR(spline.at(17.0).dot(c), spline.at(17.0 - kLengthMm).dot(c), 1e-12);
}

TEST(ArcSpline, BendingIsTheSquaredSecondDerivativeAtTheKnots) {
  const double scale_per_mm = 2e-4;
  for (const bool closed : {false, true}) {
    const ArcSpline spline(kLengthMm, closed, kKnotMm);
    const Eigen::MatrixXd form = spline.bending(scale_per_mm);
    EXPECT_LT((form - form.transpose()).norm(), 1e-9 * form.norm());
    EXPECT_NEAR((form * Eigen::VectorXd::Ones(spline.size())).norm(), 0.0, 1e-9 * form.norm());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(form);
    // Free: constants, and on an open contour lines.
    const int free = closed ? 1 : 2;
    EXPECT_LT(eigen.eigenvalues()[free - 1], 1e-9 * eigen.eigenvalues().maxCoeff());
    EXPECT_GT(eigen.eigenvalues()[free], 1e-9 * eigen.eigenvalues().maxCoeff());
    const Eigen::VectorXd c = random_coefficients(spline.size(), 8);
    double sum = 0.0;
    const int knots = closed ? spline.size() : spline.size() - 2;
    for (int j = 0; j < knots; ++j) {
      const bool last = !closed && j + 1 == knots;
      const double second =
          one_sided(spline, c, j * spline.knot_mm(), (last ? -0.25 : 0.25) * spline.knot_mm())[2];
      sum += second * second / (scale_per_mm * scale_per_mm);
    }
    EXPECT_NEAR(c.dot(form * c) / sum, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace arris
