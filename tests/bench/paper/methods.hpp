#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/scan_trial.hpp"

namespace arris::bench {

/// A way to carry the path, by the name that the tables print.
struct Method {
  std::string name;
  std::function<std::optional<CarriedPath>(ScanTrial&)> carry;  ///< none: no result at all
};

[[nodiscard]] Method nominal_path();
[[nodiscard]] Method best_rigid_motion();
[[nodiscard]] Method rigid_icp();        ///< ours: surface and edge
[[nodiscard]] Method paper_rigid_icp();  ///< the paper's: contour points, point to point
/// Subdivision ICP as the paper chooses: from its rigid ICP, nearest contour points, its stability points.
[[nodiscard]] Method paper_subdivision();
/// The same on a contour cut into equal pieces, as in the paper's figure 5.
[[nodiscard]] Method paper_pieces(int pieces);
/// The whole chain with method `subdivision`; also on so many equal pieces.
[[nodiscard]] Method subdivision();
[[nodiscard]] Method subdivision_pieces(int pieces);
/// Methods with a model of the bending, and those that fit everything together; whole chains as well.
[[nodiscard]] std::vector<Method> projections();
[[nodiscard]] std::vector<Method> joint_fits();

/// Everything side by side, in the order of the tables.
[[nodiscard]] std::vector<Method> all_methods();

/// Options of the paper's subdivision ICP, and of ours on a contour that is cut into equal pieces.
[[nodiscard]] SubdivisionIcpOptions paper_options(const ScanTrial& trial);
[[nodiscard]] SubdivisionOptions equal_pieces(const ScanTrial& trial, int pieces);

}  // namespace arris::bench
