#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "acquisition/types/point_cloud.hpp"
#include "cli/recipe.hpp"
#include "registration/registration.hpp"
#include "toolpath/correct.hpp"

namespace arris::bench {

/// What a run needs beside its scan; references are kept by nobody.
struct RunInputs {
  const Recipe& recipe;
  const CadModel& cad;
  const ToolPath& path;
  int threads = 1;
};

/// The recipe's options, and a scanner that was calibrated: the synthetic one shows edges where they are.
[[nodiscard]] RegistrationOptions calibrated_options(const Recipe& recipe, int threads);

/// What `arris run` makes of one scan: from points in memory to the corrected path.
struct OneRun {
  Registration found;
  Correction correction;             ///< no rows without a field
  std::vector<std::string> reasons;  ///< of the refusal
  [[nodiscard]] bool accepted() const { return found.usable() && reasons.empty(); }
  /// Corrected tips, each carried by `to_from_local`.
  [[nodiscard]] std::vector<Eigen::Vector3d> tips_mm(const RigidMotion& to_from_local) const;
};
/// Throws what reading and preparing a scan throw.
[[nodiscard]] OneRun run_one(const RunInputs& inputs, const PointCloud& cloud,
                             const RegistrationOptions& options);

/// The pose as a cell knows it: the true one with a turn of at most 0.09 rad about about_mm and a shift of at
/// most 10 mm (so much of both as share_ratio says), drawn by seed. CAD frame to the one of local_from_cad.
[[nodiscard]] RigidMotion near_pose(const RigidMotion& local_from_cad, const Eigen::Vector3d& about_mm,
                                    std::uint64_t seed, double share_ratio = 1.0);

}  // namespace arris::bench
