#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "acquisition/types/point_cloud.hpp"
#include "report/colour_map.hpp"

namespace arris::report {

/// A scan with its deviations, as deviation.ply has it: what is shown, and the file's comments.
struct DeviationRows {
  const PointCloud& cloud;
  std::span<const float> deviation_mm;  ///< one a point; missing ones count as NaN
  const ColourMap& colours;
  std::span<const std::string> comments;  ///< before those that every such file has
};

/// The header of the file: binary little endian, one vertex a point in the scan's order,
///   x y z          the file's coordinates, mm; float, or double when the cloud has an offset (float would
///                  lose it)
///   deviation_mm   float, positive outside the material; NaN: no data
///   red green blue the colour scale
[[nodiscard]] std::string deviation_header(const DeviationRows& rows);

/// Bytes of a row.
[[nodiscard]] std::size_t deviation_row_bytes(const DeviationRows& rows);

/// Appends the rows [begin, end): big scans are written piece by piece.
void append_deviation_rows(const DeviationRows& rows, std::size_t begin, std::size_t end, std::string& bytes);

}  // namespace arris::report
