#include "tests/support/bench_part.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/clean.hpp"
#include "cli/recipe_options.hpp"

namespace arris::bench {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points tips(const ToolPath& path) {
  Points points;
  for (const PathPoint& row : path.points) points.push_back(row.tip_mm);
  return points;
}

/// The nominal face in the band: what a peer that knows no triangles registers.
Points surface_points(const synthetic::Part& part, const Truth& truth) {
  const double spacing_mm =
      std::sqrt(part.band_area_mm2(part.band_mm()) / static_cast<double>(part.scan_points()));
  Points points;
  for (const synthetic::AreaSample& sample : part.area_samples(spacing_mm))
    if (truth.near_nominal(sample.nominal_mm, part.band_mm())) points.push_back(sample.nominal_mm);
  const std::size_t wanted =
      std::min(points.size(), part.scan_points());  // cells are smaller where the mesh is
  for (std::size_t i = 0; i < wanted; ++i) points[i] = points[i * points.size() / wanted];
  points.resize(wanted);
  return points;
}

}  // namespace

BenchPart::BenchPart(const std::filesystem::path& folder, int thread_count)
    : fe(synthetic::load_fe_part(folder)),
      truth(fe),
      recipe(read_recipe(folder / "recipe.toml")),
      drawing(read_drawing(recipe, true, thread_count)),
      cad(prepare_cad(drawing.mesh, drawing.accepted, drawing.others)),
      path_mm(tips(drawing.path)),
      surface_mm(surface_points(fe, truth)),
      threads(thread_count) {}

std::vector<Eigen::Vector3d> contour_points(const CadModel& cad, double step_mm) {
  Points points;
  for (const Curve& curve : cad.contours) {
    const Points one = resample(curve.contour(), step_mm).points_mm;
    points.insert(points.end(), one.begin(), one.end());
  }
  return points;
}

PreparedScan prepare(const Recipe& recipe, int threads, const PointCloud& cloud) {
  Scan scan;
  scan.cloud = clean(cloud, clean_options(recipe, threads)).cloud;
  PrepareOptions options;
  options.contour = contour_options(recipe, threads);
  options.threads = threads;
  return prepare_scan(scan, options);
}

PreparedScan prepare(const BenchPart& part, const PointCloud& cloud) {
  return prepare(part.recipe, part.threads, cloud);
}

Correction correct_path(const BenchPart& part, const Registration& registration) {
  return correct(part.drawing.path, part.cad.surface, *registration.field, registration.rigid.scan_from_cad,
                 correct_options(part.recipe, part.threads));
}

}  // namespace arris::bench
