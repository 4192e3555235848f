#pragma once

#include "registration/common_bend.hpp"
#include "registration/surface_system.hpp"

namespace arris {

/// Normal equations of a settled fit in three parts, the gradients with them. They add up; what the common
/// bend takes is not out yet.
struct FitParts {
  SurfaceSystem data;
  SurfaceSystem other_priors;  ///< all but the bends
  SurfaceSystem bends;         ///< scattering as expected about the likeliest common bend
  CommonBend common;
};

/// How far the bends of the sheet scatter about their common one, over what is expected: the share, at most 1
/// and in steps of 1.5 down to a hundredth, under which such a scan is likeliest (the evidence; MacKay,
/// Neural Computation 4(3), 1992). From 1 down as long as the scan becomes likelier.
///   errors  1 where an information is not positive definite
///   cost    two factorisations a step
[[nodiscard]] double likeliest_scatter_ratio(const FitParts& parts);

}  // namespace arris
