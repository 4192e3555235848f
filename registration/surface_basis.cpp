#include "registration/surface_basis.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "acquisition/types/frames.hpp"

namespace arris {
namespace {

constexpr double kRadiusSpacings = 2.4;
constexpr double kNextSpacings = 1.6;  // neighbours on the surface are at most so far apart
constexpr double kCosSameSheet = 0.2;
constexpr double kQuadraticRidge = 1e-6;  // of the moment matrix, on the second-order terms only
constexpr double kWorstPivotRatio = 1e-9;
constexpr std::size_t kFewestNodes = 6;
constexpr std::size_t kUsualNodes = 32;    // that a row has, at most, on an evenly covered surface
constexpr double kMostCellsASide = 100.0;  // contours may lie far apart; wider cells serve as well

SurfaceNodes in_order(const SurfaceNodes& nodes, const std::vector<std::size_t>& order) {
  SurfaceNodes ordered;
  for (const std::size_t i : order) {
    ordered.points_mm.push_back(nodes.points_mm[i]);
    ordered.normals.push_back(nodes.normals[i]);
    ordered.spacing_mm.push_back(nodes.spacing_mm[i]);
  }
  return ordered;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

/// Wendland's C2 function; 1 at 0, 0 from q = 1 on.
double wendland_c2(double q) {
  if (q >= 1.0) return 0.0;
  const double r = 1.0 - q;
  return r * r * r * r * (4.0 * q + 1.0);
}

}  // namespace

SurfaceBasis::SurfaceBasis(const SurfaceNodes& nodes)
    : nodes_(in_order(nodes, numbered_along(nodes.points_mm, scaled(nodes.spacing_mm, kNextSpacings)))),
      band_(
          std::make_shared<NodeBand>(band_of(nodes_.points_mm, scaled(nodes_.spacing_mm, kRadiusSpacings)))) {
  if (nodes_.points_mm.empty()) return;
  Eigen::Vector3d high_mm = low_mm_ = nodes_.points_mm.front();
  for (const Eigen::Vector3d& p : nodes_.points_mm) {
    low_mm_ = low_mm_.cwiseMin(p);
    high_mm = high_mm.cwiseMax(p);
  }
  const auto [least, most] = std::minmax_element(nodes_.spacing_mm.begin(), nodes_.spacing_mm.end());
  least_spacing_mm_ = *least;
  cell_mm_ = std::max(kRadiusSpacings * *most, (high_mm - low_mm_).maxCoeff() / kMostCellsASide);
  count_ = ((high_mm - low_mm_) / cell_mm_).array().floor().cast<int>() + 1;
  const auto place = [&](const Eigen::Vector3d& p) {
    const Eigen::Array3i at = ((p - low_mm_) / cell_mm_).array().floor().cast<int>();
    return cell_of(at.x(), at.y(), at.z());
  };
  start_.assign(static_cast<std::size_t>(count_.prod()) + 1, 0);
  for (const Eigen::Vector3d& p : nodes_.points_mm) ++start_[place(p) + 1];
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  order_.resize(nodes_.points_mm.size());
  for (std::size_t i = 0; i < order_.size(); ++i)
    order_[next[place(nodes_.points_mm[i])]++] = static_cast<std::int32_t>(i);
}

std::size_t SurfaceBasis::cell_of(int x, int y, int z) const {
  return static_cast<std::size_t>((z * count_.y() + y) * count_.x() + x);
}

BasisRow SurfaceBasis::row(const Eigen::Vector3d& p_cad_mm, const Eigen::Vector3d& normal) const {
  BasisRow row;
  row.normal = normal;
  const Eigen::Matrix3d frame = frame_with_z(normal);
  row.t1 = frame.col(0);
  row.t2 = frame.col(1);
  if (order_.empty()) return row;
  const Eigen::Array3i at = ((p_cad_mm - low_mm_) / cell_mm_).array().floor().cast<int>();
  const Eigen::Array3i low = (at - 1).max(0), high = (at + 1).min(count_ - 1);
  std::vector<std::pair<std::int32_t, double>> around;  // nodes of the same sheet, and how far they are
  around.reserve(2 * kUsualNodes);
  double spacing_mm = std::numeric_limits<double>::max(), widest_mm = 0.0;
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x)
        for (std::uint32_t k = start_[cell_of(x, y, z)]; k < start_[cell_of(x, y, z) + 1]; ++k) {
          const auto j = static_cast<std::size_t>(order_[k]);
          if (nodes_.normals[j].dot(normal) < kCosSameSheet) continue;
          const double apart_mm = (nodes_.points_mm[j] - p_cad_mm).norm();
          spacing_mm = std::min(spacing_mm, nodes_.spacing_mm[j] + NodeSpacing::kGrowth * apart_mm);
          widest_mm = std::max(widest_mm, nodes_.spacing_mm[j]);
          if (apart_mm < kRadiusSpacings * nodes_.spacing_mm[j]) around.emplace_back(order_[k], apart_mm);
        }
  spacing_mm = std::min(spacing_mm, widest_mm);
  const double unit_mm = kRadiusSpacings * spacing_mm;
  std::erase_if(around, [&](const auto& node) { return node.second >= unit_mm; });
  std::sort(around.begin(), around.end());
  row.spacing_mm = spacing_mm;
  std::vector<double> weights;
  weights.reserve(around.size());
  row.node.reserve(around.size());
  row.weight.reserve(around.size());
  for (const auto& [node, apart_mm] : around) {
    const auto j = static_cast<std::size_t>(node);
    const Eigen::Vector3d apart = nodes_.points_mm[j] - p_cad_mm;
    const double u = apart.dot(row.t1) / unit_mm, v = apart.dot(row.t2) / unit_mm;
    const double reach_mm = kRadiusSpacings * std::min(spacing_mm, nodes_.spacing_mm[j]);
    BasisRow::Weights p;
    p << 1.0, u, v, 0.5 * u * u, u * v, 0.5 * v * v;
    row.node.push_back(node);
    row.weight.push_back(p);
    weights.push_back(wendland_c2(apart_mm / reach_mm));
  }
  Eigen::Matrix<double, 6, 6> moment = Eigen::Matrix<double, 6, 6>::Zero();
  double total = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    moment.noalias() += weights[k] * row.weight[k] * row.weight[k].transpose();
    total += weights[k];
  }
  for (int i = BasisRow::kD11; i <= BasisRow::kD22; ++i) moment(i, i) += kQuadraticRidge * total;
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(moment);
  if (row.node.size() < kFewestNodes ||
      solver.vectorD().minCoeff() < kWorstPivotRatio * solver.vectorD().maxCoeff()) {
    row.node.clear();
    row.weight.clear();
    return row;
  }
  const double slope = 1.0 / unit_mm, bend = slope * slope;
  BasisRow::Weights units;
  units << 1.0, slope, slope, bend, bend, bend;
  Eigen::Matrix<double, 6, 6> inverse = solver.solve(Eigen::Matrix<double, 6, 6>::Identity());
  inverse = units.asDiagonal() * inverse;
  for (std::size_t k = 0; k < weights.size(); ++k)
    row.weight[k] = weights[k] * (inverse * row.weight[k]).eval();
  return row;
}

}  // namespace arris
