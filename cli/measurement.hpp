#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/types/point_cloud.hpp"
#include "cli/contours_file.hpp"
#include "cli/edge_file.hpp"
#include "cli/prepare.hpp"
#include "cli/recipe.hpp"
#include "registration/fixture_targets.hpp"

namespace arris {

/// The fixture targets to look for in a scan.
struct TargetSearch {
  std::vector<FixtureTarget> list;  ///< robot's base frame
  std::vector<ScanTarget> points;   ///< that the scanner's software gave; file coordinates of the scan
  TargetOptions options;
};

/// The scan as the run uses it.
struct Measurement {
  PointCloud cloud;        ///< as read, without points that are not finite; frame Scan about its offset
  std::vector<char> kept;  ///< one a point of cloud: 0 for what cleaning dropped and for fixture targets,
                           ///< which are shown and not judged
  PreparedScan prepared;
  std::optional<TargetFrame> frame;  ///< from the targets asked for; file coordinates of the scan
  std::optional<EdgeFile> edge;      ///< of the scanner, when the recipe names a calibration
  std::size_t points_nonfinite = 0, points_outlier = 0, points_voxel = 0;
  std::vector<std::string> notes;
};

/// Reads, cleans and prepares a scan; the operator's contours, when given, take the place of those found.
/// Fixture targets are looked for when there are some, and taken out before anything else is made of the
/// scan.
///   throws  Error(kInput): the file, no point left, a choice of contours made for another file; as
///           read_edge_file()
[[nodiscard]] Measurement read_measurement(const Recipe& recipe, const std::filesystem::path& scan_file,
                                           const std::optional<ContourChoice>& choice,
                                           const std::optional<TargetSearch>& targets, int threads);

}  // namespace arris
