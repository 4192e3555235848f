#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fixtures/synthetic/scan.hpp"
#include "tests/support/bench_part.hpp"

namespace arris::bench {

/// A tool path as one method carried it; CAD frame, the scan's true pose undone.
struct CarriedPath {
  std::vector<Eigen::Vector3d> tips_mm, axes;
  std::vector<std::string> reasons;  ///< why the program would refuse it; empty: it would write it
};

/// One scan of a part, prepared once for all methods, and the paths that they make of it.
class ScanTrial {
 public:
  /// Keeps references. Throws what reading and preparing throw.
  ScanTrial(const BenchPart& part, const synthetic::SyntheticScan& scan);

  [[nodiscard]] const BenchPart& part() const { return part_; }
  [[nodiscard]] const synthetic::SyntheticScan& scan() const { return scan_; }
  [[nodiscard]] const ScanModel& model() const { return prepared_.model; }
  /// Start pose and rigid ICP of our own, by method `rigid`.
  [[nodiscard]] const Registration& rigid() const { return rigid_; }
  [[nodiscard]] bool has_pose() const { return rigid_.coarse.usable() && rigid_.rigid.usable(); }
  /// The paper's rigid ICP from the same start pose: contour points, point to point. Needs a pose.
  [[nodiscard]] RigidMotion paper_rigid() const;
  /// The recipe's options with the threads of the part.
  [[nodiscard]] RegistrationOptions options() const;
  /// Scan edge points as the rolling disc found them.
  [[nodiscard]] EdgeData raw_edge() const;

  /// The whole chain with these options; the path also when it would be refused, none without a field.
  [[nodiscard]] std::optional<CarriedPath> chain(const RegistrationOptions& options);
  /// The nominal path carried by one motion, or by the motion of the nearest place on the contour.
  [[nodiscard]] CarriedPath carried(const RigidMotion& local_from_cad) const;
  [[nodiscard]] CarriedPath carried(const ContourMotion& motion) const;
  /// The nominal path where it would be in a part that lay true and unbent.
  [[nodiscard]] CarriedPath nominal() const;
  /// By the best rigid motion there is: the true material points of the edge known.
  [[nodiscard]] CarriedPath best_rigid() const;
  /// A motion of this scan as seen from the CAD frame, the true pose undone.
  [[nodiscard]] const RigidMotion& cad_from_local() const { return cad_from_local_; }

 private:
  const BenchPart& part_;
  const synthetic::SyntheticScan& scan_;
  PreparedScan prepared_;
  RigidMotion cad_from_local_ = RigidMotion::Identity();
  Registration rigid_;
};

/// The path moved backwards: as far from the rigid one as `corrected`, to the other side.
[[nodiscard]] CarriedPath backwards(const CarriedPath& rigid, const CarriedPath& corrected);

}  // namespace arris::bench
