#include "cli/measurement.hpp"

#include <algorithm>
#include <numeric>

#include "acquisition/clean.hpp"
#include "acquisition/drop_points.hpp"
#include "acquisition/files/read_scan.hpp"
#include "acquisition/types/error.hpp"
#include "cli/recipe_options.hpp"

namespace arris {
namespace {

constexpr double kSamePointMm = 1e-3;  // a choice holds the scan's own points, rounded

/// Marks the loops that the operator did not accept.
void use_choice(const ContourChoice& choice, const Eigen::Vector3d& offset_mm, ScanModel& model) {
  const std::vector<Contour> accepted = choice.accepted();
  model.loop_rejected.assign(model.loops.size(), 1);
  for (std::size_t l = 0; l < model.loops.size(); ++l)
    for (const Contour& contour : accepted)
      for (const Eigen::Vector3d& p : contour.points_mm)
        if ((p - offset_mm - model.loops[l].points_mm.front()).norm() < kSamePointMm)
          model.loop_rejected[l] = 0;
}

void note_loops(const PreparedScan& prepared, std::vector<std::string>& notes) {
  notes.insert(notes.end(), prepared.contours.notes.begin(), prepared.contours.notes.end());
  for (const FoundContour& found : prepared.contours.found)
    if (!found.note.empty())
      notes.push_back("scan contour " + std::to_string(found.contour.id) + ": " + found.note);
  if (!prepared.contours.dropped.empty())
    notes.push_back(std::to_string(prepared.contours.dropped.size()) +
                    " short scan contours dropped as voids of the sampling");
}

/// Solves the scanner's frame and takes the points of the targets out of the scan.
///   returns  for each point that is left, its number in the scan as read
std::vector<std::int32_t> take_targets_out(const TargetSearch& targets, Scan& scan,
                                           Measurement& measurement) {
  const Eigen::Vector3d offset_mm = scan.cloud.offset_mm;
  std::vector<ScanTarget> points = targets.points;
  for (ScanTarget& point : points) point.place_mm -= offset_mm;
  TargetFrame frame = solve_targets(targets.list, local_points_mm(scan.cloud), points, targets.options);
  frame.robot_from_scan.translate(-offset_mm);
  for (TargetSighting& sighting : frame.targets)
    if (sighting.found) sighting.scan_mm += offset_mm;
  ThinnedScan thinned = drop_points(scan, frame.points);
  scan = std::move(thinned.scan);
  if (!frame.points.empty())
    measurement.notes.push_back(std::to_string(frame.points.size()) +
                                " points on fixture targets and their mounts: shown, not judged");
  measurement.notes.insert(measurement.notes.end(), frame.notes.begin(), frame.notes.end());
  for (const std::int32_t i : frame.points) measurement.kept[static_cast<std::size_t>(i)] = 0;
  measurement.frame = std::move(frame);
  return std::move(thinned.kept);
}

}  // namespace

Measurement read_measurement(const Recipe& recipe, const std::filesystem::path& scan_file,
                             const std::optional<ContourChoice>& choice,
                             const std::optional<TargetSearch>& targets, int threads) {
  Measurement measurement;
  if (!recipe.scan.edge_calibration.empty()) measurement.edge = read_edge_file(recipe.scan.edge_calibration);
  Scan scan = read_scan(scan_file, unit_mm(recipe.scan.units));
  measurement.cloud = scan.cloud;
  measurement.points_nonfinite = scan.dropped_nonfinite;
  measurement.notes = scan.notes;
  measurement.kept.assign(scan.cloud.size(), 1);
  std::vector<std::int32_t> as_read(scan.cloud.size());
  std::iota(as_read.begin(), as_read.end(), 0);
  if (targets) as_read = take_targets_out(*targets, scan, measurement);
  if (!scan.is_mesh()) {  // a mesh was cleaned by the scanner's own software, and its triangles need every
                          // vertex
    Cleaned cleaned = clean(scan.cloud, clean_options(recipe, threads));
    measurement.points_outlier = cleaned.dropped_outliers;
    measurement.points_voxel = cleaned.dropped_by_voxel;
    if (cleaned.dropped_by_voxel == 0) {  // thinning drops good points
      std::fill(measurement.kept.begin(), measurement.kept.end(), char{0});
      for (const std::int32_t i : cleaned.kept)
        measurement.kept[static_cast<std::size_t>(as_read[static_cast<std::size_t>(i)])] = 1;
    }
    scan.cloud = std::move(cleaned.cloud);
  }
  PrepareOptions options;
  options.contour = contour_options(recipe, threads);
  options.threads = threads;
  if (recipe.scan.seen_from.size() == 3)
    options.seen_from_mm =
        Eigen::Vector3d(recipe.scan.seen_from[0], recipe.scan.seen_from[1], recipe.scan.seen_from[2]);
  measurement.prepared = prepare_scan(scan, options);
  note_loops(measurement.prepared, measurement.notes);
  if (choice) use_choice(*choice, scan.cloud.offset_mm, measurement.prepared.model);
  return measurement;
}

}  // namespace arris
