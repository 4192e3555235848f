#pragma once

#include <cstdint>
#include <string>

#include "fixtures/synthetic/scan.hpp"
#include "tests/bench/pose/pose_part.hpp"

namespace arris::bench {

/// What stands in the scanner's way.
struct PoseScene {
  std::string name;
  synthetic::ScanOptions scan;
};
/// The scenes of trial number `number`: each kind of clutter in turn, then all at once.
[[nodiscard]] std::vector<PoseScene> pose_scenes();

enum class PoseVerdict { kRight, kRefused, kWrong };

/// One search from nothing, and how far its pose is off; mm, means over the followed contours.
struct PoseTrial {
  PoseVerdict verdict = PoseVerdict::kRefused;
  std::string reason;                            ///< of the refusal
  int equal_poses = 1;                           ///< that the program reported
  std::string start;                             ///< what found the pose
  double off_mm = 0.0;                           ///< carried contour to true curve, after the rigid stage
  double best_off_mm = 0.0;                      ///< the same by the best rigid motion there is
  double score_mm = 0.0, runner_up_ratio = 0.0;  ///< that the program reported
  double search_ms = 0.0;
};

/// Scans the part in a random pose, searches it, and compares with the truth. Right: the same side is up, and
/// the rigid stage from the pose found ends within half a point spacing of what the best rigid motion there
/// is leaves (material points known); where it ends farther off, the whole job with the surface field
/// decides: accepted, with its path within a quarter of a spacing of the true curves, is right; accepted
/// beyond that is wrong; refused is refused.
[[nodiscard]] PoseTrial try_pose(const PosePart& part, const PoseScene& scene, std::uint64_t seed,
                                 int threads);

}  // namespace arris::bench
