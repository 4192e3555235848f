#include "registration/edge_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "acquisition/geometry/median.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "registration/arc_bins.hpp"
#include "registration/carried_curve.hpp"
#include "registration/edge_support.hpp"
#include "registration/seen_bins.hpp"

namespace arris {
namespace {

constexpr double kStartTauMm = 2.0;
constexpr double kTauShrink = 0.6;
constexpr double kTauFloorMm = 0.03;
constexpr double kStrayShare = 0.02;  // of the density: points beyond the edge that are no edge at all
constexpr double kGateSigmas = 4.0;   // height residual of a point that takes part in the edge
constexpr int kRounds = 30;
constexpr double kEdgeLimitLengthMm = 50.0;  // an edge is known up to a smooth shift over about this length
constexpr double kGapBendPerMm = 5e-4;       // how much a part may bend between the two sides of a gap
constexpr double kNearRatio = 0.5;           // of the strip: how near to the fitted edge there must be points
constexpr double kChanceMargin =
    5.0;  // the longest of n random gaps exceeds log n + 5 means once in 150 times
constexpr std::size_t kFewestForGap = 8;  // points of a stretch that rows are looked for in
constexpr int kSeenPasses = 6;            // of finding the bins that show the edge, and the edge in them
constexpr std::size_t kChunk = 512;
constexpr double kSigmaOfMedian = 1.4826, kSigmaOfQuarter = 3.1383;  // of a normal error's size
constexpr double kMixedRatio = 0.5;  // sigmas by quarter and median that differ so much are of two surfaces

/// A scan point in the contour's own coordinates, CAD frame.
struct StripPoint {
  double arc_mm = 0.0;
  double across_mm = 0.0;     // into the material
  double height_mm = 0.0;     // signed distance to the CAD surface
  double curve_weight = 1.0;  // undoes the fan of a bent contour: area of the strip per length of the contour
  SplineRow row;
  bool inlier = true;
};

double variance_at(const SplineRow& row, const Eigen::MatrixXd& covariance) {
  double variance = 0.0;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      variance += row.value[a] * row.value[b] * covariance(row.index[a], row.index[b]);
  return std::max(0.0, variance);
}

/// Standard deviation by the median of the residuals' sizes; where most of them are of something else than
/// the surface (a clamp beside a hole), by their lower quarter.
double scale_of(std::vector<double> sizes) {
  const double by_median = kSigmaOfMedian * median_of(sizes),
               by_quarter = kSigmaOfQuarter * quantile_of(std::move(sizes), 0.25);
  return by_quarter < kMixedRatio * by_median ? by_quarter : by_median;
}

double unseen_bend_mm(double to_seen_mm) {
  return 0.5 * kGapBendPerMm * to_seen_mm * to_seen_mm;
}

class EdgeFitter {
 public:
  EdgeFitter(const CadModel& cad, std::size_t contour, const ScanModel& scan, const ContourMotion& motion,
             const EdgeFitOptions& options)
      : cad_(cad),
        contour_(contour),
        curve_(cad.contours[contour]),
        scan_(scan),
        motion_(motion),
        options_(options),
        fit_(ArcSpline(curve_.length_mm(), curve_.closed(), options.knot_mm)) {
    strip_mm_ = std::clamp(4.0 * scan.spacing_mm, 3.0, options.strip_mm);
    normal_strip_mm_ = std::clamp(6.0 * scan.spacing_mm, strip_mm_, options.normal_strip_mm);
  }

  EdgeFit run() {
    collect();
    fit_height();
    // Which bins show an edge depends on where it is, and the other way round: an edge that bending moved
    // into the material looks like a gap from where it was. From the bins that show it the fit grows along
    // it.
    for (int pass = 0; pass < kSeenPasses; ++pass) {
      const std::vector<char> before = fit_.seen;
      find_seen(pass == 0 ? strip_mm_ : kNearRatio * strip_mm_);
      if (fit_.seen == before) break;
      fit_across();
    }
    find_surface_beside();
    find_row_gaps();
    fit_.across.array() += options_.scanner.out_mm;  // the spline's weights sum to one
    fit_.scanner_sd_mm = options_.scanner.sd_mm;
    return std::move(fit_);
  }

 private:
  void collect() {
    const CarriedCurve carried(motion_);
    const double outside_mm = 2.0 * scan_.spacing_mm + 2.0;
    std::vector<StripPoint> all(scan_.points_mm.size());
    parallel_for(all.size(), kChunk, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        StripPoint& p = all[i];
        p.inlier = false;
        const std::optional<double> arc_mm =
            carried.arc_within(scan_.points_mm[i], normal_strip_mm_ + outside_mm);
        if (!arc_mm) continue;
        p.arc_mm = *arc_mm;
        place(i, p);
        p.inlier = p.across_mm > -outside_mm && p.across_mm < normal_strip_mm_ &&
                   std::abs(p.height_mm) < 3.0 * scan_.spacing_mm + options_.height_reach_mm;
      }
    });
    for (StripPoint& p : all)
      if (p.inlier) points_.push_back(p);
    for (StripPoint& p : points_) {
      p.row = fit_.spline.at(p.arc_mm);
      p.curve_weight = fan_weight(fan_per_mm(curve_, p.arc_mm), p.across_mm);
    }
  }

  void place(std::size_t i, StripPoint& p) const {
    const RigidMotion cad_from_scan = motion_.at(p.arc_mm).inverse();
    const Eigen::Vector3d x = cad_from_scan * scan_.points_mm[i];
    const Eigen::Vector3d from_contour = x - curve_.point_mm(p.arc_mm);
    const Eigen::Vector3d normal = curve_.normal(p.arc_mm);
    p.across_mm = from_contour.dot(normal.cross(curve_.tangent(p.arc_mm)).normalized());
    const SurfacePoint foot = cad_.surface.closest(x, normal_strip_mm_);
    const bool beside = foot.triangle < 0 || foot.on_border;
    p.height_mm = beside ? from_contour.dot(normal) : foot.normal.dot(x - foot.foot_mm);
  }

  /// Height and tilt: h(s, u) = a(s) + b(s) u over the strip, robust, in one linear system a round.
  void fit_height() {
    const int n = fit_.spline.size();
    fit_.height = Eigen::VectorXd::Zero(n);
    fit_.tilt = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    prior.topLeftCorner(n, n) = fit_.spline.bending(options_.bend_normal_per_mm);
    const double knot2 = fit_.spline.knot_mm() * fit_.spline.knot_mm();
    prior.bottomRightCorner(n, n) = fit_.spline.bending(options_.tilt_change_rad / knot2);
    prior.diagonal().tail(n).array() += 1.0 / (0.05 * 0.05);
    prior.diagonal().head(n).array() += 1.0 / (20.0 * 20.0);
    double sigma = options_.start_sigma_mm > 0.0 ? options_.start_sigma_mm : 0.5 + 0.2 * scan_.spacing_mm;
    Eigen::MatrixXd information;
    for (int round = 0; round < 8; ++round) {
      information = prior;
      Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * n);
      std::vector<double> sizes;
      for (const StripPoint& p : points_) {
        const double residual = p.height_mm - height_at(p);
        sizes.push_back(std::abs(residual));
        const double ratio2 = residual * residual / (9.0 * sigma * sigma);
        const double weight = 1.0 / ((1.0 + ratio2) * (1.0 + ratio2)) / (sigma * sigma);
        add_height_row(p, weight, information, right);
      }
      const Eigen::VectorXd solution = information.ldlt().solve(right);
      fit_.height = solution.head(n);
      fit_.tilt = solution.tail(n);
      sigma = std::max(scale_of(std::move(sizes)), 0.25 * scan_.noise_sigma_mm + 1e-4);
    }
    fit_.residual_sigma_mm = sigma;
    const Eigen::MatrixXd covariance = information.ldlt().solve(Eigen::MatrixXd::Identity(2 * n, 2 * n));
    fit_.height_covariance = covariance.topLeftCorner(n, n);
    fit_.tilt_covariance = covariance.bottomRightCorner(n, n);
    for (StripPoint& p : points_) {
      p.inlier = std::abs(p.height_mm - height_at(p)) < std::max(kGateSigmas * sigma, options_.gate_floor_mm);
      fit_.points += p.inlier ? 1 : 0;
    }
  }

  double height_at(const StripPoint& p) const {
    return p.row.dot(fit_.height) + p.row.dot(fit_.tilt) * std::max(0.0, p.across_mm);
  }

  void add_height_row(const StripPoint& p, double weight, Eigen::MatrixXd& information,
                      Eigen::VectorXd& right) const {
    const int n = fit_.spline.size();
    const double u = std::max(0.0, p.across_mm);
    std::array<int, 8> column{};
    std::array<double, 8> value{};
    for (std::size_t k = 0; k < 4; ++k) {
      column[k] = p.row.index[k], column[k + 4] = n + p.row.index[k];
      value[k] = p.row.value[k], value[k + 4] = u * p.row.value[k];
    }
    for (std::size_t a = 0; a < 8; ++a) {
      right[column[a]] += weight * value[a] * p.height_mm;
      for (std::size_t b = 0; b < 8; ++b) information(column[a], column[b]) += weight * value[a] * value[b];
    }
  }

  double inside_of_edge_mm(const StripPoint& p) const { return p.across_mm - p.row.dot(fit_.across); }

  /// Bins of the contour in which the scan shows material right up to the edge as fitted so far.
  void find_seen(double near_mm) {
    std::vector<BesidePoint> beside;
    double weight = 0.0;
    for (const StripPoint& p : points_) {
      const double inside_mm = inside_of_edge_mm(p);
      if (!p.inlier || inside_mm > strip_mm_) continue;
      beside.push_back({p.arc_mm, inside_mm, p.curve_weight});
      if (inside_mm > -scan_.spacing_mm) weight += p.curve_weight;
    }
    SeenBins found =
        find_seen_bins(beside, weight, {curve_.length_mm(), strip_mm_, near_mm, scan_.spacing_mm});
    fit_.bin_mm = found.bin_mm;
    fit_.seen = std::move(found.seen);
    fit_.density_per_mm2 = found.density_per_mm2;
  }

  /// Bins that hold no fewer points of the surface than chance leaves.
  void find_surface_beside() {
    std::vector<double> count(fit_.seen.size(), 0.0);
    for (const StripPoint& p : points_)
      if (p.inlier) ++count[arc_bin(p.arc_mm, fit_.bin_mm, count.size())];
    const double fewest = std::max(1.0, kEmptyBinRatio * median_of(count));
    fit_.beside.clear();
    for (const double points : count) fit_.beside.push_back(points >= fewest ? 1 : 0);
  }

  /// Bins where rows of points run along the edge: it may be anywhere from the last row to where the next
  /// would be. Counted from the fitted edge inward, the points of a stretch then leave a gap that chance does
  /// not leave.
  void find_row_gaps() {
    const std::size_t bins = fit_.seen.size();
    std::vector<std::vector<double>> inside_mm(bins);
    for (const StripPoint& p : points_)
      if (p.inlier && fit_.seen_at(p.arc_mm))
        inside_mm[arc_bin(p.arc_mm, fit_.bin_mm, bins)].push_back(inside_of_edge_mm(p));
    auto reach = static_cast<int>(0.5 * kEdgeLimitLengthMm / fit_.bin_mm);
    if (curve_.closed()) reach = std::min(reach, (static_cast<int>(bins) - 1) / 2);  // each bin once
    fit_.row_gap_mm.assign(bins, 0.0);
    for (std::size_t b = 0; b < bins; ++b) {
      std::vector<double> window_mm;
      for (int k = -reach; k <= reach; ++k) {
        const int at = static_cast<int>(b) + k, count = static_cast<int>(bins);
        if (!curve_.closed() && (at < 0 || at >= count)) continue;
        const std::vector<double>& add = inside_mm[static_cast<std::size_t>((at + count) % count)];
        window_mm.insert(window_mm.end(), add.begin(), add.end());
      }
      fit_.row_gap_mm[b] = unlikely_gap_mm(std::move(window_mm));
    }
  }

  /// The longest gap that begins in the strip (a stray beyond the edge begins none), if points in random
  /// places would hardly leave it; else 0.
  [[nodiscard]] double unlikely_gap_mm(std::vector<double> inside_mm) const {
    if (inside_mm.size() < kFewestForGap) return 0.0;
    std::sort(inside_mm.begin(), inside_mm.end());
    const double count = static_cast<double>(inside_mm.size());
    const double mean_gap_mm = normal_strip_mm_ / count;
    double gap_mm = 0.0;
    for (std::size_t i = 1; i < inside_mm.size() && inside_mm[i - 1] < strip_mm_; ++i)
      if (inside_mm[i - 1] > -2.0 * mean_gap_mm) gap_mm = std::max(gap_mm, inside_mm[i] - inside_mm[i - 1]);
    return gap_mm > (std::log(count) + kChanceMargin) * mean_gap_mm ? gap_mm : 0.0;
  }

  /// Newton on the one-sided potential, tau shrinking from kStartTauMm to 1 / (density * knot).
  void fit_across() {
    const int n = fit_.spline.size();
    fit_.across = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd prior = fit_.spline.bending(options_.bend_across_per_mm);
    const double far_mm = 3.0 * scan_.spacing_mm + 2.0;
    prior.diagonal().array() += 1.0 / (far_mm * far_mm);
    const double tau_end =
        std::max(kTauFloorMm, 1.0 / std::max(1e-9, 1.5 * fit_.density_per_mm2 * fit_.spline.knot_mm()));
    std::vector<const StripPoint*> active;
    for (const StripPoint& p : points_)
      if (p.inlier && fit_.seen_at(p.arc_mm)) active.push_back(&p);
    Eigen::MatrixXd curvature;
    for (double tau = std::max(kStartTauMm, 0.5 * scan_.spacing_mm);;
         tau = std::max(tau_end, tau * kTauShrink)) {
      const bool last = tau <= tau_end * 1.0001;
      for (int round = 0; round < (last ? kRounds : 4); ++round)
        if (newton_step(active, prior, tau, curvature) < 1e-4) break;
      if (last) break;
    }
    fit_.across_covariance = curvature.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  }

  double newton_step(const std::vector<const StripPoint*>& active, const Eigen::MatrixXd& prior, double tau,
                     Eigen::MatrixXd& curvature) {
    curvature = prior;
    Eigen::VectorXd gradient = prior * fit_.across;
    const EdgeSupport support{tau, strip_mm_, kStrayShare};
    for (const StripPoint* p : active) {
      const EdgeSupport::Pull pull = support.at(inside_of_edge_mm(*p));
      const double slope = p->curve_weight * pull.slope_per_mm;
      const double bend = p->curve_weight * pull.curvature_per_mm2;
      for (std::size_t a = 0; a < 4; ++a) {
        gradient[p->row.index[a]] -= slope * p->row.value[a];
        for (std::size_t b = 0; b < 4; ++b)
          curvature(p->row.index[a], p->row.index[b]) += bend * p->row.value[a] * p->row.value[b];
      }
    }
    const Eigen::VectorXd step = curvature.ldlt().solve(gradient);
    fit_.across -= step;
    return step.cwiseAbs().maxCoeff();
  }

  const CadModel& cad_;
  std::size_t contour_;
  const Curve& curve_;
  const ScanModel& scan_;
  const ContourMotion& motion_;
  const EdgeFitOptions& options_;
  EdgeFit fit_;
  std::vector<StripPoint> points_;
  double strip_mm_ = 0.0, normal_strip_mm_ = 0.0;
};

}  // namespace

EdgeFit::EdgeFit(const ArcSpline& along) : spline(along) {
  const int n = spline.size();
  across = height = tilt = Eigen::VectorXd::Zero(n);
  across_covariance = height_covariance = tilt_covariance = Eigen::MatrixXd::Zero(n, n);
}

bool EdgeFit::seen_at(double arc_mm) const {
  return !seen.empty() && seen[arc_bin(arc_mm, bin_mm, seen.size())] != 0;
}

double EdgeFit::row_gap_at_mm(double arc_mm) const {
  if (row_gap_mm.empty()) return 0.0;
  const double bin = std::max(0.0, arc_mm / bin_mm);
  return row_gap_mm[std::min(row_gap_mm.size() - 1, static_cast<std::size_t>(bin))];
}

double EdgeFit::to_seen_mm(double arc_mm, bool closed) const {
  if (seen.empty() || seen_at(arc_mm)) return 0.0;
  const double length_mm = bin_mm * static_cast<double>(seen.size());
  double nearest_mm = length_mm;
  for (std::size_t b = 0; b < seen.size(); ++b) {
    if (!seen[b]) continue;
    const double begin_mm = bin_mm * static_cast<double>(b);
    for (const double turn_mm : {0.0, length_mm, -length_mm}) {
      if (turn_mm != 0.0 && !closed) continue;
      nearest_mm =
          std::min(nearest_mm, std::max(begin_mm + turn_mm - arc_mm, arc_mm - begin_mm - turn_mm - bin_mm));
    }
  }
  return std::max(0.0, nearest_mm);
}

double EdgeFit::edge_limit_mm() const {
  return 1.0 / (kEdgeLimitLengthMm * std::max(density_per_mm2, 1e-9));
}

double EdgeFit::sd_across_mm(double arc_mm, bool closed) const {
  const double gap_mm = unseen_bend_mm(to_seen_mm(arc_mm, closed));
  const double limit_mm = std::max(edge_limit_mm(), row_gap_at_mm(arc_mm) / std::sqrt(12.0));
  return std::sqrt(variance_at(spline.at(arc_mm), across_covariance) + limit_mm * limit_mm + gap_mm * gap_mm +
                   scanner_sd_mm * scanner_sd_mm);
}

double EdgeFit::sd_height_mm(double arc_mm, bool closed) const {
  const double gap_mm = unseen_bend_mm(to_seen_mm(arc_mm, closed));
  return std::sqrt(variance_at(spline.at(arc_mm), height_covariance) + gap_mm * gap_mm);
}

double EdgeFit::sd_tilt_rad(double arc_mm) const {
  return std::sqrt(variance_at(spline.at(arc_mm), tilt_covariance));
}

double EdgeFit::seen_ratio() const {
  if (seen.empty()) return 0.0;
  return static_cast<double>(std::count(seen.begin(), seen.end(), 1)) / static_cast<double>(seen.size());
}

EdgeFit fit_edge(const CadModel& cad, std::size_t contour, const ScanModel& scan, const ContourMotion& motion,
                 const EdgeFitOptions& options) {
  return EdgeFitter(cad, contour, scan, motion, options).run();
}

Eigen::Vector3d edge_point_mm(const CadModel& cad, std::size_t contour, const ContourMotion& motion,
                              const EdgeFit& fit, double arc_mm) {
  const Curve& curve = cad.contours[contour];
  const SplineRow row = fit.spline.at(arc_mm);
  return motion.at(arc_mm) * (curve.point_mm(arc_mm) + row.dot(fit.across) * cad.inward(contour, arc_mm) +
                              row.dot(fit.height) * curve.normal(arc_mm));
}

}  // namespace arris
