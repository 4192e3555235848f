#include "registration/coarse_context.hpp"

namespace arris {

CoarseContext::CoarseContext(const CadModel& cad, const ScanModel& scan, const CoarseAlignOptions& options)
    : cad(cad),
      scan(scan),
      options(options),
      search(cad, options.band_mm, options.threads),
      fitness(scan.spacing_mm, search.score().cap_mm(), options.edges_needed) {}

const LightScan& CoarseContext::light(bool flip) {
  std::optional<LightScan>& made = light_[flip ? 1 : 0];
  if (!made) made.emplace(scan, flip, false);
  return *made;
}

}  // namespace arris
