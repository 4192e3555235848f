#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "fixtures/synthetic/scan.hpp"
#include "registration/deformation_field.hpp"
#include "registration/scene.hpp"
#include "tests/support/truth.hpp"

namespace arris::bench {

/// What a method states of one path point, beside what is true: how far off it is in each direction, and the
/// standard deviation given. Along the contour and the axis may be unknown (NaN).
struct StatedError {
  enum Direction : std::size_t { kNormal, kAcross, kAlong, kAxis, kDirections };
  std::array<double, kDirections> error{}, sd{};  ///< mm; the axis in rad
  double turn_rad = 0.0;                          ///< of the surface normal, in all
  bool in_gap = false;
};

/// The nominal points (on contour 0) as the field maps them, beside the truth. A row is in a gap where its
/// true place lies in a missing disc of the scan. cad_from_local undoes the scan's true pose.
[[nodiscard]] std::vector<StatedError> stated_errors(const Truth& truth, const CadModel& cad,
                                                     const DeformationField& field,
                                                     const synthetic::SyntheticScan& scan,
                                                     const RigidMotion& cad_from_local,
                                                     const std::vector<Eigen::Vector3d>& nominal_mm);

/// Sum over path points of one direction.
class Coverage {
 public:
  void add(double error, double sd);
  Coverage& operator+=(const Coverage& other);
  [[nodiscard]] std::size_t count() const { return errors_.size(); }
  /// Share of the errors inside 1.96 standard deviations.
  [[nodiscard]] double inside_ratio() const;
  [[nodiscard]] double rms() const;
  /// Median of the stated bounds (1.96 standard deviations) over the rms error.
  [[nodiscard]] double bound_ratio() const;

 private:
  std::vector<float> errors_, bounds_;
};

/// Every direction, outside the gaps and in them.
struct CoverageTable {
  std::array<std::array<Coverage, 2>, StatedError::kDirections> cells;  ///< [direction][in gap]
  void add(const std::vector<StatedError>& rows);
  [[nodiscard]] const Coverage& at(StatedError::Direction direction, bool in_gap) const {
    return cells[direction][in_gap ? 1 : 0];
  }
};

}  // namespace arris::bench
