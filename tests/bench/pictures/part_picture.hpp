#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "acquisition/types/triangle_mesh.hpp"
#include "report/picture_parts.hpp"

namespace arris::bench {

/// A line on a part; CAD frame.
struct PartLine {
  report::LegendItem item;
  std::vector<Eigen::Vector3d> points_mm;
  bool closed = true;
};

/// A part with what lies on it, as a PNG in the manner of the report's pictures; CAD frame.
struct PartPicture {
  std::string title, subtitle;
  TriangleMesh mesh;                       ///< grey, or in the colours of `value_mm`
  std::vector<float> value_mm;             ///< one a triangle
  std::vector<Eigen::Vector3d> points_mm;  ///< dots of a scan
  std::vector<PartLine> lines;
  std::vector<Eigen::Vector3d> dots_mm;                              ///< marked places
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> axes_mm;  ///< short lines, from and to
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< towards the eye, before the oblique turn
  bool is_oblique = true;
  bool shows_whole_mesh = false;  ///< else framed on the lines
};
[[nodiscard]] std::string part_png(const PartPicture& picture);

}  // namespace arris::bench
