#include "registration/edge_strips.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/parallel_for.hpp"
#include "registration/edge_support.hpp"

namespace arris {
namespace {

constexpr double kStationMm = 2.0;
constexpr double kPointsPerBin = 8.0;
constexpr double kLeastExpectedRatio = 0.5;           // of the scan's median density, beside the edge
constexpr double kEmptyRatio = 0.2, kRimRatio = 0.6;  // of the usual count: not seen; beside a gap
constexpr double kTauFloorMm = 0.03;
constexpr std::size_t kChunk = 256;

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

EdgeStrips::EdgeStrips(std::vector<const Curve*> edges, const SurfaceBasis& basis, double strip_mm,
                       double spacing_mm)
    : strip_mm_(strip_mm), spacing_mm_(spacing_mm) {
  for (const Curve* curve : edges) {
    Edge edge;
    edge.curve = curve;
    edge.stations = contour_stations(*curve, basis, kStationMm);
    edges_.push_back(std::move(edge));
  }
}

std::size_t EdgeStrips::bin_of(const Edge& edge, double arc_mm) const {
  return std::min(edge.seen.size() - 1, static_cast<std::size_t>(std::max(0.0, arc_mm / edge.bin_mm)));
}

void EdgeStrips::update(const std::vector<SurfacePair>& pairs, const std::vector<Eigen::Vector3d>& shift_mm,
                        double reach_mm, double gate_mm, int threads) {
  std::vector<std::optional<CarriedContour>> carried(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    Edge& edge = edges_[e];
    if (edge.stations.size() < 2) continue;  // outside the field's nodes: no evidence
    carried[e].emplace(edge.stations, edge.curve->closed(), shift_mm);
    edge.inward.clear();
    for (std::size_t k = 0; k < edge.stations.size(); ++k) edge.inward.push_back(carried[e]->inward(k));
  }
  points_.assign(pairs.size(), {});
  parallel_for(pairs.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Point& point = points_[i];
      point.foot.distance_mm = reach_mm;
      for (std::size_t e = 0; e < carried.size(); ++e) {
        if (!carried[e]) continue;
        const CarriedContour::Foot foot = carried[e]->foot(pairs[i].p_mm);
        if (foot.distance_mm >= point.foot.distance_mm) continue;
        const double height_mm = pairs[i].on_face ? pairs[i].residual_mm : foot.height_mm;
        const double fan = 1.0 + edges_[e].stations[foot.station].fan_per_mm * std::max(0.0, foot.across_mm);
        const bool beside = foot.across_mm < strip_mm_ && std::abs(height_mm) < gate_mm;
        point = {e, foot, beside ? 1.0 / std::clamp(fan, 0.3, 3.0) : 0.0};
      }
    }
  });
  for (std::size_t e = 0; e < edges_.size(); ++e) find_seen(e);
}

void EdgeStrips::find_seen(std::size_t e) {
  Edge& edge = edges_[e];
  const double length_mm = edge.curve->length_mm();
  const double expected_per_mm = kLeastExpectedRatio * strip_mm_ / (spacing_mm_ * spacing_mm_);
  double count = 0.0;
  for (const Point& p : points_)
    if (p.edge == e) count += p.weight;
  edge.bin_mm =
      std::clamp(kPointsPerBin / std::max(expected_per_mm, count / length_mm), 2.0, length_mm / 8.0);
  const std::size_t bins = static_cast<std::size_t>(length_mm / edge.bin_mm);
  edge.bin_mm = length_mm / static_cast<double>(bins);
  edge.seen.assign(bins, 1);
  std::vector<double> near(bins, 0.0), all(bins, 0.0);
  for (const Point& p : points_) {
    if (p.edge != e || p.weight <= 0.0) continue;
    all[bin_of(edge, p.foot.arc_mm)] += p.weight;
    if (p.foot.across_mm < 0.5 * strip_mm_) near[bin_of(edge, p.foot.arc_mm)] += p.weight;
  }
  const double expected = expected_per_mm * edge.bin_mm;
  const double usual = std::max(median_of(all), expected);
  const double usual_near = std::max(median_of(near), 0.5 * expected);
  for (std::size_t k = 0; k < bins; ++k)
    if (near[k] < kEmptyRatio * usual_near || all[k] < kEmptyRatio * usual) edge.seen[k] = 0;
  const std::vector<char> sure = edge.seen;
  for (std::size_t k = 0; k < bins; ++k)  // the rim of a gap cuts its neighbours too
    if ((!sure[(k + 1) % bins] || !sure[(k + bins - 1) % bins]) && near[k] < kRimRatio * usual_near)
      edge.seen[k] = 0;
  edge.density_per_mm2 = usual / (edge.bin_mm * strip_mm_);
}

void EdgeStrips::add(std::size_t begin, std::size_t end, const std::vector<double>& offset_mm, double tau_mm,
                     double stray_ratio, SurfaceSystem& system) const {
  const EdgeSupport support{tau_mm, strip_mm_, stray_ratio};
  SurfaceSystem::Row row;
  for (std::size_t i = begin; i < end; ++i) {
    const Point& p = points_[i];
    if (p.weight <= 0.0) continue;
    const Edge& edge = edges_[p.edge];
    if (!edge.seen[bin_of(edge, p.foot.arc_mm)]) continue;
    const EdgeSupport::Pull pull = support.at(p.foot.across_mm - offset_mm[p.edge]);
    if (pull.slope_per_mm == 0.0 && pull.curvature_per_mm2 == 0.0) continue;
    const BasisRow& basis = edge.stations[p.foot.station].row;
    row.node = &basis.node;
    row.offset = static_cast<int>(p.edge);
    row.offset_derivative = -1.0;
    row.direction.clear();
    for (const BasisRow::Weights& w : basis.weight)
      row.direction.push_back(-w[BasisRow::kValue] * edge.inward[p.foot.station]);
    system.add(row, p.weight * pull.slope_per_mm, p.weight * pull.curvature_per_mm2);
  }
}

double EdgeStrips::finest_tau_mm(double share_ratio) const {
  double tau_mm = kTauFloorMm;
  for (const Edge& edge : edges_)
    tau_mm =
        std::max(tau_mm, 1.0 / std::max(1e-9, edge.density_per_mm2 * share_ratio * edge.curve->length_mm()));
  return tau_mm;
}

double EdgeStrips::greatest_density_per_mm2() const {
  double density_per_mm2 = 1e-9;
  for (const Edge& edge : edges_) density_per_mm2 = std::max(density_per_mm2, edge.density_per_mm2);
  return density_per_mm2;
}

}  // namespace arris
