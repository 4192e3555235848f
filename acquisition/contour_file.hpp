#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/types/contour.hpp"

namespace arris {

/// Reads contours from delimited text with a header: x,y,z, and nx,ny,nz (out of the material), path, closed
/// as they are known, in any order; '#' comments, blank lines. A tool path serves as well: columns index and
/// feed_mm_s are passed over.
///   path     consecutive rows of one number are one contour, whose id it becomes; without it one contour, 1
///   closed   0 or 1, the same in all rows of a contour; without it a contour is closed if its last point
///            repeats its first. A closed one loses the repeated point
///   to_mm    mm in one unit of the file
///   returns  at least one contour, in the order of the file; source "file"
///   throws   Error(kInput), for rows with their line: file missing or empty, no header, unknown column,
///            coordinate or part of the normal missing, wrong number of fields, not a finite number, a normal
///            off length 1 by more than 1 %, a contour taken up again after another, `closed` that changes,
///            an open contour of one point or a closed one of two
[[nodiscard]] std::vector<Contour> read_contours(const std::filesystem::path& file, double to_mm);

/// The same from bytes; `name` is for messages.
[[nodiscard]] std::vector<Contour> read_contours_csv(std::string_view bytes, const std::string& name,
                                                     double to_mm);

/// Contours as comma-separated text that read_contours() takes, in mm, `title` as a comment; path is the
/// contour's place in the span, from 1. Normals only if every contour has one a point. 6 decimals, 9 for
/// normals. Throws Error(kBug) for a number that is not finite.
[[nodiscard]] std::string contours_csv(std::span<const Contour> contours, const std::string& title);

}  // namespace arris
