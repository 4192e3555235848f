#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace arris {

/// What a wall of the cut adds level with the material: points that scatter about the edge, as many as the
/// material has in width_mm of its strip.
struct WallPoints {
  double width_mm = 0.0;  ///< 0: no wall
  double sd_mm = 1.0;
  /// Over the material's density, so far inside.
  [[nodiscard]] double ratio(double inside_mm) const {
    if (width_mm <= 0.0) return 0.0;
    const double z = inside_mm / sd_mm;
    return width_mm / (std::sqrt(2.0 * std::numbers::pi) * sd_mm) * std::exp(-0.5 * z * z);
  }
};

/// One-sided support of an edge: scan points lie on its material side, with a density that is uniform near
/// it. A point at distance g inside the edge costs -log sigmoid(g / tau - 0.541), and each point of a strip
/// of width w pulls the edge inward by 1 / w, its share of the density: with log(1 + exp(0.541)) = 1 the two
/// balance without bias for a uniform density at any tau. Points far outside are strays, and let go.
struct EdgeSupport {
  static constexpr double kBalance = 0.541;
  double tau_mm = 1.0;
  double strip_mm = 10.0;
  double stray_ratio = 0.0;  ///< of the density: points beyond the edge that are no edge at all

  /// Derivative of the point's cost by g, and a curvature that never overshoots (bound tanh(x/2) / (2x) for
  /// points outside, where the true one falls towards zero).
  struct Pull {
    double slope_per_mm = 0.0, curvature_per_mm2 = 0.0;
  };
  /// The cost without its constant pull; that of a stray is -log(stray_ratio).
  [[nodiscard]] double cost(double inside_mm, const WallPoints& wall) const {
    return -std::log(sigmoid(inside_mm / tau_mm - kBalance) + stray_ratio + seen(wall).ratio(inside_mm));
  }
  /// With the pull that its strip's density asks for, up to a constant.
  [[nodiscard]] double whole_cost(double inside_mm, const WallPoints& wall) const {
    return cost(inside_mm, wall) + std::clamp(inside_mm, 0.0, strip_mm) / strip_mm;
  }
  /// A point's share of its strip's density, which pulls the edge inward.
  [[nodiscard]] double density_pull_per_mm(double inside_mm) const {
    return inside_mm > 0.0 && inside_mm <= strip_mm ? 1.0 / strip_mm : 0.0;
  }
  static double sigmoid(double x) {
    return x >= 0.0 ? 1.0 / (1.0 + std::exp(-x)) : std::exp(x) / (1.0 + std::exp(x));
  }
  [[nodiscard]] Pull at(double inside_mm, const WallPoints& wall = {}) const {
    Pull pull;
    if (inside_mm > strip_mm) return pull;
    const double x = inside_mm / tau_mm - kBalance;
    const double inside = sigmoid(x);
    const WallPoints about = seen(wall);
    const double on_wall = about.ratio(inside_mm), all = inside + stray_ratio + on_wall;
    const double trusted = inside / all, wall_share = on_wall / all;
    const double wall_per_mm2 = wall_share / (about.sd_mm * about.sd_mm);
    pull.slope_per_mm =
        -trusted * (1.0 - inside) / tau_mm + wall_per_mm2 * inside_mm + density_pull_per_mm(inside_mm);
    const double bend = x < -1e-6 ? std::tanh(0.5 * x) / (2.0 * x) : inside * (1.0 - inside);
    pull.curvature_per_mm2 = trusted * bend / (tau_mm * tau_mm) + wall_per_mm2;
    return pull;
  }

 private:
  /// As sharp as the edge is looked at.
  [[nodiscard]] WallPoints seen(const WallPoints& wall) const {
    return {wall.width_mm, std::hypot(wall.sd_mm, tau_mm)};
  }
};

/// Weight of a point across_mm inside a bent edge: the strip's area per length of the edge grows where the
/// material fans out (Curve's fan_per_mm), and so would the number of its points.
[[nodiscard]] inline double fan_weight(double fan_per_mm, double across_mm) {
  return 1.0 / std::clamp(1.0 + fan_per_mm * std::max(0.0, across_mm), 0.3, 3.0);
}

}  // namespace arris
