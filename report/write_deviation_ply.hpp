#pragma once

#include <string>

#include "report/run_record.hpp"

namespace arris::report {

/// deviation.ply: the scan, binary little endian, one vertex a point in the scan's order:
///   x y z          the file's coordinates, mm; float, or double when the cloud has an offset (float would
///   lose it) deviation_mm   float, positive outside the material; NaN: no data red green blue the run's
///   colour scale
/// Comments carry version, result_hash, unit and sign. Points without a deviation entry have NaN.
[[nodiscard]] std::string write_deviation_ply(const RunRecord& record);

}  // namespace arris::report
