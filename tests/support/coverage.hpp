#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "fixtures/synthetic/scan.hpp"
#include "registration/deformation_field.hpp"
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

/// Points on the nominal contours and the surface's normals there; CAD frame.
struct NominalRows {
  std::vector<Eigen::Vector3d> points_mm, normals;
};

/// The rows as the field maps them, beside the truth. A row is in a gap where its true place lies in a
/// missing disc of the scan. cad_from_local undoes the scan's true pose.
[[nodiscard]] std::vector<StatedError> stated_errors(const Truth& truth, const DeformationField& field,
                                                     const synthetic::SyntheticScan& scan,
                                                     const RigidMotion& cad_from_local,
                                                     const NominalRows& nominal);

/// 95th percentile of the turns between the true and the carried surface normal, which is the tool's axis;
/// degrees, 0 without rows.
[[nodiscard]] double axis_p95_deg(const std::vector<StatedError>& rows);

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

/// Markdown: the heading of a table of coverage, and its lines for one set of scans, seen and (if any) in
/// gaps; a direction that nothing tells has dashes.
[[nodiscard]] std::string coverage_heading();
[[nodiscard]] std::string coverage_rows(const std::string& name, const CoverageTable& table);

}  // namespace arris::bench
