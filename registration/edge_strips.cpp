#include "registration/edge_strips.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/geometry/parallel_for.hpp"
#include "registration/edge_support.hpp"

namespace arris {
namespace {

constexpr double kStationMm = 2.0;
constexpr double kTauFloorMm = 0.03;
constexpr double kClaimTaus = 3.0;  // farther inside a point pulls nothing, farther outside it is let go
constexpr double kSitePoints = 45.0, kSiteBlurs = 5.0;  // farther inside a point bounds nothing
// So many points within a mm of an edge: its mode is taken for its mean, an eighth more error across
// (docs/trust.md).
constexpr double kDensePerMm = 300.0;
constexpr double kStrayHeightMm = 2.0;                  // flyers of an edge stand above and below it
constexpr double kUnseenStrays = 0.5;                   // none seen is no proof that there are none
constexpr double kMostStrayRatio = 0.05;                // early rounds leave material beyond the edge
constexpr double kBurrTaus = 4.0, kBurrSpacings = 0.3;  // nearer to the edge a point may well be of it
constexpr double kMostBurrRatio = 0.7;  // of an edge: with more taken for burrs, the rest does not hold it
constexpr double kHighestBurrMm = 4.0, kBurrGates = 1.5;
constexpr double kWallDepthMm = 2.0, kWallPerMm = 0.02,
                 kMostAbove = 2.0;      // strays are above as often as below
constexpr double kWallGateRatio = 0.5;  // a wall's points scatter across the edge: few of them lie so level
constexpr double kLeastWallMm = 0.5;    // of depth, that a wall's density is taken from
constexpr std::size_t kChunk = 256;

}  // namespace

EdgeStrips::EdgeStrips(const std::vector<const Curve*>& edges, const SurfaceBasis& basis, double strip_mm,
                       double spacing_mm, double out_mm)
    : strip_mm_(strip_mm), spacing_mm_(spacing_mm), out_mm_(out_mm) {
  for (const Curve* curve : edges) {
    Edge edge;
    edge.curve = curve;
    edge.stations = contour_stations(*curve, basis, kStationMm);
    edges_.push_back(std::move(edge));
  }
}

void EdgeStrips::update(const std::vector<SurfacePair>& pairs, const std::vector<Eigen::Vector3d>& shift_mm,
                        const std::vector<double>& offset_mm, double reach_mm, double gate_mm,
                        bool walls_count, int threads) {
  reach_mm_ = reach_mm;
  gate_mm_ = gate_mm;
  place_points(pairs, carry_edges(shift_mm), threads);
  weigh_points(offset_mm, walls_count);
}

std::vector<std::optional<CarriedContour>> EdgeStrips::carry_edges(
    const std::vector<Eigen::Vector3d>& shift_mm) {
  std::vector<std::optional<CarriedContour>> carried(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    Edge& edge = edges_[e];
    if (edge.stations.size() < 2) continue;  // outside the field's nodes: no evidence
    carried[e].emplace(edge.stations, edge.curve->closed(), shift_mm);
    edge.inward.clear();
    for (std::size_t k = 0; k < edge.stations.size(); ++k) edge.inward.push_back(carried[e]->inward(k));
  }
  return carried;
}

void EdgeStrips::place_points(const std::vector<SurfacePair>& pairs,
                              const std::vector<std::optional<CarriedContour>>& carried, int threads) {
  points_.assign(pairs.size(), {});
  stray_.resize(pairs.size(), 0);
  messages_.resize(pairs.size());
  parallel_for(pairs.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Point& point = points_[i];
      point.foot.distance_mm = reach_mm_;
      for (std::size_t e = 0; e < carried.size(); ++e) {
        if (!carried[e]) continue;
        const std::optional<CarriedContour::Foot> foot =
            carried[e]->foot_within(pairs[i].p_mm, point.foot.distance_mm);
        if (!foot) continue;
        point = {e, *foot, 0.0, pairs[i].on_face ? pairs[i].residual_mm : foot->height_mm, {}};
      }
    }
  });
}

void EdgeStrips::weigh_points(const std::vector<double>& offset_mm, bool walls_count) {
  const std::vector<double> wall_per_mm2 =
      walls_count ? wall_density_per_mm2(offset_mm) : std::vector<double>(edges_.size(), 0.0);
  for (Point& p : points_)
    if (p.foot.distance_mm < reach_mm_ && p.foot.across_mm < strip_mm_ &&
        std::abs(p.height_mm) < (wall_per_mm2[p.edge] > 0.0 ? kWallGateRatio : 1.0) * gate_mm_)
      p.weight = fan_weight(edges_[p.edge].stations[p.foot.station].fan_per_mm, p.foot.across_mm);
  for (std::size_t e = 0; e < edges_.size(); ++e) find_seen(e);
  for (Point& p : points_)
    if (p.weight > 0.0 && wall_per_mm2[p.edge] > 0.0)
      p.wall = wall_points(p.height_mm, wall_per_mm2[p.edge], edges_[p.edge].bins.density_per_mm2);
}

std::vector<double> EdgeStrips::wall_density_per_mm2(const std::vector<double>& offset_mm) const {
  std::vector<double> below(edges_.size(), 0.0), above = below;
  for (const Point& p : points_) {
    if (p.foot.distance_mm > kWallDepthMm || std::abs(inside_mm(p, offset_mm)) > gate_mm_) continue;
    if (p.foot.height_mm < -gate_mm_) below[p.edge] += 1.0;
    if (p.foot.height_mm > gate_mm_) above[p.edge] += 1.0;
  }
  std::vector<double> per_mm2(edges_.size(), 0.0);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const double length_mm = edges_[e].curve->length_mm();
    if (below[e] - kMostAbove * above[e] > kWallPerMm * length_mm)
      per_mm2[e] = (below[e] - above[e]) / (length_mm * std::max(kLeastWallMm, kWallDepthMm - gate_mm_));
  }
  return per_mm2;
}

/// The wall's points have any height up to the edge's, those of the material that of their noise.
WallPoints EdgeStrips::wall_points(double height_mm, double wall_per_mm2, double material_per_mm2) const {
  const double sigma_mm = gate_mm_ / kGateSigmas, z = height_mm / sigma_mm;
  const double on_wall_per_mm = 0.5 * wall_per_mm2 * std::erfc(z / std::numbers::sqrt2);
  const double on_face_per_mm =
      material_per_mm2 * std::exp(-0.5 * z * z) / (std::sqrt(2.0 * std::numbers::pi) * sigma_mm);
  return {on_wall_per_mm / std::max(1e-9, on_face_per_mm), std::hypot(sigma_mm, kEdgeBlurMm)};
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

double EdgeStrips::points_per_mm(const Edge& edge) {
  return std::max(1e-9, edge.bins.density_per_mm2 * edge.curve->length_mm());
}

/// An edge that so many more points show is known that much better.
std::vector<EdgeSupport> EdgeStrips::supports_at(double tau_mm, double stray_ratio) const {
  if (edges_.empty()) return {};
  std::vector<double> points_per_mm;
  for (const Edge& edge : edges_) points_per_mm.push_back(this->points_per_mm(edge));
  const double fewest = *std::min_element(points_per_mm.begin(), points_per_mm.end());
  std::vector<EdgeSupport> supports;
  for (const double points : points_per_mm)
    supports.push_back({std::max(kTauFloorMm, tau_mm * fewest / points), strip_mm_, stray_ratio});
  return supports;
}

bool EdgeStrips::counts(std::size_t i) const {
  const Point& p = points_[i];
  const Edge& edge = edges_[p.edge];
  return p.weight > 0.0 && edge.bins.seen_at(p.foot.arc_mm) && !edge.burrs.at(p.foot.arc_mm);
}

bool EdgeStrips::call_burrs(const std::vector<double>& offset_mm, double tau_mm) {
  const double margin_mm = std::max(kBurrTaus * tau_mm, kBurrSpacings * spacing_mm_);
  std::vector<std::vector<double>> standing_out_mm(edges_.size());
  for (const Point& p : points_) {
    if (p.foot.distance_mm > kHighestBurrMm) continue;
    const double inside = inside_mm(p, offset_mm);
    const bool beyond = inside < -margin_mm;
    const bool above = inside < margin_mm && p.foot.height_mm > kBurrGates * gate_mm_;
    if (beyond || above) standing_out_mm[p.edge].push_back(p.foot.arc_mm);
  }
  bool changed = false;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    Edge& edge = edges_[e];
    BurrBins found = find_burr_bins(standing_out_mm[e], edge.curve->length_mm(), edge.bins.density_per_mm2);
    const bool any = found.length_mm() > 0.0 || edge.burrs.length_mm() > 0.0;
    changed = changed || (any && found.burr != edge.burrs.burr);
    edge.burrs = std::move(found);
  }
  return changed;
}

bool EdgeStrips::widen_burrs(double by_mm) {
  bool any = false;
  for (Edge& edge : edges_) {
    BurrBins wide = edge.burrs;
    wide.widen(by_mm);
    if (wide.length_mm() == 0.0 || wide.length_mm() > kMostBurrRatio * edge.curve->length_mm()) continue;
    edge.burrs = std::move(wide);
    any = true;
  }
  return any;
}

/// Of the edge as the scanner shows it.
double EdgeStrips::inside_mm(const Point& point, const std::vector<double>& offset_mm) const {
  return point.foot.across_mm - offset_mm[point.edge] + out_mm_;
}

void EdgeStrips::add(std::size_t begin, std::size_t end, const std::vector<double>& offset_mm, double tau_mm,
                     double stray_ratio, SurfaceSystem& system) const {
  const std::vector<EdgeSupport> supports = supports_at(tau_mm, stray_ratio);
  SurfaceSystem::Row row;
  for (std::size_t i = begin; i < end; ++i) {
    const Point& p = points_[i];
    if (!counts(i)) continue;
    const double inside = inside_mm(p, offset_mm);
    if (stray_[i]) continue;
    const EdgeSupport& support = supports[p.edge];
    double slope_per_mm = 0.0, curvature_per_mm2 = 0.0;
    if (messages_[i]) {
      curvature_per_mm2 = messages_[i]->precision_per_mm2;
      slope_per_mm = messages_[i]->slope_at(inside) + p.weight * support.density_pull_per_mm(inside);
    } else {
      const EdgeSupport::Pull pull = support.at(inside, p.wall);
      slope_per_mm = p.weight * pull.slope_per_mm;
      curvature_per_mm2 = p.weight * pull.curvature_per_mm2;
    }
    if (slope_per_mm == 0.0 && curvature_per_mm2 == 0.0) continue;
    set_row(p, row);
    system.add(row, slope_per_mm, curvature_per_mm2);
  }
}

std::vector<EdgeSite> EdgeStrips::sites(const std::vector<double>& offset_mm, double tau_mm,
                                        double stray_ratio) const {
  const std::vector<EdgeSupport> supports = supports_at(tau_mm, stray_ratio);
  std::vector<EdgeSite> found;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    if (!counts(i) || stray_[i]) continue;
    EdgeSite site{i, {}, inside_mm(p, offset_mm), {}, p.wall};
    if (messages_[i]) {
      site.message = *messages_[i];
    } else {
      const double points_per_mm = this->points_per_mm(edges_[p.edge]);
      if (points_per_mm > kDensePerMm) continue;
      if (site.inside_mm > std::max(kSiteBlurs * kEdgeBlurMm, kSitePoints / points_per_mm)) continue;
      const EdgeSupport& support = supports[p.edge];
      const EdgeSupport::Pull pull = support.at(site.inside_mm, p.wall);
      site.message.precision_per_mm2 = pull.curvature_per_mm2;
      site.message.pull_per_mm = pull.curvature_per_mm2 * site.inside_mm - pull.slope_per_mm +
                                 support.density_pull_per_mm(site.inside_mm);
    }
    set_row(p, site.row);
    found.push_back(std::move(site));
  }
  return found;
}

void EdgeStrips::set_messages(const std::vector<EdgeSite>& sites) {
  for (const EdgeSite& site : sites) messages_[site.pair] = site.message;
}

double EdgeStrips::resistance(const SurfaceSystem& system, const Eigen::VectorXd& move,
                              const std::vector<double>& offset_mm, double tau_mm, double stray_ratio,
                              std::span<const std::size_t> without_pairs) const {
  const std::vector<EdgeSupport> supports = supports_at(tau_mm, stray_ratio);
  SurfaceSystem::Row row;
  double sum = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    if (!counts(i) || stray_[i] ||
        std::find(without_pairs.begin(), without_pairs.end(), i) != without_pairs.end())
      continue;
    set_row(p, row);
    const double by_mm = system.dot(row, move);
    const double inside = inside_mm(p, offset_mm);
    const EdgeSupport& support = supports[p.edge];
    const EdgeSupport::Pull pull = support.at(inside, p.wall);
    sum += p.weight * (support.whole_cost(inside + by_mm, p.wall) - support.whole_cost(inside, p.wall) -
                       pull.slope_per_mm * by_mm - 0.5 * pull.curvature_per_mm2 * by_mm * by_mm);
  }
  return sum;
}

double EdgeStrips::void_mm2(double from_mm, double to_mm) const {
  double sum_mm2 = 0.0;
  for (const Edge& edge : edges_)
    for (std::size_t k = 0; k + 1 < edge.stations.size(); ++k) {
      const ContourStation& station = edge.stations[k];
      if (!edge.bins.seen_at(station.arc_mm)) continue;
      const double fan = std::max(0.0, station.fan_per_mm);  // the void narrows towards the middle of a hole
      const double end_mm = fan * to_mm > 1.0 ? std::max(from_mm, 1.0 / fan) : to_mm;
      const double width_mm = (end_mm - from_mm) * (1.0 - 0.5 * fan * (end_mm + from_mm));
      sum_mm2 += (edge.stations[k + 1].arc_mm - station.arc_mm) * width_mm;
    }
  return sum_mm2;
}

std::size_t EdgeStrips::points_in_void(double from_mm, double to_mm, double height_mm) const {
  return static_cast<std::size_t>(std::count_if(points_.begin(), points_.end(), [&](const Point& p) {
    const double outside_mm = -p.foot.across_mm;
    return p.foot.distance_mm < reach_mm_ && outside_mm > from_mm && outside_mm < to_mm &&
           std::abs(p.foot.height_mm) < height_mm && edges_[p.edge].bins.seen_at(p.foot.arc_mm);
  }));
}

double EdgeStrips::stray_ratio() const {
  const double density_per_mm2 = greatest_density_per_mm2();
  const auto ratio = [&](double strays, double from_mm, double to_mm) {
    return strays / std::max(1.0, density_per_mm2 * void_mm2(from_mm, to_mm));
  };
  const double far_mm = 0.5 * strip_mm_, near_mm = kNearRatio * strip_mm_;
  const double level = static_cast<double>(points_in_void(far_mm, reach_mm_, gate_mm_));
  const double all = static_cast<double>(points_in_void(near_mm, strip_mm_, kStrayHeightMm));
  return std::min(kMostStrayRatio,
                  std::max(ratio(kUnseenStrays + level, far_mm, reach_mm_),
                           ratio(all * std::min(1.0, gate_mm_ / kStrayHeightMm), near_mm, strip_mm_)));
}

std::vector<EdgeClaim> EdgeStrips::claims(const std::vector<double>& offset_mm, double tau_mm,
                                          double stray_ratio) const {
  const std::vector<EdgeSupport> supports = supports_at(tau_mm, stray_ratio);
  std::vector<EdgeClaim> found;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    if (!counts(i) || stray_[i]) continue;
    const double inside = inside_mm(p, offset_mm);
    const EdgeSupport& support = supports[p.edge];
    const EdgeSupport::Pull pull = support.at(inside, p.wall);
    if (std::abs(inside) > kClaimTaus * support.tau_mm || pull.slope_per_mm >= 0.0) continue;
    EdgeClaim claim;
    claim.pair = i;
    claim.arc_mm = p.foot.arc_mm;
    claim.slope = p.weight * pull.slope_per_mm;
    claim.curvature = p.weight * pull.curvature_per_mm2;
    claim.saved = p.weight * (support.cost(inside, p.wall) + std::log(stray_ratio));
    set_row(p, claim.row);
    found.push_back(std::move(claim));
  }
  return found;
}

double EdgeStrips::length_mm() const {
  double sum_mm = 0.0;
  for (const Edge& edge : edges_) sum_mm += edge.curve->length_mm();
  return sum_mm;
}

double EdgeStrips::seen_mm() const {
  double sum_mm = 0.0;
  for (const Edge& edge : edges_)
    sum_mm +=
        edge.bins.bin_mm * static_cast<double>(std::count(edge.bins.seen.begin(), edge.bins.seen.end(), 1));
  return sum_mm;
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
