#pragma once

#include <filesystem>
#include <optional>

#include "acquisition/contour_extract.hpp"
#include "acquisition/types/point_cloud.hpp"
#include "acquisition/types/triangle_mesh.hpp"
#include "cli/recipe.hpp"

namespace arris {

/// The contours of a file, drawing or scan, with what they were found in.
struct FileContours {
  ContourSet contours;                                  ///< about `offset_mm`
  Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();  ///< add it to get the file's coordinates, mm
  PointCloud cloud;                                     ///< of a scan, cleaned
  TriangleMesh mesh;                                    ///< of a mesh, about offset_mm
  std::string format;
};

/// What the file is: a mesh may be the drawing (its one-face or sharp edges) or a scan (its one-face edges,
/// filled holes).
enum class FileRole { kDrawing, kScan };

/// Finds the contours of a file as `arris run` does. A file without triangles is a scan whatever the role:
/// angle gaps.
///   to_mm    what one unit of the file is
///   recipe   its [scan] cleaning and [contour] options
[[nodiscard]] FileContours find_file_contours(const std::filesystem::path& file, FileRole role, double to_mm,
                                              const Recipe& recipe, int threads);

}  // namespace arris
