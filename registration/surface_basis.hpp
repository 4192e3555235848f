#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "registration/node_band.hpp"
#include "registration/surface_nodes.hpp"

namespace arris {

/// How the nodes' values make a smooth function near one place x of the surface, in the orthonormal tangent
/// frame (t1, t2) at x: f = sum value f_j, its slopes and second derivatives there. All linear in the nodes.
struct BasisRow {
  static constexpr int kValue = 0, kD1 = 1, kD2 = 2, kD11 = 3, kD12 = 4, kD22 = 5;
  using Weights = Eigen::Matrix<double, 6, 1>;
  Eigen::Vector3d t1 = Eigen::Vector3d::UnitX(), t2 = Eigen::Vector3d::UnitY();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double spacing_mm = 0.0;         ///< of the nodes about x
  std::vector<std::int32_t> node;  ///< ascending
  std::vector<Weights> weight;     ///< one a node; 1/mm and 1/mm^2 for slopes and second derivatives

  [[nodiscard]] bool usable() const { return !node.empty(); }
  /// The node of most weight.
  [[nodiscard]] std::size_t nearest() const {
    const auto heaviest =
        std::max_element(weight.begin(), weight.end(),
                         [](const Weights& a, const Weights& b) { return a[kValue] < b[kValue]; });
    return static_cast<std::size_t>(node[static_cast<std::size_t>(heaviest - weight.begin())]);
  }
  /// sum over the nodes of weight[which] * value.
  [[nodiscard]] Eigen::Vector3d combine(int which, const std::vector<Eigen::Vector3d>& values) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < node.size(); ++k)
      sum += weight[k][which] * values[static_cast<std::size_t>(node[k])];
    return sum;
  }
};

/// Smooth functions over the surface from values at scattered nodes: moving least squares with quadratic
/// polynomials in the tangent plane (Lancaster and Salkauskas, Math. Comp. 37, 1981) and Wendland's C2
/// weight. Its radius is 2.4 spacings, the node's or that of the place, whichever is less: so wide nodes do
/// not smooth what close ones follow, and two nodes share a row only within the sum of their radii. The
/// weights sum to one and reproduce linear and quadratic functions; slopes and second derivatives are the
/// local polynomial's
/// ("diffuse" derivatives: same order of accuracy). Nodes whose normal turns by more than about 80 degrees
/// lie on another sheet and take no part.
class SurfaceBasis {
 public:
  /// The nodes are numbered anew, along the part.
  explicit SurfaceBasis(const SurfaceNodes& nodes);
  [[nodiscard]] std::size_t size() const { return nodes_.points_mm.size(); }
  /// The least there is: beside the contours.
  [[nodiscard]] double spacing_mm() const { return least_spacing_mm_; }
  [[nodiscard]] const SurfaceNodes& nodes() const { return nodes_; }
  /// Nodes that share rows.
  [[nodiscard]] const std::shared_ptr<const NodeBand>& band() const { return band_; }
  /// Row at a place of the surface with the given smooth normal; not usable() where fewer than six nodes are
  /// near or they do not determine a plane. Cost: some 25 nodes, one 6x6 solve; thread-safe.
  [[nodiscard]] BasisRow row(const Eigen::Vector3d& p_cad_mm, const Eigen::Vector3d& normal) const;

 private:
  [[nodiscard]] std::size_t cell_of(int x, int y, int z) const;

  SurfaceNodes nodes_;
  std::shared_ptr<const NodeBand> band_;
  double least_spacing_mm_ = 0.0;
  double cell_mm_ = 1.0;  // of the grid that finds nodes
  Eigen::Vector3d low_mm_ = Eigen::Vector3d::Zero();
  Eigen::Array3i count_ = Eigen::Array3i::Ones();
  std::vector<std::uint32_t> start_;  // of each grid cell into order_
  std::vector<std::int32_t> order_;
};

}  // namespace arris
