#include "cli/file_contours.hpp"

#include "acquisition/clean.hpp"
#include "acquisition/files/read_scan.hpp"
#include "cli/interrupt.hpp"
#include "cli/prepare.hpp"
#include "cli/recipe_options.hpp"

namespace arris {

FileContours find_file_contours(const std::filesystem::path& file, FileRole role, double to_mm,
                                const Recipe& recipe, int threads) {
  FileContours result;
  Scan scan = read_scan(file, to_mm);
  result.format = scan.format;
  stop_if_interrupted();
  if (scan.is_mesh()) result.mesh = read_mesh(file, to_mm);
  if (scan.is_mesh() && role == FileRole::kDrawing) {
    result.contours = mesh_contours(result.mesh, contour_options(recipe, threads));
    return result;
  }
  if (!scan.is_mesh()) scan.cloud = clean(scan.cloud, clean_options(recipe, threads)).cloud;
  PrepareOptions options{.seen_from_mm = {}, .contour = contour_options(recipe, threads), .threads = threads};
  if (const std::vector<double>& seen = recipe.scan.seen_from; seen.size() == 3)
    options.seen_from_mm = Eigen::Vector3d(seen[0], seen[1], seen[2]);
  result.contours = prepare_scan(scan, options).contours;
  result.offset_mm = scan.cloud.offset_mm;
  for (Eigen::Vector3d& vertex : result.mesh.vertices_mm) vertex -= result.offset_mm;
  result.cloud = std::move(scan.cloud);
  return result;
}

}  // namespace arris
