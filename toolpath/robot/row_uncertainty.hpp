#pragma once

#include <Eigen/Core>
#include <vector>

#include "registration/fixture_targets.hpp"
#include "toolpath/correct.hpp"

namespace arris {

/// How well a row's place is known in the robot's frame: the correction's own standard deviation and what the
/// scanner's frame adds there, squared and added. NaN where the correction states none.
struct RowUncertainty {
  double normal_mm = 0.0, across_mm = 0.0, along_mm = 0.0;  ///< along the tool's axis, across the path, along
  double frame_mm = 0.0;  ///< what the frame alone adds, in its worst direction
};

/// One a row of the correction.
///   offset_mm   the scan's ingest offset, as in corrected.csv
///   frame       of the scan file's coordinates; usable
[[nodiscard]] std::vector<RowUncertainty> row_uncertainty(const Correction& correction,
                                                          const Eigen::Vector3d& offset_mm,
                                                          const TargetFrame& frame);

}  // namespace arris
