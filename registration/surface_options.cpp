#include "registration/surface_options.hpp"

#include <string>

#include "acquisition/types/error.hpp"

namespace arris {

void SurfaceOptions::check() const {
  const auto need = [](bool holds, const char* field, double value, const char* bound) {
    if (!holds)
      throw Error(Fault::kRecipe, std::string(field) + " = " + std::to_string(value) + ", need " + bound);
  };
  need(band_mm > 0.0, "registration.subdivision.band_mm", band_mm, "> 0");
  need(node_spacing_mm >= 1.0, "registration.surface.node_spacing_mm", node_spacing_mm, ">= 1");
  need(prior.strain_ratio > 0.0, "registration.surface.strain", prior.strain_ratio, "> 0");
  need(prior.bend_per_mm > 0.0, "registration.surface.bend_per_mm", prior.bend_per_mm, "> 0");
  need(edge_share_ratio > 0.0 && edge_share_ratio <= 1.0, "registration.surface.edge_share", edge_share_ratio,
       "in (0, 1]");
  need(offset_sd_mm > 0.0, "registration.surface.offset_sd_mm", offset_sd_mm, "> 0");
  need(max_rounds >= 1, "registration.surface.max_rounds", max_rounds, ">= 1");
}

}  // namespace arris
