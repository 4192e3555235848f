#include "registration/common_height.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace arris {

CommonHeight::CommonHeight(const std::vector<SurfacePair>& pairs, double cell_mm, double gate_mm,
                           double most_spacing_mm) {
  std::vector<std::pair<std::array<int, 3>, const SurfacePair*>> in_cells;
  for (const SurfacePair& pair : pairs) {
    if (!pair.on_face || std::abs(pair.residual_mm) > gate_mm || pair.row.spacing_mm > most_spacing_mm)
      continue;
    const Eigen::Array3i cell = (pair.foot_mm / cell_mm).array().floor().cast<int>();
    in_cells.push_back({{cell.x(), cell.y(), cell.z()}, &pair});
  }
  std::stable_sort(in_cells.begin(), in_cells.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  double scatter = 0.0, freedom = 0.0;
  for (std::size_t begin = 0, end = 0; begin < in_cells.size(); begin = end) {
    Patch patch;
    patch.row = &in_cells[begin].second->row;
    double sum2 = 0.0;
    for (; end < in_cells.size() && in_cells[end].first == in_cells[begin].first; ++end) {
      const double height_mm = in_cells[end].second->residual_mm;
      patch.count += 1.0;
      patch.sum_mm += height_mm;
      sum2 += height_mm * height_mm;
    }
    scatter += sum2 - patch.sum_mm * patch.sum_mm / patch.count;
    freedom += patch.count - 1.0;
    patches_.push_back(patch);
  }
  if (freedom > 0.0)
    scatter_mm2_ = scatter / freedom;
  else
    patches_.clear();  // one pair a patch tells nothing
}

double CommonHeight::mean_mm2() const {
  double sum = 0.0, count = 0.0;
  for (const Patch& patch : patches_) {
    sum += patch.sum_mm * patch.sum_mm / patch.count - scatter_mm2_;
    count += patch.count;
  }
  return count > 0.0 ? std::max(0.0, sum / count) : 0.0;
}

std::vector<double> CommonHeight::excess_mm2(std::size_t nodes, double known_mm2) const {
  std::vector<double> sum(nodes, 0.0), count(nodes, 0.0), patches(nodes, 0.0);
  for (const Patch& patch : patches_)
    for (std::size_t k = 0; k < patch.row->node.size(); ++k) {
      const double weight = std::max(0.0, patch.row->weight[k][BasisRow::kValue]);
      const auto node = static_cast<std::size_t>(patch.row->node[k]);
      sum[node] += weight * (patch.sum_mm * patch.sum_mm / patch.count - scatter_mm2_);
      count[node] += weight * patch.count;
      patches[node] += weight * weight;
    }
  std::vector<double> excess(nodes, 0.0);
  for (std::size_t j = 0; j < nodes; ++j) {
    if (count[j] <= 0.0) continue;
    const double chance = scatter_mm2_ * std::sqrt(2.0 * patches[j]);  // one standard deviation of the sum
    excess[j] = std::max(0.0, (sum[j] - chance) / count[j] - known_mm2);
  }
  return excess;
}

double shape_left_mm(const std::vector<SurfacePair>& pairs, double cell_mm, double gate_mm,
                     double most_spacing_mm) {
  const double wide_mm2 = CommonHeight(pairs, cell_mm, gate_mm, most_spacing_mm).mean_mm2(),
               narrow_mm2 = CommonHeight(pairs, 0.5 * cell_mm, gate_mm, most_spacing_mm).mean_mm2();
  return std::sqrt(std::max(0.0, (4.0 * wide_mm2 - narrow_mm2) / 3.0));
}

}  // namespace arris
