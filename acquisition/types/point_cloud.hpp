#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace arris {

/// Points of one scan, mm, in the scanner's frame: float32 about a double offset that is chosen at ingest and
/// kept, so that coordinates far from the origin lose nothing (UTM-sized text files, a robot base 10 m away).
struct PointCloud {
  Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();  ///< add it to points_mm to get the file's coordinates
  std::vector<Eigen::Vector3f> points_mm;               ///< about offset_mm
  std::vector<Eigen::Vector3f> normals;  ///< empty, or one unit vector a point, out of the material

  [[nodiscard]] std::size_t size() const { return points_mm.size(); }
  [[nodiscard]] bool empty() const { return points_mm.empty(); }
  [[nodiscard]] bool has_normals() const { return !points_mm.empty() && normals.size() == points_mm.size(); }
  /// Point i relative to offset_mm, in double: the frame in which everything is computed.
  [[nodiscard]] Eigen::Vector3d local_mm(std::size_t i) const { return points_mm[i].cast<double>(); }
  /// Point i in the coordinates of the file.
  [[nodiscard]] Eigen::Vector3d file_mm(std::size_t i) const { return local_mm(i) + offset_mm; }
};

/// All points about the offset, in double (3 doubles a point); cost O(N).
[[nodiscard]] std::vector<Eigen::Vector3d> local_points_mm(const PointCloud& cloud);

/// What a scan file held: points, and triangles when it is a mesh (hand scanners export STL).
struct Scan {
  PointCloud cloud;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< empty for a cloud; indices into cloud.points_mm
  std::string format;                                  ///< "ply binary little endian", "stl ascii", ...
  std::string unit_hint;                               ///< a unit that a comment of the file names, or empty
  std::size_t dropped_nonfinite = 0;                   ///< NaN or infinite points that were left out
  std::vector<std::string> notes;                      ///< oddities worth a line in `arris info`

  [[nodiscard]] bool is_mesh() const { return !triangles.empty(); }
};

}  // namespace arris
