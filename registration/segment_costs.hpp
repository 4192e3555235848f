#pragma once

#include <Eigen/Core>
#include <array>

#include "acquisition/types/frames.hpp"

namespace arris {

/// Step of one segment: rotation vector (rad) before shift (mm), scan frame, about the image of its pivot.
using SegmentStep = Eigen::Matrix<double, 6, 1>;
using StepJacobian = Eigen::Matrix<double, 3, 6>;

/// Rotation of a rotation vector (rad), the left Jacobian of SO(3) there, d(exp w) = [J dw]_x exp w, and the
/// inverse of the right one; closed forms, by their series near zero (Sola, Deray and Atchuthan, "A micro Lie
/// theory", 2018, eq. 143 to 146).
[[nodiscard]] Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn_rad);
[[nodiscard]] Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& turn_rad);
[[nodiscard]] Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& turn_rad);
/// Rotation vector of a rotation; its angle is in [0, pi].
[[nodiscard]] Eigen::Vector3d turn_of(const Eigen::Matrix3d& rotation);

/// Share of one segment in the image of a point: where it takes the point, and how much that counts.
struct Carrier {
  int segment = 0;
  double weight = 1.0;  ///< of the blend (eq. 7, repaired)
  Eigen::Vector3d arm_mm =
      Eigen::Vector3d::Zero();  ///< image of the point less that of the pivot, scan frame

  /// Image less the image without a step; mm, scan frame, without the weight.
  [[nodiscard]] Eigen::Vector3d moved_mm(const SegmentStep& step) const;
  [[nodiscard]] StepJacobian jacobian(const SegmentStep& step) const;
};

/// A point of the part that the blended segments carry to a measured one, seen along one or two directions:
/// an edge point across and normal to the contour, or a surface point along the normal.
struct CarriedCost {
  std::array<Carrier, 2> carriers;
  int carrier_count = 1;
  int rows = 1;
  Eigen::Vector3d gap_mm = Eigen::Vector3d::Zero();  ///< image less measured point, without a step
  Eigen::Matrix<double, 2, 3> directions =
      Eigen::Matrix<double, 2, 3>::Zero();  ///< unit / standard deviation, 1/mm, scan frame; held in a round
  double weight = 1.0;                      ///< of its squared residual: less than 1 for correlated points

  [[nodiscard]] Eigen::Vector2d residual(const std::array<SegmentStep, 2>& steps) const;
  [[nodiscard]] Eigen::Matrix<double, 2, 6> jacobian(const std::array<SegmentStep, 2>& steps,
                                                     std::size_t of) const;
};

/// Two neighbours at their common cut: they take it to one place, and turn the part alike. Rows: place along,
/// across and normal to the contour, then turn about these three axes.
struct SeamCost {
  std::array<Carrier, 2> sides;  ///< of the cut's point; weights are not used
  std::array<Eigen::Matrix3d, 2> rotations_scan_from_cad = {Eigen::Matrix3d::Identity(),
                                                            Eigen::Matrix3d::Identity()};
  Eigen::Vector3d gap_mm = Eigen::Vector3d::Zero();          ///< first image less second, without a step
  Eigen::Matrix3d place_rows = Eigen::Matrix3d::Identity();  ///< unit / standard deviation, 1/mm, scan frame
  Eigen::Matrix3d turn_rows = Eigen::Matrix3d::Identity();   ///< unit / standard deviation, 1/rad, CAD frame

  [[nodiscard]] Eigen::Matrix<double, 6, 1> residual(const std::array<SegmentStep, 2>& steps) const;
  [[nodiscard]] Eigen::Matrix<double, 6, 6> jacobian(const std::array<SegmentStep, 2>& steps,
                                                     std::size_t of) const;
};

/// A segment stays where it began along directions that no data hold, such as round a circle.
struct AnchorCost {
  int segment = 0;
  Eigen::Vector3d offset_mm =
      Eigen::Vector3d::Zero();  ///< of its pivot's image from where it began, scan frame
  Eigen::Matrix<double, 3, 3> shift_rows = Eigen::Matrix3d::Identity();  ///< unit / standard deviation, 1/mm
  double turn_sd_rad = 0.3;

  [[nodiscard]] SegmentStep residual(const SegmentStep& step) const;
  [[nodiscard]] Eigen::Matrix<double, 6, 6> jacobian() const;
};

/// Geman-McClure's loss of a squared residual s with scale c: c^2 s / (c^2 + s), and its two derivatives by
/// s.
[[nodiscard]] std::array<double, 3> geman_mcclure(double squared, double scale);

}  // namespace arris
