#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "registration/scene.hpp"
#include "registration/surface_basis.hpp"
#include "registration/surface_shape.hpp"

namespace arris {

/// One place of a nominal contour and the field's row there; CAD frame.
struct ContourStation {
  double arc_mm = 0.0;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d inward = Eigen::Vector3d::UnitX();  ///< unit, in the surface, into the material
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitY();
  double fan_per_mm = 0.0;  ///< how the material fans out behind the edge: curvature in the surface
  BasisRow row;
};

/// The stations of a contour: its own points, and between them at most step_mm apart.
[[nodiscard]] std::vector<ContourStation> contour_stations(const Curve& contour, const SurfaceBasis& basis,
                                                           double step_mm);

/// A contour moved by the field as it is now; CAD frame.
class CarriedContour {
 public:
  CarriedContour(const std::vector<ContourStation>& stations, bool closed,
                 const std::vector<Eigen::Vector3d>& shift_mm);

  struct Foot {
    std::size_t station = 0;  ///< the nearest one
    double arc_mm = 0.0;      ///< nominal
    double across_mm = 0.0;   ///< into the material
    double height_mm = 0.0;   ///< out of the material, from the tangent plane at the edge
    double distance_mm = 0.0;
  };
  /// The nearest place of the contour; none when it is reach_mm away or farther.
  [[nodiscard]] std::optional<Foot> foot_within(const Eigen::Vector3d& p_cad_mm, double reach_mm) const;
  [[nodiscard]] const Eigen::Vector3d& inward(std::size_t station) const { return inward_[station]; }
  [[nodiscard]] const Eigen::Vector3d& normal(std::size_t station) const { return normal_[station]; }

 private:
  const std::vector<ContourStation>& stations_;
  std::vector<Eigen::Vector3d> inward_, normal_;
  std::optional<Curve> curve_;
};

}  // namespace arris
