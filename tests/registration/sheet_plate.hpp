#pragma once

#include <vector>

#include "registration/surface_ground.hpp"
#include "registration/surface_system.hpp"
#include "tests/registration/scenes.hpp"

namespace arris::scenes {

/// A flat plate with an opening, its cells and nodes, and what the priors alone say of it.
struct SheetPlate {
  CadModel cad = cad_of(synthetic::PlatePart(synthetic::plate_with_rounded_rectangle()));
  SurfaceGround ground = even_ground(cad, 60.0, 30.0);
  SheetPrior prior;
  std::vector<Eigen::Vector3d> unmoved{ground.basis->size(), Eigen::Vector3d::Zero()};

  [[nodiscard]] SurfaceSystem priors(const std::vector<Eigen::Vector3d>& shift_mm,
                                     const SheetPrior& of) const {
    SurfaceSystem system(ground.basis->band(), 0);
    for (const SheetCell& cell : ground.sheet) cell.add(shift_mm, of, system);
    return system;
  }
};

}  // namespace arris::scenes
