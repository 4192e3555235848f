#pragma once

#include <string>

#include "registration/coarse_candidates.hpp"

namespace arris {

/// What the other poses found say of the best one.
struct RivalVerdict {
  double runner_up_ratio = 0.0;  ///< how much worse the best pose elsewhere fits; 0: there was none
  int equal_poses = 1;           ///< that fit alike and lay the whole path on itself, the best one with them
  std::string reason;            ///< refusal in plain words; empty: the best one stands
};

/// The best pose elsewhere must be clearly worse, but where it lays the whole tool path on itself; and no
/// score is enough where the scan's edges do not tell the two apart. Cost: a long rigid ICP for each rival.
[[nodiscard]] RivalVerdict judge_rivals(CoarseContext& context, const CoarseCandidates& found);

}  // namespace arris
