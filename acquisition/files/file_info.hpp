#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace arris {

/// What a scan or mesh file holds. Lengths are in units of the file, whatever these are, for no format here
/// states them.
struct FileInfo {
  std::string format;              ///< "ply binary little endian", "text comma", ...
  std::uintmax_t bytes = 0;        ///< size of the file
  std::string sha256;              ///< of all its bytes
  std::size_t points = 0;          ///< rows of the file; of STL, corners that differ
  std::size_t finite = 0;          ///< of these, neither NaN nor infinite: what a reader keeps
  std::size_t triangles = 0;       ///< of finite points
  std::size_t flat_triangles = 0;  ///< of these, without area
  bool has_normals = false;
  bool has_colours = false;
  std::vector<std::string> extra_names;  ///< columns beyond coordinates and normals, colours included
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  ///< of the finite points
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
  double spacing = 0.0;   ///< median distance to the nearest other point; 0 for a mesh
  std::string unit_hint;  ///< a unit that a comment or header names: mm, cm, m, um, inch, ft
  std::string
      unit_guess;  ///< without a hint: mm or m by the extent of usual parts. A guess, to be shown as one
  std::vector<std::string> notes;  ///< what the reader found odd

  [[nodiscard]] Eigen::Vector3d extent() const { return box_max - box_min; }
};

/// Reads the whole file as read_scan() does and describes it; throws as that does.
[[nodiscard]] FileInfo inspect_file(const std::filesystem::path& file);

/// "mm" for a largest extent of 30 or more, "m" below 3, empty between: inches and centimetres live there
/// too.
[[nodiscard]] std::string guess_unit(double largest_extent);

/// Median distance from up to 255 points, spread over the list, to their nearest other point. Sorted into
/// slices along the longest axis, so that a point meets only its neighbours; cost O(N). 0 for fewer than two
/// points.
[[nodiscard]] double estimate_spacing(std::span<const Eigen::Vector3f> points);

}  // namespace arris
