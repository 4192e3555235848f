#include "registration/surface_refine.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "acquisition/geometry/evenly_drawn.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "registration/bend_evidence.hpp"
#include "registration/common_bend.hpp"
#include "registration/common_height.hpp"
#include "registration/common_strain.hpp"
#include "registration/edge_strips.hpp"
#include "registration/seen_elsewhere.hpp"
#include "registration/shape_about.hpp"
#include "registration/surface_factor.hpp"
#include "registration/surface_ground.hpp"
#include "registration/surface_pairs.hpp"

namespace arris {
namespace {

constexpr double kAnneal = 0.6, kScaleSigmas = 4.0, kGateSigmas = 4.0;
constexpr double kStartTauMm = 2.0, kTauShrink = 0.6;
constexpr double kFollowedTaus = 0.3;  // a round that moves the edge by more has not followed it yet
constexpr int kMostHeld = 8;           // rounds at one tau
constexpr int kStrayPasses = 5, kBurrPasses = 4;
constexpr double kClaimsNearMm = 150.0;  // strays that hold one place of an edge together
constexpr std::size_t kFewestPointsANode = 8, kLevelFactor = 4;  // of the first rounds of a dense scan
constexpr double kGaugeMm = 50.0;       // weak pull to the rigid start, for motions that nothing else holds
constexpr double kProximalMm = 5.0;     // a round's moves along such motions stay small
constexpr double kLeastSigmaMm = 0.02;  // the drawing's own facets
constexpr double kSettledMm = 1e-3, kSettledEdgeLimits = 0.01;  // moves of a round that no longer matter
constexpr double kUnfollowedMm = 0.008;  // height of a bent surface that nodes 30 mm apart do not follow
constexpr double kFinerFactor = 1.5, kShapeCellRatio = 0.67;               // of the node spacing
constexpr double kWorthMm = 0.002, kWorthSigmas = 1.0, kWorthRatio = 0.5;  // of a shape left, to follow it
constexpr double kLeastNodesRatio = 0.4;  // of the spacing asked for: no closer to turn edges
constexpr double kSlopeSigmas = 2.0;      // of a node's height over its spacing: noise of a slope at an edge
constexpr double kMostSlopeNoiseRad = 7e-4, kWorthSlopeRad = 9e-4, kWorthSlopeNoises = 2.3;
constexpr double kBesideRatio = 1.2;  // of the least spacing: nodes beside contours
constexpr double kStiffStrainRatio = 1e-5, kStiffBendPerMm = 1e-6;  // of a part that stays as it is drawn
constexpr double kRigidMm = 0.015, kRigidSigmas = 0.3, kMostRigidSigmas = 1.3;
// Bends gather at openings and supports: only a sheet whose bends scatter by less than the first share of
// what is expected is taken to bend alike everywhere, and then by the second more than the evidence says.
constexpr double kAlikeRatio = 0.25, kAlikeWiden = 2.0;
constexpr double kShownRatio = 0.3;             // of the points that a node has on average
constexpr double kUnknownThicknessWiden = 2.0;  // the mid-surface's strain is then not known
constexpr int kMostAverages = 8;                // rounds of messages between points and edges
constexpr int kMostElsewhere = 3;               // fits from where more of the edges would be seen
constexpr std::size_t kParts = 2;               // chunks of a list: each needs a system of its own

/// Of two lists; 0 when they cannot be compared.
double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || a.empty()) return 0.0;
  double sum2 = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum2 += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum2 / static_cast<double>(a.size()));
}

class SurfaceFitter {
 public:
  SurfaceFitter(const CadModel& cad, const ScanModel& scan, const RigidMotion& rigid,
                const SurfaceOptions& options)
      : cad_(cad), scan_(scan), options_(options), prior_(options.prior) {
    fit_.scan_from_cad = rigid;
    fit_.scanner_sd_mm = options.scanner.sd_mm;
    if (prior_.thickness_mm <= 0.0) prior_.strain_ratio *= kUnknownThicknessWiden;
    for (const Curve& curve : options.role == ContourRole::kEdge ? cad.contours : cad.others)
      edges_.push_back(&curve);
    ground_ = even_ground(cad, band_mm(), options.node_spacing_mm);
    fit_.basis = ground_.basis;
    const double reach_mm = options.band_mm + options.start_scale_mm + 3.0 * scan.spacing_mm;
    near_ =
        points_near(cad, scan, rigid, options.role == ContourRole::kCut ? -1.0 : reach_mm, options.threads);
  }

  SurfaceFit run() {
    if (fit_.basis->size() < 6) {
      fit_.reason = "the drawing's band has no room for a surface field";
      return std::move(fit_);
    }
    take_points(levels().front());
    if (!stays_rigid()) {
      start_over();
      settle();
    }
    finish();
    if (fit_.usable() && !fit_.elsewhere.by_mm.isZero()) try_elsewhere();
    return std::move(fit_);
  }

 private:
  /// Fitted again from where more of the edges would be seen, as long as there is such a place; the fit that
  /// sees most of them is kept.
  void try_elsewhere() {
    SurfaceFit most = fit_;
    for (int more = 0; more < kMostElsewhere && !fit_.elsewhere.by_mm.isZero(); ++more) {
      take_points(levels().front());
      for (Eigen::Vector3d& shift : fit_.shift_mm) shift += fit_.elsewhere.by_mm;
      look_coarsely();
      settle();
      finish();
      if (!fit_.usable()) break;
      if (fit_.elsewhere.here_mm > most.elsewhere.here_mm) most = fit_;
    }
    fit_ = std::move(most);
  }

  /// From few of the points to all: burrs, nodes, strays, the edges' mean, and what the fit may still owe.
  void finish() {
    const std::vector<std::size_t> one_of_each = levels();
    see_whether_alike();
    for (std::size_t level = 1; level < one_of_each.size() && fit_.usable(); ++level) {
      take_points(one_of_each[level]);
      (void)call_burrs();  // before so many points pull the edge to them
      settle();
    }
    for (int pass = 0; pass < kBurrPasses && fit_.usable() && call_burrs(); ++pass) settle();
    if (fit_.usable()) bends_alike_ ? follow_alike() : choose_nodes();
    for (int pass = 1; fit_.usable() && call_strays() && pass < kStrayPasses; ++pass) settle();
    if (fit_.usable()) {
      average_edges();
      fit_.elsewhere = seen_elsewhere(*strips_, ground_.contours, fit_.shift_mm, scan_.spacing_mm,
                                      [&](const auto& shift_mm) { lay_strips(shift_mm, false); });
      fit_.common_strain_mm = moves_by_common_strain(ground_.sheet, fit_.shift_mm, prior_, fit_.covariance);
      fit_.covariance += doubt_mm2_;
    }
  }

  /// Of the CAD about the contours that carries the field; -1: all of it.
  [[nodiscard]] double band_mm() const {
    return options_.role == ContourRole::kCut ? -1.0 : options_.band_mm;
  }

  /// No deformation, and everything looked at coarsely.
  void start_over() {
    fit_.reason.clear();
    fit_.shift_mm.assign(fit_.basis->size(), Eigen::Vector3d::Zero());
    fit_.offset_mm.assign(edges_.size(), 0.0);
    look_coarsely();
  }

  void look_coarsely() {
    scale_mm_ = options_.start_scale_mm;
    tau_mm_ = std::max(kStartTauMm, 0.5 * scan_.spacing_mm);
  }

  /// A part that hardly bends is not allowed to: a soft field would let its contours wander apart, each by
  /// what its own edge shows. Tried when the rigid motion leaves little; then the priors are stiff and the
  /// field has settled, unless neighbours still share more height than kRigidMm and the noise hide.
  bool stays_rigid() {
    start_over();
    look();
    const double hidden_mm = std::max(kRigidMm, kRigidSigmas * scan_.noise_sigma_mm);
    if (fit_.sigma_mm > std::hypot(kMostRigidSigmas * scan_.noise_sigma_mm, hidden_mm)) return false;
    const SheetPrior soft = prior_;
    stiff_ = true;
    prior_.strain_ratio = std::min(kStiffStrainRatio, soft.strain_ratio);
    prior_.bend_per_mm = std::min(kStiffBendPerMm, soft.bend_per_mm);
    settle();
    look();
    const CommonHeight common(pairs_, fit_.basis->spacing_mm(), kGateSigmas * fit_.sigma_mm);
    if (fit_.usable() && common.mean_mm2() < hidden_mm * hidden_mm) return true;
    prior_ = soft;
    stiff_ = false;
    return false;
  }

  /// A dense scan is fitted by few of its points first: one of 16, of 4, of 1, as long as the nodes see
  /// enough.
  [[nodiscard]] std::vector<std::size_t> levels() const {
    const std::size_t fewest = kFewestPointsANode * fit_.basis->size();
    std::vector<std::size_t> one_of = {1};
    while (near_.size() / (kLevelFactor * one_of.front()) >= fewest)
      one_of.insert(one_of.begin(), kLevelFactor * one_of.front());
    return one_of;
  }

  /// From now on one of so many points takes part.
  void take_points(std::size_t one_of) {
    points_.clear();
    pairs_.clear();
    for (const std::size_t i : evenly_drawn(near_.size(), near_.size() / one_of)) points_.push_back(near_[i]);
    points_ = beside_each_other(scan_, points_, options_.threads);
    lay_out_strips(one_of);
  }

  void lay_out_strips(std::size_t one_of) {
    const double spacing_mm = scan_.spacing_mm * std::sqrt(static_cast<double>(one_of));
    const double strip_mm = std::clamp(4.0 * spacing_mm, 3.0, options_.strip_mm);
    strips_.emplace(edges_, *fit_.basis, strip_mm, spacing_mm, options_.scanner.out_mm);
    strip_reach_mm_ = strip_mm + options_.start_scale_mm;
  }

  /// Rounds until the field stands still at the finest scales. The edge sharpens only as the field follows:
  /// else it is held where the first rounds found it.
  void settle() {
    fit_.stop = "round limit";
    int held = 0;
    for (int round = 0; round < options_.max_rounds; ++round) {
      ++fit_.rounds;
      look();
      const double finest_tau_mm = strips_->finest_tau_mm(options_.edge_share_ratio);
      tau_mm_ = std::max(finest_tau_mm, tau_mm_);
      const bool settled =
          tau_mm_ <= 1.001 * finest_tau_mm && scale_mm_ <= 1.001 * kScaleSigmas * fit_.sigma_mm;
      scale_mm_ = std::max(scale_mm_, kScaleSigmas * fit_.sigma_mm);
      const double moved_mm = step();
      if (!std::isfinite(moved_mm)) {
        fit_.reason = "the surface field did not stay finite";
        return;
      }
      if (settled && moved_mm < settled_mm()) {
        fit_.stop = "converged";
        return;
      }
      scale_mm_ = std::max(kScaleSigmas * fit_.sigma_mm, kAnneal * scale_mm_);
      if (moved_mm > kFollowedTaus * tau_mm_ && ++held < kMostHeld) continue;
      held = 0;
      tau_mm_ = std::max(finest_tau_mm, kTauShrink * tau_mm_);
    }
  }

  /// Looks for burrs from the field as it stands; true: other places than before.
  bool call_burrs() {
    look();
    return strips_->call_burrs(fit_.offset_mm, strips_->finest_tau_mm(options_.edge_share_ratio));
  }

  /// Covariance of the field as it stands, and what it may owe to strays; true: some were, and are let go.
  bool call_strays() {
    look();
    scale_mm_ = kScaleSigmas * fit_.sigma_mm;
    const SurfaceSystem system = assemble();
    fit_.covariance = SurfaceFactor(system).inverse(options_.threads);
    const double ratio = strips_->stray_ratio();
    const std::vector<EdgeClaim> claims = strips_->claims(fit_.offset_mm, tau_mm_, ratio);
    const auto resistance = [&](const Eigen::VectorXd& move, std::span<const std::size_t> without) {
      std::vector<std::size_t> pairs;
      for (const std::size_t a : without) pairs.push_back(claims[a].pair);
      return strips_->resistance(system, move, fit_.offset_mm, tau_mm_, ratio, pairs);
    };
    const ClaimVerdict verdict = judge_claims(system, fit_.covariance, claims, kClaimsNearMm, resistance);
    for (const std::size_t pair : verdict.strays) strips_->call_stray(pair);
    doubt_mm2_ = verdict.doubt;
    return !verdict.strays.empty();
  }

  /// From the mode of the edges' posterior to its mean and covariance.
  void average_edges() {
    for (int round = 0; round < kMostAverages; ++round) {
      const double stray_ratio = strips_->stray_ratio();
      std::vector<EdgeSite> sites = strips_->sites(fit_.offset_mm, tau_mm_, stray_ratio);
      if (sites.empty()) return;
      strips_->set_messages(sites);
      pass_messages(assemble(), stray_ratio, sites);
      strips_->set_messages(sites);
      const double moved_mm = step();
      look();
      if (moved_mm < settled_mm()) break;
    }
    fit_.covariance = SurfaceFactor(assemble()).inverse(options_.threads);
  }

  /// The same field on other nodes; all points take part already.
  void stand_on(SurfaceGround ground) {
    const std::shared_ptr<const SurfaceBasis> basis = fit_.basis;
    const std::vector<Eigen::Vector3d> shift_mm = std::move(fit_.shift_mm);
    ground_ = std::move(ground);
    fit_.basis = ground_.basis;
    const SurfaceNodes& nodes = fit_.basis->nodes();
    fit_.shift_mm.clear();
    for (std::size_t j = 0; j < nodes.points_mm.size(); ++j)
      fit_.shift_mm.push_back(
          basis->row(nodes.points_mm[j], nodes.normals[j]).combine(BasisRow::kValue, shift_mm));
    renew_rows(*fit_.basis, options_.threads, pairs_);
    lay_out_strips(1);
    (void)call_burrs();
  }

  /// A sheet that bends much alike everywhere is not allowed to bend otherwise by more than it shows: noise
  /// that neighbouring points share looks like bends.
  void see_whether_alike() {
    bends_alike_ = false;
    prior_.common_bend_per_mm.setZero();
    if (stiff_ || !fit_.usable()) return;
    prior_.bend_per_mm = prior_.unseen_bend_per_mm = options_.prior.bend_per_mm;
    look();
    mark_seen();
    unfollowed_mm_ =
        unfollowed_mm(CommonHeight(pairs_, 0.5 * fit_.basis->spacing_mm(), kGateSigmas * fit_.sigma_mm));
    const double ratio = scatter_ratio();
    unfollowed_mm_ = kUnfollowedMm;
    if (ratio <= kAlikeRatio) bend_alike(ratio);
  }

  void bend_alike(double scatter_ratio) {
    bends_alike_ = true;
    prior_.bend_per_mm = std::min(1.0, kAlikeWiden * scatter_ratio) * options_.prior.bend_per_mm;
    settle();
  }

  /// What the scan does not show may bend by as much as was expected: nothing says that it bends alike too.
  void mark_seen() {
    std::vector<std::size_t> points(fit_.basis->size(), 0);
    for (const SurfacePair& pair : pairs_)
      if (pair.on_face) ++points[pair.row.nearest()];
    const double even = static_cast<double>(fit_.pairs) / static_cast<double>(points.size());
    for (SheetCell& cell : ground_.sheet)
      cell.set_seen(static_cast<double>(points[cell.row().nearest()]) >= kShownRatio * even);
  }

  /// Closer nodes would follow noise.
  void follow_alike() {
    weigh_unfollowed();
    bend_alike(scatter_ratio());
  }

  /// How far the fit's bends scatter about their common one, over what the options expect.
  [[nodiscard]] double scatter_ratio() const {
    SheetPrior bends = prior_, others = prior_;
    bends.strain_ratio = bends.unseen_bend_per_mm = others.bend_per_mm =
        std::numeric_limits<double>::infinity();
    bends.bend_per_mm = options_.prior.bend_per_mm;
    bends.common_bend_per_mm = common_bend(bends).likeliest_per_mm();
    FitParts parts{seen(), sheet_priors(others), sheet_priors(bends), common_bend(bends)};
    add_weak_priors(parts.other_priors);
    return likeliest_scatter_ratio(parts);
  }

  /// Nodes closer together beside the contours, as long as that is worth it.
  void choose_nodes() {
    while (fit_.usable() && went_finer()) {
    }
    if (fit_.usable()) weigh_unfollowed();
  }

  [[nodiscard]] double finer_mm() const { return fit_.basis->spacing_mm() / kFinerFactor; }
  [[nodiscard]] bool enough_points_for(double spacing_mm) const {
    return static_cast<double>(fit_.pairs) * spacing_mm * spacing_mm >= kFewestPointsANode * ground_.area_mm2;
  }

  /// True: nodes closer together follow a shape that was left, or turn the edges, and stay.
  bool went_finer() {
    const double cell_mm = kShapeCellRatio * fit_.basis->spacing_mm(), left_mm = shape_left_mm(cell_mm);
    const double told_mm =
        kWorthSigmas * fit_.sigma_mm *
        std::sqrt(static_cast<double>(fit_.basis->size()) / static_cast<double>(fit_.pairs));
    const bool shape = left_mm >= std::max(kWorthMm, told_mm) && enough_points_for(finer_mm());
    const double turn_rad = turn_worth_rad();
    if (!shape && std::isinf(turn_rad)) return false;
    const std::vector<double> before = edge_slopes(cad_, *fit_.basis, ground_.contours, fit_.shift_mm);
    return keep_finer_if([&] {
      if (shape && shape_left_mm(cell_mm) < kWorthRatio * left_mm) return true;
      return rms_difference(before, edge_slopes(cad_, *fit_.basis, ground_.contours, fit_.shift_mm)) >
             turn_rad;
    });
  }

  /// Turn of the edges that nodes closer together are kept for: at a free edge, where tools work, a part
  /// bends in ways that heights hardly show. Nodes follow what noise neighbours share as well; where that
  /// alone turns edges no turn is worth it. Infinite too for a part that stays rigid, and where nodes are
  /// close enough.
  [[nodiscard]] double turn_worth_rad() const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (stiff_ || finer_mm() < kLeastNodesRatio * options_.node_spacing_mm) return kNone;
    const double noise_rad = slope_noise_rad(finer_mm());
    if (noise_rad > kMostSlopeNoiseRad) return kNone;
    return std::max(kWorthSlopeRad, kWorthSlopeNoises * noise_rad);
  }

  /// Of the slope that nodes so far apart have at an edge: from the points' own noise and from what
  /// neighbours share beyond the field.
  [[nodiscard]] double slope_noise_rad(double spacing_mm) const {
    const CommonHeight common(pairs_, 0.5 * fit_.basis->spacing_mm(), kGateSigmas * fit_.sigma_mm);
    const double points = static_cast<double>(fit_.pairs) * spacing_mm * spacing_mm / ground_.area_mm2;
    return kSlopeSigmas / spacing_mm *
           std::hypot(fit_.sigma_mm / std::sqrt(points), std::sqrt(common.mean_mm2()));
  }

  /// Settles on nodes closer together; goes back where that was not worth it. True: it was, or is no fit.
  bool keep_finer_if(const std::function<bool()>& worth) {
    SurfaceGround finer = graded_ground(cad_, band_mm(), finer_mm(), options_.node_spacing_mm);
    if (finer.too_fine()) return false;
    const std::vector<Eigen::Vector3d> shift_mm = fit_.shift_mm;
    const std::vector<double> offset_mm = fit_.offset_mm;
    SurfaceGround coarser = ground_;
    stand_on(std::move(finer));
    settle();
    if (!fit_.usable() || worth()) return true;
    stand_on(std::move(coarser));
    fit_.shift_mm = shift_mm;
    fit_.offset_mm = offset_mm;
    settle();
    return false;
  }

  /// Height of the shape that the nodes beside the contours do not follow.
  [[nodiscard]] double shape_left_mm(double cell_mm) const {
    return arris::shape_left_mm(pairs_, cell_mm, kGateSigmas * fit_.sigma_mm,
                                kBesideRatio * fit_.basis->spacing_mm());
  }

  /// What the nodes do not follow counts against every point.
  void weigh_unfollowed() {
    const double spacing_mm = fit_.basis->spacing_mm();
    const CommonHeight common(pairs_, 0.5 * spacing_mm, kGateSigmas * fit_.sigma_mm);
    unfollowed_mm_ = unfollowed_mm(common);
    fit_.unfollowed_mm2 = common.excess_mm2(fit_.shift_mm.size(), unfollowed_mm_ * unfollowed_mm_);
    fit_.unfollowed_mean_mm2 = unfollowed_mm_ * unfollowed_mm_;
    if (stiff_)  // a stiff field's covariance does not know of it
      fit_.unfollowed_mm2.assign(fit_.shift_mm.size(), fit_.unfollowed_mean_mm2);
    settle();
  }

  [[nodiscard]] double unfollowed_mm(const CommonHeight& common) const {
    const double spacing_ratio = fit_.basis->spacing_mm() / options_.node_spacing_mm;
    return std::max(std::sqrt(common.mean_mm2()), kUnfollowedMm * spacing_ratio * spacing_ratio);
  }

  /// Partners, residuals, strips and the bend that all share, under the field as it is.
  void look() {
    pair_surface(cad_, scan_, points_, fit_.scan_from_cad, *fit_.basis, fit_.shift_mm,
                 4.0 * options_.start_scale_mm + 10.0, options_.threads, pairs_);
    fit_.sigma_mm =
        std::max({residual_sigma_mm(pairs_, scale_mm_), 0.5 * scan_.noise_sigma_mm, kLeastSigmaMm});
    fit_.pairs = static_cast<std::size_t>(
        std::count_if(pairs_.begin(), pairs_.end(), [](const SurfacePair& pair) { return pair.on_face; }));
    lay_strips(fit_.shift_mm);
    if (bends_alike_) prior_.common_bend_per_mm = common_bend(prior_).likeliest_per_mm();
  }

  [[nodiscard]] CommonBend common_bend(const SheetPrior& prior) const {
    return arris::common_bend(ground_.sheet, fit_.shift_mm, prior,
                              static_cast<Eigen::Index>(3 * fit_.shift_mm.size() + fit_.offset_mm.size()));
  }

  void lay_strips(const std::vector<Eigen::Vector3d>& shift_mm, bool walls_count = true) {
    strips_->update(pairs_, shift_mm, strip_reach_mm_, kGateSigmas * fit_.sigma_mm, walls_count,
                    options_.threads);
  }

  /// Sums add(begin, end, system) over fixed chunks, in their order.
  template <class Add>
  SurfaceSystem summed(std::size_t count, const Add& add) const {
    const std::size_t chunk = std::max<std::size_t>(1, (count + kParts - 1) / kParts);
    return parallel_sum(count, chunk, options_.threads,
                        SurfaceSystem(fit_.basis->band(), fit_.offset_mm.size()),
                        [&](std::size_t begin, std::size_t end) {
                          SurfaceSystem part(fit_.basis->band(), fit_.offset_mm.size());
                          add(begin, end, part);
                          return part;
                        });
  }

  /// What a point is worth: its noise, and what nodes so far apart cannot follow of a bent surface. That is
  /// alike for all points between the same nodes, so more of them do not average it away; trusted by their
  /// noise alone, many points trade it for a slide in the surface, where only the edge holds the field.
  double point_sigma_mm() const {
    const double points_a_node = static_cast<double>(fit_.pairs) / static_cast<double>(fit_.basis->size());
    return std::hypot(fit_.sigma_mm, unfollowed_mm_ * std::sqrt(points_a_node));
  }

  SurfaceSystem assemble() const {
    SurfaceSystem system = seen();
    system += sheet_priors(prior_);
    add_weak_priors(system);
    if (bends_alike_) common_bend(prior_).take_out_of(system);
    return system;
  }

  /// What the scan shows of the surface and the edges.
  [[nodiscard]] SurfaceSystem seen() const {
    const double sigma_mm = point_sigma_mm(), stray_ratio = strips_->stray_ratio();
    return summed(pairs_.size(), [&](std::size_t begin, std::size_t end, SurfaceSystem& part) {
      add_surface(pairs_, begin, end, sigma_mm, scale_mm_, part);
      strips_->add(begin, end, fit_.offset_mm, tau_mm_, stray_ratio, part);
    });
  }

  [[nodiscard]] SurfaceSystem sheet_priors(const SheetPrior& prior) const {
    return summed(ground_.sheet.size(), [&](std::size_t begin, std::size_t end, SurfaceSystem& part) {
      for (std::size_t i = begin; i < end; ++i) ground_.sheet[i].add(fit_.shift_mm, prior, part);
    });
  }

  void add_weak_priors(SurfaceSystem& system) const {
    const double gauge = 1.0 / (kGaugeMm * kGaugeMm * static_cast<double>(system.nodes));
    for (std::size_t j = 0; j < system.nodes; ++j)
      system.gradient.segment<3>(static_cast<Eigen::Index>(3 * j)) += gauge * fit_.shift_mm[j];
    system.add_to_nodes(gauge);
    const double offset = 1.0 / (options_.offset_sd_mm * options_.offset_sd_mm);
    for (std::size_t e = 0; e < fit_.offset_mm.size(); ++e) {
      system.gradient[static_cast<Eigen::Index>(3 * system.nodes + e)] += offset * fit_.offset_mm[e];
      system.add_to_offset(e, offset);
    }
  }

  /// One Gauss-Newton step; returns the rms move of the followed contours across and normal to them.
  double step() {
    SurfaceSystem system = assemble();
    const Eigen::Index n = static_cast<Eigen::Index>(3 * system.nodes);
    system.add_to_nodes(1.0 / (kProximalMm * kProximalMm));
    const SurfaceFactor factor(system);
    if (!factor.usable()) return std::numeric_limits<double>::quiet_NaN();
    const Eigen::VectorXd move = -factor.solve(system.gradient);
    std::vector<Eigen::Vector3d> moved(system.nodes);
    for (std::size_t j = 0; j < moved.size(); ++j) {
      moved[j] = move.segment<3>(static_cast<Eigen::Index>(3 * j));
      fit_.shift_mm[j] += moved[j];
    }
    for (std::size_t e = 0; e < fit_.offset_mm.size(); ++e)
      fit_.offset_mm[e] += move[n + static_cast<Eigen::Index>(e)];
    return moved_mm(moved);
  }

  double moved_mm(const std::vector<Eigen::Vector3d>& moved) const {
    double sum2 = 0.0, count = 1e-9;
    for (const std::vector<ContourStation>& stations : ground_.contours)
      for (const ContourStation& station : stations) {
        Eigen::Vector3d d = station.row.combine(BasisRow::kValue, moved);
        d -= d.dot(station.tangent) * station.tangent;
        sum2 += d.squaredNorm();
        count += 1.0;
      }
    return std::sqrt(sum2 / count);
  }

  double settled_mm() const {
    return std::max(kSettledMm, kSettledEdgeLimits / (50.0 * strips_->greatest_density_per_mm2()));
  }

  const CadModel& cad_;
  const ScanModel& scan_;
  const SurfaceOptions& options_;
  SheetPrior prior_;
  SurfaceFit fit_;
  SurfaceGround ground_;
  std::vector<const Curve*> edges_;
  std::optional<EdgeStrips> strips_;
  std::vector<std::size_t> near_, points_;  // scan points near the contours, and those that take part
  std::vector<SurfacePair> pairs_;
  Eigen::MatrixXd doubt_mm2_;  // covariance of what may be owed to strays
  bool stiff_ = false, bends_alike_ = false;
  double unfollowed_mm_ = kUnfollowedMm;
  double scale_mm_ = 10.0, tau_mm_ = kStartTauMm, strip_reach_mm_ = 20.0;
};

}  // namespace

SurfaceFit refine_surface(const CadModel& cad, const ScanModel& scan, const RigidMotion& rigid_scan_from_cad,
                          const SurfaceOptions& options) {
  options.check();
  return SurfaceFitter(cad, scan, rigid_scan_from_cad, options).run();
}

}  // namespace arris
