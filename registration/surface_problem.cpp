#include "registration/surface_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/geometry/evenly_drawn.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "registration/bend_evidence.hpp"
#include "registration/surface_factor.hpp"

namespace arris {
namespace {

constexpr double kAnneal = 0.6;
constexpr double kStartTauMm = 2.0, kTauShrink = 0.6;
constexpr double kFollowedTaus = 0.3;    // a round that moves the edge by more has not followed it yet
constexpr double kMostTaus = 5.0;        // farther off, an edge does not feel its points
constexpr int kMostHeld = 8;             // rounds at one tau
constexpr std::size_t kLevelFactor = 4;  // of the points of a dense scan, from one level to the next
constexpr double kGaugeMm = 50.0;        // weak pull to the rigid start, for motions that nothing else holds
constexpr double kProximalMm = 5.0;      // a round's moves along such motions stay small
constexpr double kLeastSigmaMm = 0.02;   // the drawing's own facets
constexpr double kSettledMm = 1e-3, kSettledEdgeLimits = 0.01;  // moves of a round that no longer matter
constexpr double kShownRatio = 0.3;                             // of the points that a node has on average
constexpr double kUnknownThicknessWiden = 2.0;                  // the mid-surface's strain is then not known
constexpr std::size_t kParts = 2;  // chunks of a list: each needs a system of its own

}  // namespace

SurfaceProblem::SurfaceProblem(const CadModel& cad, const ScanModel& scan,
                               const RigidMotion& rigid_scan_from_cad, const SurfaceOptions& options)
    : prior(options.prior), cad_(cad), scan_(scan), options_(options) {
  fit.scan_from_cad = rigid_scan_from_cad;
  fit.scanner_sd_mm = options.scanner.sd_mm;
  if (prior.thickness_mm <= 0.0) prior.strain_ratio *= kUnknownThicknessWiden;
  for (const Curve& curve : options.role == ContourRole::kEdge ? cad.contours : cad.others)
    edges_.push_back(&curve);
  ground = even_ground(cad, band_mm(), options.node_spacing_mm);
  fit.basis = ground.basis;
  const double reach_mm = options.band_mm + options.start_scale_mm + 3.0 * scan.spacing_mm;
  near_ = points_near(cad, scan, rigid_scan_from_cad, options.role == ContourRole::kCut ? -1.0 : reach_mm,
                      options.threads);
}

double SurfaceProblem::band_mm() const {
  return options_.role == ContourRole::kCut ? -1.0 : options_.band_mm;
}

void SurfaceProblem::start_over() {
  fit.reason.clear();
  fit.shift_mm.assign(fit.basis->size(), Eigen::Vector3d::Zero());
  fit.offset_mm.assign(edges_.size(), 0.0);
  look_coarsely();
}

void SurfaceProblem::look_coarsely() {
  scale_mm = options_.start_scale_mm;
  tau_mm = std::max(kStartTauMm, 0.5 * scan_.spacing_mm);
}

std::vector<std::size_t> SurfaceProblem::levels() const {
  const std::size_t fewest = kFewestPointsANode * fit.basis->size();
  std::vector<std::size_t> one_of = {1};
  while (near_.size() / (kLevelFactor * one_of.front()) >= fewest)
    one_of.insert(one_of.begin(), kLevelFactor * one_of.front());
  return one_of;
}

void SurfaceProblem::take_points(std::size_t one_of) {
  points_.clear();
  pairs.clear();
  for (const std::size_t i : evenly_drawn(near_.size(), near_.size() / one_of)) points_.push_back(near_[i]);
  points_ = beside_each_other(scan_, points_, options_.threads);
  lay_out_strips(one_of);
}

void SurfaceProblem::lay_out_strips(std::size_t one_of) {
  const double spacing_mm = scan_.spacing_mm * std::sqrt(static_cast<double>(one_of));
  const double strip_mm = std::clamp(4.0 * spacing_mm, 3.0, options_.strip_mm);
  strips.emplace(edges_, *fit.basis, strip_mm, spacing_mm, options_.scanner.out_mm);
  strip_reach_mm_ = strip_mm + options_.start_scale_mm;
}

void SurfaceProblem::settle() {
  fit.stop = "round limit";
  int held = 0;
  for (int round = 0; round < options_.max_rounds; ++round) {
    ++fit.rounds;
    look();
    const double finest_tau_mm = strips->finest_tau_mm(options_.edge_share_ratio);
    tau_mm = std::max(finest_tau_mm, tau_mm);
    const bool settled = tau_mm <= 1.001 * finest_tau_mm && scale_mm <= 1.001 * kScaleSigmas * fit.sigma_mm;
    scale_mm = std::max(scale_mm, kScaleSigmas * fit.sigma_mm);
    const double moved_mm = step();
    if (!std::isfinite(moved_mm)) {
      fit.reason = "the surface field did not stay finite";
      return;
    }
    if (settled && moved_mm < settled_mm()) {
      fit.stop = "converged";
      return;
    }
    scale_mm = std::max(kScaleSigmas * fit.sigma_mm, kAnneal * scale_mm);
    if (moved_mm > kFollowedTaus * tau_mm && ++held < kMostHeld) continue;
    held = 0;
    tau_mm = std::max(finest_tau_mm, kTauShrink * tau_mm);
  }
}

bool SurfaceProblem::call_burrs() {
  look();
  return strips->call_burrs(fit.offset_mm, strips->finest_tau_mm(options_.edge_share_ratio));
}

void SurfaceProblem::stand_on(SurfaceGround other) {
  const std::shared_ptr<const SurfaceBasis> basis = fit.basis;
  const std::vector<Eigen::Vector3d> shift_mm = std::move(fit.shift_mm);
  ground = std::move(other);
  fit.basis = ground.basis;
  const SurfaceNodes& nodes = fit.basis->nodes();
  fit.shift_mm.clear();
  for (std::size_t j = 0; j < nodes.points_mm.size(); ++j)
    fit.shift_mm.push_back(
        basis->row(nodes.points_mm[j], nodes.normals[j]).combine(BasisRow::kValue, shift_mm));
  renew_rows(*fit.basis, options_.threads, pairs);
  lay_out_strips(1);
  (void)call_burrs();
}

void SurfaceProblem::mark_seen() {
  std::vector<std::size_t> points(fit.basis->size(), 0);
  for (const SurfacePair& pair : pairs)
    if (pair.on_face) ++points[pair.row.nearest()];
  const double even = static_cast<double>(fit.pairs) / static_cast<double>(points.size());
  for (SheetCell& cell : ground.sheet)
    cell.set_seen(static_cast<double>(points[cell.row().nearest()]) >= kShownRatio * even);
}

double SurfaceProblem::scatter_ratio() const {
  SheetPrior bends = prior, others = prior;
  bends.strain_ratio = bends.unseen_bend_per_mm = others.bend_per_mm =
      std::numeric_limits<double>::infinity();
  bends.bend_per_mm = options_.prior.bend_per_mm;
  bends.common_bend_per_mm = common_bend(bends).likeliest_per_mm();
  FitParts parts{seen(), sheet_priors(others), sheet_priors(bends), common_bend(bends)};
  add_weak_priors(parts.other_priors);
  return likeliest_scatter_ratio(parts);
}

double SurfaceProblem::shared_height_mm(const CommonHeight& common) const {
  const double spacing_ratio = fit.basis->spacing_mm() / options_.node_spacing_mm;
  return std::max(std::sqrt(common.mean_mm2()), kUnfollowedMm * spacing_ratio * spacing_ratio);
}

void SurfaceProblem::look() {
  pair_surface(cad_, scan_, points_, fit.scan_from_cad, *fit.basis, fit.shift_mm,
               4.0 * options_.start_scale_mm + 10.0, options_.threads, pairs);
  fit.sigma_mm = std::max({residual_sigma_mm(pairs, scale_mm), 0.5 * scan_.noise_sigma_mm, kLeastSigmaMm});
  fit.pairs = static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [](const SurfacePair& pair) { return pair.on_face; }));
  lay_strips(fit.shift_mm);
  if (bends_alike) prior.common_bend_per_mm = common_bend(prior).likeliest_per_mm();
}

CommonBend SurfaceProblem::common_bend(const SheetPrior& of) const {
  return arris::common_bend(ground.sheet, fit.shift_mm, of,
                            static_cast<Eigen::Index>(3 * fit.shift_mm.size() + fit.offset_mm.size()));
}

void SurfaceProblem::lay_strips(const std::vector<Eigen::Vector3d>& shift_mm, bool walls_count) {
  strips->update(pairs, shift_mm, fit.offset_mm, strip_reach_mm_, gate_mm(), walls_count, options_.threads);
}

double SurfaceProblem::point_sigma_mm() const {
  const double points_a_node = static_cast<double>(fit.pairs) / static_cast<double>(fit.basis->size());
  return std::hypot(fit.sigma_mm, unfollowed_mm * std::sqrt(points_a_node));
}

SurfaceSystem SurfaceProblem::assemble() const {
  SurfaceSystem system = seen();
  system += sheet_priors(prior);
  add_weak_priors(system);
  if (bends_alike) common_bend(prior).take_out_of(system);
  return system;
}

SurfaceSystem SurfaceProblem::seen() const {
  const double sigma_mm = point_sigma_mm(), stray_ratio = strips->stray_ratio();
  return summed(pairs.size(), [&](std::size_t begin, std::size_t end, SurfaceSystem& part) {
    add_surface(pairs, begin, end, sigma_mm, scale_mm, part);
    strips->add(begin, end, fit.offset_mm, tau_mm, stray_ratio, part);
  });
}

SurfaceSystem SurfaceProblem::sheet_priors(const SheetPrior& of) const {
  return summed(ground.sheet.size(), [&](std::size_t begin, std::size_t end, SurfaceSystem& part) {
    for (std::size_t i = begin; i < end; ++i) ground.sheet[i].add(fit.shift_mm, of, part);
  });
}

void SurfaceProblem::add_weak_priors(SurfaceSystem& system) const {
  const double gauge = 1.0 / (kGaugeMm * kGaugeMm * static_cast<double>(system.nodes));
  for (std::size_t j = 0; j < system.nodes; ++j)
    system.gradient.segment<3>(static_cast<Eigen::Index>(3 * j)) += gauge * fit.shift_mm[j];
  system.add_to_nodes(gauge);
  const double offset = 1.0 / (options_.offset_sd_mm * options_.offset_sd_mm);
  for (std::size_t e = 0; e < fit.offset_mm.size(); ++e) {
    system.gradient[static_cast<Eigen::Index>(3 * system.nodes + e)] += offset * fit.offset_mm[e];
    system.add_to_offset(e, offset);
  }
}

double SurfaceProblem::step() {
  SurfaceSystem system = assemble();
  const Eigen::Index n = static_cast<Eigen::Index>(3 * system.nodes);
  system.add_to_nodes(1.0 / (kProximalMm * kProximalMm));
  const SurfaceFactor factor(system);
  if (!factor.usable()) return std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd move = -factor.solve(system.gradient);
  move *= within_sight(move.tail(static_cast<Eigen::Index>(fit.offset_mm.size())));
  std::vector<Eigen::Vector3d> moved(system.nodes);
  for (std::size_t j = 0; j < moved.size(); ++j) {
    moved[j] = move.segment<3>(static_cast<Eigen::Index>(3 * j));
    fit.shift_mm[j] += moved[j];
  }
  for (std::size_t e = 0; e < fit.offset_mm.size(); ++e)
    fit.offset_mm[e] += move[n + static_cast<Eigen::Index>(e)];
  return moved_mm(moved);
}

double SurfaceProblem::within_sight(const Eigen::VectorXd& offset_move_mm) const {
  const double most_mm = kMostTaus * tau_mm;
  const double wanted_mm = offset_move_mm.size() > 0 ? offset_move_mm.cwiseAbs().maxCoeff() : 0.0;
  return wanted_mm > most_mm ? most_mm / wanted_mm : 1.0;
}

double SurfaceProblem::moved_mm(const std::vector<Eigen::Vector3d>& moved) const {
  double sum2 = 0.0, count = 1e-9;
  for (const std::vector<ContourStation>& stations : ground.contours)
    for (const ContourStation& station : stations) {
      Eigen::Vector3d d = station.row.combine(BasisRow::kValue, moved);
      d -= d.dot(station.tangent) * station.tangent;
      sum2 += d.squaredNorm();
      count += 1.0;
    }
  return std::sqrt(sum2 / count);
}

double SurfaceProblem::settled_mm() const {
  return std::max(kSettledMm, kSettledEdgeLimits / (50.0 * strips->greatest_density_per_mm2()));
}

template <class Add>
SurfaceSystem SurfaceProblem::summed(std::size_t count, const Add& add) const {
  const std::size_t chunk = std::max<std::size_t>(1, (count + kParts - 1) / kParts);
  return parallel_sum(count, chunk, options_.threads, SurfaceSystem(fit.basis->band(), fit.offset_mm.size()),
                      [&](std::size_t begin, std::size_t end) {
                        SurfaceSystem part(fit.basis->band(), fit.offset_mm.size());
                        add(begin, end, part);
                        return part;
                      });
}

}  // namespace arris
