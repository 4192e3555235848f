#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/types/fixture_target.hpp"

namespace arris {

/// Reads the list of fixture targets: comma-separated, with a header id,kind,x,y,z,diameter_mm,sd_mm in any
/// order, '#' comments and blank lines; mm, robot's base frame.
///   kind         sphere | point
///   diameter_mm  of a sphere, 5 to 500; empty for a point. The column may be left out when all are points
///   sd_mm        standard deviation of the place, each axis, 0 to 100
///   throws       Error(kInput), for rows with their line: file missing or empty, unknown or missing column,
///                wrong number of fields, not a finite number, an id that is empty or stands twice, fewer
///                than 3 or more than 40 targets
[[nodiscard]] std::vector<FixtureTarget> read_fixture_targets(const std::filesystem::path& file);

/// The same from bytes; `name` is for messages.
[[nodiscard]] std::vector<FixtureTarget> read_fixture_targets_csv(std::string_view bytes,
                                                                  const std::string& name);

/// Reads the points that the scanner's software exported beside the scan: a header x,y,z, and sd_mm, id as
/// they are known. Numbers of the scanner's session are not those of the fixture, so id is passed over.
///   to_mm    mm in one unit of the file, which is the scan's; sd_mm is mm as it says
///   returns  at least one point and at most 200, file coordinates of the scan
///   throws   Error(kInput) as above
[[nodiscard]] std::vector<ScanTarget> read_scan_targets(const std::filesystem::path& file, double to_mm);

/// The same from bytes; `name` is for messages.
[[nodiscard]] std::vector<ScanTarget> read_scan_targets_csv(std::string_view bytes, const std::string& name,
                                                            double to_mm);

}  // namespace arris
