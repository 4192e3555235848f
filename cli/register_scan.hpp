#pragma once

#include "cli/measurement.hpp"
#include "cli/recipe.hpp"
#include "registration/registration.hpp"

namespace arris {

/// Registers a scan with its drawing. A start pose of the options is in file coordinates of the scan, as
/// recipes have it.
///   recipe  for messages: what it says of units and faces
///   throws  Error(kInput): the scan is mirrored or in another unit, the drawing inverted, no point near it
[[nodiscard]] Registration register_scan(const Recipe& recipe, const CadModel& cad, Measurement& measurement,
                                         RegistrationOptions options);

}  // namespace arris
