#pragma once

#include "acquisition/clean.hpp"
#include "acquisition/contour_extract.hpp"
#include "cli/recipe.hpp"
#include "registration/registration.hpp"
#include "toolpath/correct.hpp"
#include "toolpath/from_contour.hpp"

namespace arris {

// The recipe's words and degrees as the options of each room.

[[nodiscard]] CleanOptions clean_options(const Recipe& recipe, int threads);
[[nodiscard]] ContourOptions contour_options(const Recipe& recipe, int threads);
[[nodiscard]] RegistrationOptions registration_options(const Recipe& recipe, int threads);
[[nodiscard]] CorrectOptions correct_options(const Recipe& recipe, int threads);
[[nodiscard]] FromContourOptions from_contour_options(const Recipe& recipe);

/// scan.initial.scan_from_cad as a motion: a 4x4 or 3x4 matrix row by row, or x, y, z, qw, qx, qy, qz; mm.
/// Throws Error(kRecipe) when it is no rigid motion (a mirror, a scale, a last row that is not 0 0 0 1).
[[nodiscard]] RigidMotion motion_from_numbers(const std::string& key, const std::vector<double>& numbers);

}  // namespace arris
