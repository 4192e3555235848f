#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "acquisition/clean.hpp"
#include "acquisition/files/atomic_file.hpp"
#include "acquisition/files/read_scan.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/thin.hpp"
#include "acquisition/types/error.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/drawing.hpp"
#include "cli/interrupt.hpp"
#include "cli/json_output.hpp"
#include "cli/prepare.hpp"
#include "cli/recipe_options.hpp"
#include "cli/version.hpp"
#include "registration/deviation.hpp"
#include "registration/whole_fit.hpp"
#include "report/deviation_rows.hpp"

namespace arris {
namespace {

constexpr std::size_t kPosePoints = 20000;  // of the cloud that the start pose is searched on
constexpr double kReachMm = 25.0;           // as in a run
constexpr double kScaleScores = 3.0, kScaleSpacings = 4.0;
constexpr std::size_t kChunk = 65536;
constexpr std::size_t kWrittenAtOnce = 4 * kChunk;

/// What reading the drawing needed for a while goes back to the system, before the scan comes.
CadModel read_cad(const Recipe& recipe, int threads) {
  CadModel cad = [&] {
    const Drawing drawing = read_drawing(recipe, false, threads);
    return prepare_cad(drawing.mesh, drawing.accepted, drawing.others, threads);
  }();
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
  return cad;
}

/// Where the whole scan's fit begins: frame Scan about the cloud's offset.
struct Start {
  RigidMotion scan_from_cad;
  WholeFitOptions options;
};

Start start_pose(const Recipe& recipe, const CadModel& cad, const Scan& scan, int threads) {
  const CoarseAlignOptions coarse = registration_options(recipe, threads).coarse;
  Start start;
  start.options.threads = threads;
  if (coarse.initial_scan_from_cad) {  // the recipe speaks of the file's coordinates
    start.scan_from_cad = *coarse.initial_scan_from_cad;
    start.scan_from_cad.pretranslate(-scan.cloud.offset_mm);
    return start;
  }
  Scan thin;
  thin.cloud = thinned_to(scan.cloud, kPosePoints);
  thin.cloud = clean(thin.cloud, clean_options(recipe, threads)).cloud;
  PrepareOptions options;
  options.contour = contour_options(recipe, threads);
  options.threads = threads;
  if (recipe.scan.seen_from.size() == 3) options.seen_from_mm = Eigen::Vector3d(recipe.scan.seen_from.data());
  const PreparedScan prepared = prepare_scan(thin, options);
  const CoarseAlignment found = coarse_align(cad, prepared.model, coarse);
  if (!found.usable() || found.mirrored || found.inverted)
    throw Error(Fault::kInput, {.what = "the scan's pose was not found",
                                .found = found.reason,
                                .needed = "contours of the drawing in the scan, or a start pose",
                                .next = "give scan.initial in the recipe"});
  start.scan_from_cad = found.scan_from_cad;
  start.options.start_scale_mm =  // far from the contours a bent part may be off by more than the pose
      std::max({start.options.start_scale_mm, kScaleScores * found.score_mm,
                kScaleSpacings * prepared.model.spacing_mm});
  return start;
}

/// Of the points that have a deviation.
struct MapSummary {
  std::size_t count = 0, in_tolerance = 0;
  double sum_mm = 0.0, sum2_mm2 = 0.0;
  double least_mm = std::numeric_limits<double>::infinity(), most_mm = -least_mm;
  MapSummary& operator+=(const MapSummary& other) {
    count += other.count;
    in_tolerance += other.in_tolerance;
    sum_mm += other.sum_mm;
    sum2_mm2 += other.sum2_mm2;
    least_mm = std::min(least_mm, other.least_mm);
    most_mm = std::max(most_mm, other.most_mm);
    return *this;
  }
};

MapSummary summary_of(const std::vector<float>& deviation_mm, double tolerance_mm, int threads) {
  return parallel_sum(deviation_mm.size(), kChunk, threads, MapSummary(), [&](std::size_t b, std::size_t e) {
    MapSummary part;
    for (std::size_t i = b; i < e; ++i) {
      const double d_mm = deviation_mm[i];
      if (std::isnan(d_mm)) continue;
      part += {1, std::abs(d_mm) <= 0.5 * tolerance_mm ? 1U : 0U, d_mm, d_mm * d_mm, d_mm, d_mm};
    }
    return part;
  });
}

void write_map(const std::filesystem::path& file, const report::DeviationRows& rows, int threads) {
  AtomicFile out(file);
  out.stream() << report::deviation_header(rows);
  std::array<std::string, kWrittenAtOnce / kChunk> parts;
  for (std::size_t first = 0; first < rows.cloud.size(); first += kWrittenAtOnce) {
    const std::size_t count = std::min(kWrittenAtOnce, rows.cloud.size() - first);
    for (std::string& part : parts) part.clear();
    parallel_for(count, kChunk, threads, [&](std::size_t begin, std::size_t end) {
      report::append_deviation_rows(rows, first + begin, first + end, parts[begin / kChunk]);
    });
    for (const std::string& part : parts) out.stream().write(part.data(), std::ssize(part));
  }
  out.commit();
}

void print_map(const MapArgs& args, const Recipe& recipe, const std::filesystem::path& file,
               std::size_t points, const WholeFit& fit, const MapSummary& summary) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, summary.count));
  const double mean_mm = summary.sum_mm / count, rms_mm = std::sqrt(summary.sum2_mm2 / count);
  const double in_ratio = static_cast<double>(summary.in_tolerance) / count;
  if (args.json) {
    console::print(map_json({file.string(), points, summary.count, mean_mm, rms_mm, summary.least_mm,
                             summary.most_mm, in_ratio, fit.scan_from_cad, fit.free_directions}));
    return;
  }
  console::print(fmt::format("points       {}, {} of them on the drawing", points, summary.count));
  console::print(fmt::format(
      "fit          best fit of the whole scan, {:.4f} mm rms; pose known to {:.4f} mm (standard deviation)",
      fit.rms_mm, fit.sd_mm));
  for (const std::string& free : fit.free_directions) console::print("not determined: " + free);
  if (summary.count > 0)
    console::print(fmt::format("deviation    mean {:.4f} mm, rms {:.4f}, from {:.4f} to {:.4f}", mean_mm,
                               rms_mm, summary.least_mm, summary.most_mm));
  console::print(fmt::format("within       +-{:.3f} mm: {:.2f} %", 0.5 * recipe.tolerance.surface_profile_mm,
                             100.0 * in_ratio));
  console::print("wrote        " + file.string());
}

}  // namespace

int run_map(const MapArgs& args) {
  const Recipe recipe = read_recipe(args.recipe);
  const CadModel cad = read_cad(recipe, args.threads);
  Scan scan = read_scan(args.scan, unit_mm(recipe.scan.units));
  stop_if_interrupted();
  const Start start = start_pose(recipe, cad, scan, args.threads);
  scan.cloud.normals = {};  // the side is known: a third of the memory
  scan.triangles = {};
  WholeFit fit = fit_whole(cad.surface, scan.cloud.points_mm, start.scan_from_cad, start.options);
  if (!fit.usable())
    throw Error(Fault::kInput,
                {.what = "the scan does not fit the drawing",
                 .where = args.scan.string(),
                 .found = fit.reason,
                 .needed = "a scan of this part, near the start pose",
                 .next = "check scan.initial and scan.units of the recipe; of a bent part's band try "
                         "arris inspect, whose pose the contours hold"});
  stop_if_interrupted();
  const std::vector<float> deviation_mm =
      signed_deviation_mm(cad.surface, fit.scan_from_cad, scan.cloud.points_mm, kReachMm, args.threads);
  const MapSummary summary = summary_of(deviation_mm, recipe.tolerance.surface_profile_mm, args.threads);
  const report::ColourMap colours = report::colour_map_for(deviation_mm, recipe.tolerance.surface_profile_mm);
  const std::array<std::string, 1> comments = {version() + ", part " + recipe.part.number +
                                               ", best fit of the whole scan"};
  const std::filesystem::path file = args.out.value_or(args.scan.stem().string() + ".map.ply");
  write_map(file, {scan.cloud, deviation_mm, colours, comments}, args.threads);
  fit.scan_from_cad.pretranslate(scan.cloud.offset_mm);
  print_map(args, recipe, file, scan.cloud.size(), fit, summary);
  console::flush();
  return 0;
}

}  // namespace arris
