#include "registration/edge_strips.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/parallel_for.hpp"
#include "registration/edge_support.hpp"

namespace arris {
namespace {

constexpr double kStationMm = 2.0;
constexpr double kTauFloorMm = 0.03;
constexpr double kClaimTaus = 3.0;  // farther inside a point pulls nothing, farther outside it is let go
constexpr std::size_t kChunk = 256;

}  // namespace

EdgeStrips::EdgeStrips(const std::vector<const Curve*>& edges, const SurfaceBasis& basis, double strip_mm,
                       double spacing_mm)
    : strip_mm_(strip_mm), spacing_mm_(spacing_mm) {
  for (const Curve* curve : edges) {
    Edge edge;
    edge.curve = curve;
    edge.stations = contour_stations(*curve, basis, kStationMm);
    edges_.push_back(std::move(edge));
  }
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
  stray_.resize(pairs.size(), 0);
  parallel_for(pairs.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Point& point = points_[i];
      point.foot.distance_mm = reach_mm;
      for (std::size_t e = 0; e < carried.size(); ++e) {
        if (!carried[e]) continue;
        const CarriedContour::Foot foot = carried[e]->foot(pairs[i].p_mm);
        if (foot.distance_mm >= point.foot.distance_mm) continue;
        const double height_mm = pairs[i].on_face ? pairs[i].residual_mm : foot.height_mm;
        const bool beside = foot.across_mm < strip_mm_ && std::abs(height_mm) < gate_mm;
        point = {e, foot,
                 beside ? fan_weight(edges_[e].stations[foot.station].fan_per_mm, foot.across_mm) : 0.0};
      }
    }
  });
  for (std::size_t e = 0; e < edges_.size(); ++e) find_seen(e);
}

void EdgeStrips::find_seen(std::size_t e) {
  std::vector<BesidePoint> beside;
  double inliers = 0.0;
  for (const Point& p : points_) {
    if (p.edge != e || p.weight <= 0.0) continue;
    beside.push_back({p.foot.arc_mm, p.foot.across_mm, p.weight});
    inliers += p.weight;
  }
  edges_[e].bins = find_seen_bins(beside, inliers,
                                  {edges_[e].curve->length_mm(), strip_mm_, 0.5 * strip_mm_, spacing_mm_});
}

void EdgeStrips::set_row(const Point& point, SurfaceSystem::Row& row) const {
  const Edge& edge = edges_[point.edge];
  const BasisRow& basis = edge.stations[point.foot.station].row;
  row.node = &basis.node;
  row.offset = static_cast<int>(point.edge);
  row.offset_derivative = -1.0;
  row.direction.clear();
  for (const BasisRow::Weights& w : basis.weight)
    row.direction.push_back(-w[BasisRow::kValue] * edge.inward[point.foot.station]);
}

bool EdgeStrips::counts(std::size_t i) const {
  const Point& p = points_[i];
  return p.weight > 0.0 && edges_[p.edge].bins.seen[edges_[p.edge].bins.bin_of(p.foot.arc_mm)];
}

void EdgeStrips::add(std::size_t begin, std::size_t end, const std::vector<double>& offset_mm, double tau_mm,
                     double stray_ratio, SurfaceSystem& system) const {
  const EdgeSupport support{tau_mm, strip_mm_, stray_ratio};
  SurfaceSystem::Row row;
  for (std::size_t i = begin; i < end; ++i) {
    const Point& p = points_[i];
    if (!counts(i)) continue;
    const double inside_mm = p.foot.across_mm - offset_mm[p.edge];
    if (stray_[i]) continue;
    const EdgeSupport::Pull pull = support.at(inside_mm);
    if (pull.slope_per_mm == 0.0 && pull.curvature_per_mm2 == 0.0) continue;
    set_row(p, row);
    system.add(row, p.weight * pull.slope_per_mm, p.weight * pull.curvature_per_mm2);
  }
}

std::vector<EdgeClaim> EdgeStrips::claims(const std::vector<double>& offset_mm, double tau_mm,
                                          double stray_ratio) const {
  const EdgeSupport support{tau_mm, strip_mm_, stray_ratio};
  std::vector<EdgeClaim> found;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    if (!counts(i) || stray_[i]) continue;
    const double inside_mm = p.foot.across_mm - offset_mm[p.edge];
    const EdgeSupport::Pull pull = support.at(inside_mm);
    if (std::abs(inside_mm) > kClaimTaus * tau_mm || pull.slope_per_mm >= 0.0) continue;
    EdgeClaim claim;
    claim.pair = i;
    claim.arc_mm = p.foot.arc_mm;
    claim.slope = p.weight * pull.slope_per_mm;
    claim.curvature = p.weight * pull.curvature_per_mm2;
    claim.saved = p.weight * (support.cost(inside_mm) + std::log(stray_ratio));
    set_row(p, claim.row);
    found.push_back(std::move(claim));
  }
  return found;
}

double EdgeStrips::finest_tau_mm(double share_ratio) const {
  double tau_mm = kTauFloorMm;
  for (const Edge& edge : edges_)
    tau_mm = std::max(
        tau_mm, 1.0 / std::max(1e-9, edge.bins.density_per_mm2 * share_ratio * edge.curve->length_mm()));
  return tau_mm;
}

double EdgeStrips::greatest_density_per_mm2() const {
  double density_per_mm2 = 1e-9;
  for (const Edge& edge : edges_) density_per_mm2 = std::max(density_per_mm2, edge.bins.density_per_mm2);
  return density_per_mm2;
}

}  // namespace arris
