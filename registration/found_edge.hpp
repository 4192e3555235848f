#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "registration/edge_fit.hpp"
#include "registration/edge_pairs.hpp"
#include "registration/subdivision_field.hpp"

namespace arris {

/// Steps of arc length for sums along a contour.
constexpr double kContourStepMm = 2.0;

template <class Body>
void along(const Curve& curve, const Body& body) {
  const int count = std::max(8, static_cast<int>(curve.length_mm() / kContourStepMm));
  for (int i = 0; i < count; ++i) body(curve.length_mm() * i / count);
}

/// The found edge of each contour relative to the nominal carried by its motion.
[[nodiscard]] std::vector<ContourResult> with_edges(const CadModel& cad, const ScanModel& scan,
                                                    std::vector<ContourMotion> motions,
                                                    const EdgeFitOptions& options);

/// The found edge, sampled where it was seen.
[[nodiscard]] EdgeData sharpened(const CadModel& cad, const ScanModel& scan,
                                 const std::vector<ContourResult>& contours);

/// The place in the scan of point p_cad_mm, at arc length s of contour c.
using CarryPoint =
    std::function<Eigen::Vector3d(std::size_t c, double arc_mm, const Eigen::Vector3d& p_cad_mm)>;

/// Rms distance from the found edge to the nominal carried by `carry`, over the seen part of all contours;
/// mm.
[[nodiscard]] double edge_rms_mm(const CadModel& cad, const std::vector<ContourResult>& contours,
                                 const CarryPoint& carry);

/// Share of the contours' length on which the edge was seen.
[[nodiscard]] double seen_ratio(const std::vector<ContourResult>& contours);

}  // namespace arris
