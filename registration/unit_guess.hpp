#pragma once

#include "registration/scene.hpp"

namespace arris {

/// The unit in which a loop of the scan would fit the drawing (25.4, 1000, 1/25.4, 1/1000), when the scan's
/// extent is not that of such a part as stated: a scan of many small loops has one of any length. 1: as
/// stated.
[[nodiscard]] double unit_that_fits(const CadModel& cad, const ScanModel& scan);

}  // namespace arris
