#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "registration/surface_system.hpp"

namespace arris {

/// A scan point that pulls an edge outward: its row of the system, its slope s and curvature c, and what
/// calling it a stray saves (below 0: costs).
struct EdgeClaim {
  std::size_t pair = 0;
  double arc_mm = 0.0;
  SurfaceSystem::Row row;
  double slope = 0.0, curvature = 0.0;
  double saved = 0.0;
};

/// What the points of the strips but for some claims (as indices) cost more at the fit moved by `move` than
/// their tangent parabolas say: a point that the edge comes to meet resists as soon as it is met.
using EdgeResistance =
    std::function<double(const Eigen::VectorXd& move, std::span<const std::size_t> without)>;

struct ClaimVerdict {
  std::vector<std::size_t> strays;  ///< pairs
  Eigen::MatrixXd doubt;            ///< covariance of the unknowns by claims that may be strays; mm^2
};

/// One stray beside a thin stretch of points, or two, can hold an edge far out, for nothing near contradicts
/// them, and the fit's own curvature calls them certain. With V = J H^-1 J' of some claims the rest of the
/// fit gains s'V(1 - C V)^-1 s / 2 when they are let go, and moves by H^-1 J'(1 - C V)^-1 s. Where that is
/// more than strays cost, they are strays; where it is nearly as much, the move is a doubt about the edge, by
/// its odds. Each claim alone, and each two within near_mm along a contour. Strays are called by the tangents
/// alone, and a doubt goes as far along its move as that pays against the others' resistance: the straight
/// move is not the way the edge would go, and judged by it a stray once held an edge 2.1 mm out.
///   inverse  H^-1 of the settled fit
///   cost     O(claims * unknowns * 75), and some resistances for each claim that is nearly let go
[[nodiscard]] ClaimVerdict judge_claims(const SurfaceSystem& system, const Eigen::MatrixXd& inverse,
                                        const std::vector<EdgeClaim>& claims, double near_mm,
                                        const EdgeResistance& resistance = {});

}  // namespace arris
