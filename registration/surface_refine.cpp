#include "registration/surface_refine.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "registration/common_strain.hpp"
#include "registration/seen_elsewhere.hpp"
#include "registration/shape_about.hpp"
#include "registration/surface_factor.hpp"
#include "registration/surface_problem.hpp"

namespace arris {
namespace {

constexpr int kStrayPasses = 5, kBurrPasses = 4;
constexpr double kBesideBurrMm = 20.0;   // where a low burr may lie beside a high one: as long as most are
constexpr double kClaimsNearMm = 150.0;  // strays that hold one place of an edge together
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
constexpr int kMostAverages = 8;   // rounds of messages between points and edges
constexpr int kMostElsewhere = 3;  // fits from where more of the edges would be seen

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
      : cad_(cad), scan_(scan), options_(options), problem_(cad, scan, rigid, options) {}

  SurfaceFit run() {
    if (fit_.basis->size() < 6) {
      fit_.reason = "the drawing's band has no room for a surface field";
      return std::move(fit_);
    }
    problem_.take_points(problem_.levels().front());
    if (!stays_rigid()) {
      problem_.start_over();
      problem_.settle();
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
      problem_.take_points(problem_.levels().front());
      expect_any_bends();
      for (Eigen::Vector3d& shift : fit_.shift_mm) shift += fit_.elsewhere.by_mm;
      problem_.look_coarsely();
      problem_.settle();
      finish();
      if (!fit_.usable()) break;
      if (fit_.elsewhere.here_mm > most.elsewhere.here_mm) most = fit_;
    }
    fit_ = std::move(most);
  }

  /// From few of the points to all: burrs, nodes, strays, the edges' mean, and what the fit may still owe.
  void finish() {
    const std::vector<std::size_t> one_of_each = problem_.levels();
    see_whether_alike();
    for (std::size_t level = 1; level < one_of_each.size() && fit_.usable(); ++level) {
      problem_.take_points(one_of_each[level]);
      (void)problem_.call_burrs();  // before so many points pull the edge to them
      problem_.settle();
    }
    // A low burr beside a high one may have been taken for the edge: without it, it stands out.
    if (fit_.usable() && problem_.strips->widen_burrs(kBesideBurrMm)) problem_.settle();
    for (int pass = 0; pass < kBurrPasses && fit_.usable() && problem_.call_burrs(); ++pass)
      problem_.settle();
    if (fit_.usable()) problem_.bends_alike ? follow_alike() : choose_nodes();
    for (int pass = 1; fit_.usable() && call_strays() && pass < kStrayPasses; ++pass) problem_.settle();
    if (fit_.usable()) {
      average_edges();
      fit_.elsewhere =
          seen_elsewhere(*problem_.strips, problem_.ground.contours, fit_.shift_mm, scan_.spacing_mm,
                         [&](const auto& shift_mm) { problem_.lay_strips(shift_mm, false); });
      fit_.common_strain_mm =
          moves_by_common_strain(problem_.ground.sheet, fit_.shift_mm, problem_.prior, fit_.covariance);
      fit_.covariance += doubt_mm2_;
    }
  }

  /// A part that hardly bends is not allowed to: a soft field would let its contours wander apart, each by
  /// what its own edge shows. Tried when the rigid motion leaves little; then the priors are stiff and the
  /// field has settled, unless neighbours still share more height than kRigidMm and the noise hide.
  bool stays_rigid() {
    problem_.start_over();
    problem_.look();
    const double hidden_mm = std::max(kRigidMm, kRigidSigmas * scan_.noise_sigma_mm);
    if (fit_.sigma_mm > std::hypot(kMostRigidSigmas * scan_.noise_sigma_mm, hidden_mm)) return false;
    const SheetPrior soft = problem_.prior;
    stiff_ = true;
    problem_.prior.strain_ratio = std::min(kStiffStrainRatio, soft.strain_ratio);
    problem_.prior.bend_per_mm = std::min(kStiffBendPerMm, soft.bend_per_mm);
    problem_.settle();
    problem_.look();
    const CommonHeight common(problem_.pairs, fit_.basis->spacing_mm(), problem_.gate_mm());
    if (fit_.usable() && common.mean_mm2() < hidden_mm * hidden_mm) return true;
    problem_.prior = soft;
    stiff_ = false;
    return false;
  }

  /// Covariance of the field as it stands, and what it may owe to strays; true: some were, and are let go.
  bool call_strays() {
    problem_.look();
    problem_.scale_mm = SurfaceProblem::kScaleSigmas * fit_.sigma_mm;
    const SurfaceSystem system = problem_.assemble();
    fit_.covariance = SurfaceFactor(system).inverse(options_.threads);
    const double ratio = problem_.strips->stray_ratio();
    const std::vector<EdgeClaim> claims = problem_.strips->claims(fit_.offset_mm, problem_.tau_mm, ratio);
    const auto resistance = [&](const Eigen::VectorXd& move, std::span<const std::size_t> without) {
      std::vector<std::size_t> pairs;
      for (const std::size_t a : without) pairs.push_back(claims[a].pair);
      return problem_.strips->resistance(system, move, fit_.offset_mm, problem_.tau_mm, ratio, pairs);
    };
    const ClaimVerdict verdict = judge_claims(system, fit_.covariance, claims, kClaimsNearMm, resistance);
    for (const std::size_t pair : verdict.strays) problem_.strips->call_stray(pair);
    doubt_mm2_ = verdict.doubt;
    return !verdict.strays.empty();
  }

  /// From the mode of the edges' posterior to its mean and covariance.
  void average_edges() {
    for (int round = 0; round < kMostAverages; ++round) {
      const double stray_ratio = problem_.strips->stray_ratio();
      std::vector<EdgeSite> sites = problem_.strips->sites(fit_.offset_mm, problem_.tau_mm, stray_ratio);
      if (sites.empty()) return;
      problem_.strips->set_messages(sites);
      pass_messages(problem_.assemble(), stray_ratio, sites);
      problem_.strips->set_messages(sites);
      const double moved_mm = problem_.step();
      problem_.look();
      if (moved_mm < problem_.settled_mm()) break;
    }
    fit_.covariance = SurfaceFactor(problem_.assemble()).inverse(options_.threads);
  }

  /// A sheet that bends much alike everywhere is not allowed to bend otherwise by more than it shows: noise
  /// that neighbouring points share looks like bends.
  void see_whether_alike() {
    if (stiff_ || !fit_.usable()) return;
    expect_any_bends();
    problem_.look();
    problem_.mark_seen();
    const double unfollowed_mm = problem_.unfollowed_mm;
    problem_.unfollowed_mm = problem_.shared_height_mm(problem_.common_height());
    const double ratio = problem_.scatter_ratio();
    problem_.unfollowed_mm = unfollowed_mm;
    if (ratio <= kAlikeRatio) bend_alike(ratio);
  }

  void expect_any_bends() {
    problem_.bends_alike = false;
    problem_.prior.common_bend_per_mm.setZero();
    if (!stiff_) problem_.prior.bend_per_mm = problem_.prior.unseen_bend_per_mm = options_.prior.bend_per_mm;
  }

  void bend_alike(double scatter_ratio) {
    problem_.bends_alike = true;
    problem_.prior.bend_per_mm = std::min(1.0, kAlikeWiden * scatter_ratio) * options_.prior.bend_per_mm;
    problem_.settle();
  }

  /// Closer nodes would follow noise.
  void follow_alike() {
    weigh_unfollowed();
    bend_alike(problem_.scatter_ratio());
  }

  /// Nodes closer together beside the contours, as long as that is worth it.
  void choose_nodes() {
    while (fit_.usable() && went_finer()) {
    }
    if (fit_.usable()) weigh_unfollowed();
  }

  [[nodiscard]] double finer_mm() const { return fit_.basis->spacing_mm() / kFinerFactor; }

  [[nodiscard]] bool enough_points_for(double spacing_mm) const {
    return static_cast<double>(fit_.pairs) * spacing_mm * spacing_mm >=
           SurfaceProblem::kFewestPointsANode * problem_.ground.area_mm2;
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
    const std::vector<double> before =
        edge_slopes(cad_, *fit_.basis, problem_.ground.contours, fit_.shift_mm);
    return keep_finer_if([&] {
      if (shape && shape_left_mm(cell_mm) < kWorthRatio * left_mm) return true;
      return rms_difference(before, edge_slopes(cad_, *fit_.basis, problem_.ground.contours, fit_.shift_mm)) >
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
    const double points =
        static_cast<double>(fit_.pairs) * spacing_mm * spacing_mm / problem_.ground.area_mm2;
    return kSlopeSigmas / spacing_mm *
           std::hypot(fit_.sigma_mm / std::sqrt(points), std::sqrt(problem_.common_height().mean_mm2()));
  }

  /// Settles on nodes closer together; goes back where that was not worth it. True: it was, or is no fit.
  bool keep_finer_if(const std::function<bool()>& worth) {
    SurfaceGround finer = graded_ground(cad_, problem_.band_mm(), finer_mm(), options_.node_spacing_mm);
    if (finer.too_fine()) return false;
    const std::vector<Eigen::Vector3d> shift_mm = fit_.shift_mm;
    const std::vector<double> offset_mm = fit_.offset_mm;
    SurfaceGround coarser = problem_.ground;
    problem_.stand_on(std::move(finer));
    problem_.settle();
    if (!fit_.usable() || worth()) return true;
    problem_.stand_on(std::move(coarser));
    fit_.shift_mm = shift_mm;
    fit_.offset_mm = offset_mm;
    problem_.settle();
    return false;
  }

  /// Height of the shape that the nodes beside the contours do not follow.
  [[nodiscard]] double shape_left_mm(double cell_mm) const {
    return arris::shape_left_mm(problem_.pairs, cell_mm, problem_.gate_mm(),
                                kBesideRatio * fit_.basis->spacing_mm());
  }

  /// What the nodes do not follow counts against every point.
  void weigh_unfollowed() {
    const CommonHeight common = problem_.common_height();
    problem_.unfollowed_mm = problem_.shared_height_mm(common);
    fit_.unfollowed_mm2 =
        common.excess_mm2(fit_.shift_mm.size(), problem_.unfollowed_mm * problem_.unfollowed_mm);
    fit_.unfollowed_mean_mm2 = problem_.unfollowed_mm * problem_.unfollowed_mm;
    if (stiff_)  // a stiff field's covariance does not know of it
      fit_.unfollowed_mm2.assign(fit_.shift_mm.size(), fit_.unfollowed_mean_mm2);
    problem_.settle();
  }

  const CadModel& cad_;
  const ScanModel& scan_;
  const SurfaceOptions& options_;
  SurfaceProblem problem_;
  SurfaceFit& fit_ = problem_.fit;
  Eigen::MatrixXd doubt_mm2_;  // covariance of what may be owed to strays
  bool stiff_ = false;
};

}  // namespace

SurfaceFit refine_surface(const CadModel& cad, const ScanModel& scan, const RigidMotion& rigid_scan_from_cad,
                          const SurfaceOptions& options) {
  options.check();
  return SurfaceFitter(cad, scan, rigid_scan_from_cad, options).run();
}

}  // namespace arris
