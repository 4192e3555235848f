#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "acquisition/types/frames.hpp"
#include "fixtures/synthetic/part.hpp"

namespace arris::bench {

/// How far a carried path lies from the true edge. Means and the greatest over the rows, absolute; mm.
struct PathError {
  double mean_mm = 0.0, max_mm = 0.0;  ///< distance to the true curve
  double normal_mm = 0.0;              ///< its mean part normal to the surface
  double across_mm = 0.0;              ///< its mean part in the surface, across the contour
  double along_mm = 0.0;               ///< mean arc length between the foot and the row's own material point
};

/// One point of a carried path and its foot on the edge.
struct RowError {
  double arc_mm = 0.0;  ///< nominal arc length of the foot
  double distance_mm = 0.0;
  double normal_mm = 0.0;  ///< signed, positive out of the material
  double across_mm = 0.0;  ///< signed, in the surface, positive towards the void
  Eigen::Vector3d foot_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), into_void = Eigen::Vector3d::UnitX();  ///< there
};

/// The true edge of one part, all contours that the tool follows, CAD frame: what the fixture's elements say,
/// no code of the rooms.
class Truth {
 public:
  explicit Truth(const synthetic::Part& part);
  /// Contours one after the other, at equal steps.
  explicit Truth(std::vector<synthetic::EdgePoint> edge);

  /// Row i of the nominal path and where it was carried, both in the CAD frame (the scan's true pose undone);
  /// each against the contour that its nominal place is nearest to.
  [[nodiscard]] PathError error(std::span<const Eigen::Vector3d> nominal_mm,
                                std::span<const Eigen::Vector3d> carried_mm) const;
  /// Each carried row against the nearest true edge (deformed), or the drawing's (not deformed).
  [[nodiscard]] std::vector<RowError> rows(std::span<const Eigen::Vector3d> carried_mm, bool deformed) const;
  /// How far a carried row slid along the edge from its own material point; signed, mm.
  [[nodiscard]] double slid_mm(const Eigen::Vector3d& nominal_mm, const RowError& carried) const;
  /// Whether a point of the drawing lies within reach_mm of the nominal edge.
  [[nodiscard]] bool near_nominal(const Eigen::Vector3d& p_cad_mm, double reach_mm) const;
  [[nodiscard]] const std::vector<synthetic::EdgePoint>& edge() const { return edge_; }
  /// A circle alone may turn about its axis unseen: there "along" says nothing.
  [[nodiscard]] bool is_circle() const { return is_circle_; }

 private:
  struct Loop {
    synthetic::EdgeRange range;  ///< of edge_
    synthetic::PointGrid nominal, deformed;
  };
  struct Foot {
    std::size_t loop = 0;
    std::size_t chord = 0;  ///< from sample `chord` to the next
    double ratio = 0.0;
    Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();  ///< query less foot
  };
  [[nodiscard]] Foot nearest(bool deformed, const Eigen::Vector3d& p_mm) const;
  [[nodiscard]] Foot nearest(std::size_t loop, bool deformed, const Eigen::Vector3d& p_mm) const;
  [[nodiscard]] double slid_mm(const Foot& own, const RowError& carried) const;
  [[nodiscard]] double arc_mm(const Foot& foot) const;
  [[nodiscard]] RowError row(const Foot& foot, bool deformed, const Eigen::Vector3d& p_mm) const;

  std::vector<synthetic::EdgePoint> edge_;
  std::vector<Loop> loops_;
  bool is_circle_ = false;
};

}  // namespace arris::bench
