#include "tests/support/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace arris::bench {
namespace {

constexpr double kBoundSigmas = 1.96;

bool in_gap(const synthetic::SyntheticScan& scan, const Eigen::Vector3d& p_cad_mm) {
  const Eigen::Vector3d p_mm = scan.scan_from_cad * p_cad_mm;
  return std::any_of(scan.missing.begin(), scan.missing.end(), [&](const synthetic::MissingDisc& disc) {
    return (p_mm - disc.centre_mm).norm() < disc.radius_mm;
  });
}

std::string coverage_cells(const Coverage& coverage) {
  if (coverage.count() == 0) return " - | - |";
  return fmt::format(" {:.1f} % | {:.1f} |", 100.0 * coverage.inside_ratio(), coverage.bound_ratio());
}

}  // namespace

std::vector<StatedError> stated_errors(const Truth& truth, const DeformationField& field,
                                       const synthetic::SyntheticScan& scan,
                                       const RigidMotion& cad_from_local, const NominalRows& nominal) {
  std::vector<StatedError> stated;
  std::vector<Eigen::Vector3d> carried_mm, normals;
  for (std::size_t i = 0; i < nominal.points_mm.size(); ++i) {
    const MappedPoint mapped = field.map(nominal.points_mm[i]);
    carried_mm.push_back(cad_from_local * mapped.p_scan_mm);
    normals.push_back(cad_from_local.linear() * mapped.rotation_scan_from_cad * nominal.normals[i]);
    StatedError row;
    row.sd = {mapped.sd_mm.x(), mapped.sd_mm.y(), mapped.sd_mm.z(), mapped.sd_axis_rad};
    stated.push_back(row);
  }
  const std::vector<RowError> rows = truth.rows(carried_mm, true);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double along_mm = truth.is_circle() ? std::numeric_limits<double>::quiet_NaN()
                                              : truth.slid_mm(nominal.points_mm[i], rows[i]);
    const double tilt_rad = std::atan2(normals[i].dot(rows[i].into_void), normals[i].dot(rows[i].normal));
    stated[i].error = {rows[i].normal_mm, rows[i].across_mm, along_mm, tilt_rad};
    stated[i].in_gap = in_gap(scan, rows[i].foot_mm);
    stated[i].turn_rad = std::acos(std::clamp(normals[i].dot(rows[i].normal), -1.0, 1.0));
  }
  return stated;
}

double axis_p95_deg(const std::vector<StatedError>& rows) {
  if (rows.empty()) return 0.0;
  std::vector<double> turns_rad;
  for (const StatedError& row : rows) turns_rad.push_back(row.turn_rad);
  const auto p95 = turns_rad.begin() + static_cast<std::ptrdiff_t>(turns_rad.size() * 95 / 100);
  std::nth_element(turns_rad.begin(), p95, turns_rad.end());
  return *p95 * 180.0 / std::numbers::pi;
}

void Coverage::add(double error, double sd) {
  if (std::isnan(error) || std::isnan(sd)) return;
  errors_.push_back(static_cast<float>(std::abs(error)));
  bounds_.push_back(static_cast<float>(kBoundSigmas * sd));
}

Coverage& Coverage::operator+=(const Coverage& other) {
  errors_.insert(errors_.end(), other.errors_.begin(), other.errors_.end());
  bounds_.insert(bounds_.end(), other.bounds_.begin(), other.bounds_.end());
  return *this;
}

double Coverage::inside_ratio() const {
  std::size_t inside = 0;
  for (std::size_t i = 0; i < errors_.size(); ++i) inside += errors_[i] <= bounds_[i] ? 1U : 0U;
  return static_cast<double>(inside) / static_cast<double>(errors_.size());
}

double Coverage::rms() const {
  double sum2 = 0.0;
  for (const float error : errors_) sum2 += static_cast<double>(error) * error;
  return std::sqrt(sum2 / static_cast<double>(errors_.size()));
}

double Coverage::bound_ratio() const {
  std::vector<float> bounds = bounds_;
  const auto middle = bounds.begin() + static_cast<std::ptrdiff_t>(bounds.size() / 2);
  std::nth_element(bounds.begin(), middle, bounds.end());
  return bounds.empty() ? 0.0 : *middle / rms();
}

void CoverageTable::add(const std::vector<StatedError>& rows) {
  for (const StatedError& row : rows)
    for (std::size_t d = 0; d < StatedError::kDirections; ++d)
      cells[d][row.in_gap ? 1 : 0].add(row.error[d], row.sd[d]);
}

std::string coverage_heading() {
  return "| scans | | normal | bound / rms | across | bound / rms | along | bound / rms | axis | bound / rms "
         "|\n"
         "|---|---|---|---|---|---|---|---|---|---|\n";
}

std::string coverage_rows(const std::string& name, const CoverageTable& table) {
  std::string text;
  for (const bool gap : {false, true}) {
    if (table.at(StatedError::kNormal, gap).count() == 0) continue;
    text += fmt::format("| {} | {} |", name, gap ? "in gaps" : "seen");
    for (std::size_t d = 0; d < StatedError::kDirections; ++d)
      text += coverage_cells(table.at(static_cast<StatedError::Direction>(d), gap));
    text += "\n";
  }
  return text;
}

}  // namespace arris::bench
