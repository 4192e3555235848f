#include "registration/rigid_icp.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/geometry/rigid_fit.hpp"
#include "acquisition/types/error.hpp"
#include "registration/edge_pairs.hpp"
#include "registration/normal_equations.hpp"

namespace arris {
namespace {

constexpr double kSurfaceCountsAsPoints = 100.0;  // correlated misfit: see icp_point_to_plane
constexpr double kCosNormalsAgree = 0.5;          // correspondences need normals within 60 degrees
constexpr double kAnneal = 0.7;                   // robust scale of the next round over this one
constexpr double kDamping = 1e-4;                 // of the largest eigenvalue
constexpr double kFreeEigenvalueRatio = 1e-4;     // of the largest: a direction that the data leave free
constexpr double kStretchMm = 80.0;               // of contour: misfit farther apart counts as independent
constexpr double kFewestStretches = 8.0, kMostStretches = 24.0;
constexpr double kStillMm = 1e-4;
constexpr std::size_t kLongestCycle = 6;  // rounds: partners may flip to and fro for ever
constexpr std::size_t kChunk = 256;

/// Scan points that can belong to the band around the contours at the start pose, thinned to a fixed count.
std::vector<std::size_t> band_sample(const CadModel& cad, const ScanModel& scan,
                                     const RigidMotion& cad_from_scan, const RigidIcpOptions& options) {
  std::vector<char> in_band(scan.points_mm.size(), 0);
  const double reach_mm = options.band_mm + options.start_scale_mm;
  parallel_for(scan.points_mm.size(), 4 * kChunk, options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      in_band[i] = near_contours(cad, cad_from_scan * scan.points_mm[i], reach_mm) ? 1 : 0;
  });
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < in_band.size(); ++i)
    if (in_band[i]) chosen.push_back(i);
  const std::size_t limit = static_cast<std::size_t>(options.surface_points);
  if (chosen.size() <= limit) return chosen;
  std::vector<std::size_t> thinned(limit);
  for (std::size_t i = 0; i < limit; ++i) thinned[i] = chosen[i * chosen.size() / limit];
  return thinned;
}

/// One scan point against the CAD: direction and signed residual; weight 0 when it is no partner.
struct Residual {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double value_mm = 0.0;
  std::int32_t triangle = -1;
  bool valid = false;
};

Residual surface_residual(const CadModel& cad, const ScanModel& scan, std::size_t i,
                          const RigidMotion& cad_from_scan, double reach_mm, std::int32_t hint) {
  Residual residual;
  residual.x = cad_from_scan * scan.points_mm[i];
  const SurfacePoint foot = cad.surface.closest(residual.x, reach_mm, hint);
  residual.triangle = foot.triangle;
  if (foot.triangle < 0 || foot.on_border) return residual;
  const double agree = foot.normal.dot(cad_from_scan.linear() * scan.normals[i]);
  if ((scan.side == SideKnown::kYes ? agree : std::abs(agree)) < kCosNormalsAgree) return residual;
  residual.direction = foot.normal;
  residual.value_mm = foot.normal.dot(residual.x - foot.foot_mm);
  residual.valid = true;
  return residual;
}

struct Round {
  NormalEquations surface, edge;
  std::size_t pairs = 0;
};

class PointToPlane {
 public:
  PointToPlane(const CadModel& cad, const ScanModel& scan, std::span<const Eigen::Vector3d> edge_mm,
               const RigidIcpOptions& options, const RigidMotion& start)
      : cad_(cad), scan_(scan), edge_mm_(edge_mm), options_(options), cad_from_scan_(start.inverse()) {
    sample_ = band_sample(cad, scan, cad_from_scan_, options);
    scale_mm_ = options.start_scale_mm;
    for (const Curve& curve : cad.contours)
      for (const Eigen::Vector3d& p : curve.contour().points_mm)
        pivot_ += p / double(curve.contour().points_mm.size());
    pivot_ /= std::max<double>(1.0, double(cad.contours.size()));
  }

  RigidIcpResult run() {
    RigidIcpResult result;
    double last_rms = 1e300;
    for (int k = 0; k < options_.max_iterations; ++k) {
      const Round round = accumulate();
      result.iterations = k + 1;
      result.pairs = round.pairs;
      if (round.edge.weight + round.surface.weight < 6.0) {
        result.reason = "fewer than 6 scan points find a partner on the CAD";
        return result;
      }
      fill(result, round);
      const double moved_mm = step(round);
      const bool scale_settled = scale_mm_ <= floor_mm_ * 1.001;
      const double change = std::abs(last_rms - result.rms_mm) / std::max(result.rms_mm, 1e-9);
      if (scale_settled && (change < options_.stop_change_ratio || moved_mm < kStillMm || comes_back())) {
        result.stop = "converged";
        break;
      }
      last_rms = result.rms_mm;
      scale_mm_ = std::max(floor_mm_, scale_mm_ * kAnneal);
      result.stop = "iteration limit";
    }
    result.scan_from_cad = cad_from_scan_.inverse();
    result.pivot_mm = pivot_;
    if (options_.with_covariance) result.covariance = covariance();
    if (!cad_from_scan_.matrix().allFinite()) result.reason = "the fit did not stay finite";
    return result;
  }

 private:
  void find_partners() {
    surface_.resize(sample_.size());
    edges_.resize(edge_mm_.size());
    const double reach_mm = 3.0 * scale_mm_ + scan_.spacing_mm;
    parallel_for(sample_.size(), kChunk, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        surface_[i] =
            surface_residual(cad_, scan_, sample_[i], cad_from_scan_, reach_mm, surface_[i].triangle);
    });
    parallel_for(edges_.size(), kChunk, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        edges_[i] = pair_edge(cad_, cad_from_scan_ * edge_mm_[i], reach_mm, edges_[i]);
    });
  }

  /// What one surface point counts.
  [[nodiscard]] double surface_share() const {
    const auto valid = std::count_if(surface_.begin(), surface_.end(), [](const auto& r) { return r.valid; });
    return kSurfaceCountsAsPoints / std::max(1.0, static_cast<double>(valid));
  }

  Round accumulate() {
    find_partners();
    Round round;
    std::vector<double> sizes;
    const double share = surface_share();
    for (const Residual& r : surface_) {
      if (!r.valid) continue;
      round.surface.add(r.x - pivot_, r.direction, r.value_mm, share * weight(r.value_mm * r.value_mm));
      ++round.pairs;
    }
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const EdgePair& e = edges_[i];
      if (e.contour < 0) continue;
      const double size2 = e.across_mm * e.across_mm + e.normal_mm * e.normal_mm;
      const double w = weight(size2);
      const Eigen::Vector3d x = cad_from_scan_ * edge_mm_[i] - pivot_;
      round.edge.add(x, e.across, e.across_mm, w);
      round.edge.add(x, e.normal, e.normal_mm, w);
      sizes.push_back(std::sqrt(size2));
      ++round.pairs;
    }
    floor_mm_ = std::max(2.0 * scan_.spacing_mm, 3.0 * 1.4826 * median_of(std::move(sizes)));
    return round;
  }

  double weight(double residual2) const {
    return options_.robust ? geman_mcclure_weight(residual2, scale_mm_) : 1.0;
  }

  void fill(RigidIcpResult& result, const Round& round) const {
    NormalEquations both = round.surface;
    both += round.edge;
    const auto rms = [](const NormalEquations& e) {
      return e.weight > 0 ? std::sqrt(e.cost / e.weight) : 0.0;
    };
    result.rms_mm = rms(both);
    result.surface_rms_mm = rms(round.surface);
    result.edge_rms_mm = rms(round.edge) * std::sqrt(2.0);  // two rows a point
    result.information = both.information;
  }

  /// Pull on the pose, stretch by stretch of the contours, at the pose found.
  [[nodiscard]] std::vector<NormalEquations> pull_of_stretches() const {
    std::vector<std::size_t> first = {0};
    std::vector<double> stretch_mm;
    for (const Curve& curve : cad_.contours) {
      const double count = std::clamp(curve.length_mm() / kStretchMm, kFewestStretches, kMostStretches);
      stretch_mm.push_back(curve.length_mm() / std::floor(count));
      first.push_back(first.back() + static_cast<std::size_t>(count));
    }
    std::vector<NormalEquations> pull(first.back());
    const auto of = [&](const EdgePair& pair) -> NormalEquations& {
      const auto c = static_cast<std::size_t>(pair.contour);
      return pull[std::min(first[c + 1] - 1,
                           first[c] + static_cast<std::size_t>(pair.foot.arc_mm / stretch_mm[c]))];
    };
    const double share = surface_share();
    for (const Residual& r : surface_) {
      if (!r.valid) continue;
      of(pair_edge(cad_, r.x, 1e9))
          .add(r.x - pivot_, r.direction, r.value_mm, share * weight(r.value_mm * r.value_mm));
    }
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const EdgePair& e = edges_[i];
      if (e.contour < 0) continue;
      const double w = weight(e.across_mm * e.across_mm + e.normal_mm * e.normal_mm);
      const Eigen::Vector3d x = cad_from_scan_ * edge_mm_[i] - pivot_;
      of(e).add(x, e.across, e.across_mm, w);
      of(e).add(x, e.normal, e.normal_mm, w);
    }
    return pull;
  }

  /// Information^-1 * scatter of the pulls * information^-1 (a sandwich over clusters: Liang and Zeger,
  /// Biometrika 73, 1986), where the data determine the motion.
  [[nodiscard]] Eigen::Matrix<double, 6, 6> covariance() {
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    find_partners();
    const std::vector<NormalEquations> pull = pull_of_stretches();
    NormalEquations all;
    for (const NormalEquations& one : pull) all += one;
    const Eigen::Matrix<double, 6, 1> scale = turn_scale(all);
    const double count = static_cast<double>(pull.size());
    Matrix6 scatter = Matrix6::Zero();
    for (const NormalEquations& one : pull) {
      const Eigen::Matrix<double, 6, 1> off = one.gradient - all.gradient / count;
      scatter +=
          count / (count - 2.0) * off * off.transpose();  // a stretch gives three numbers, the pose takes 6
    }
    const Determined known = determined(all.information, 1.0 / scale[0]);
    return known.inverse * scatter * known.inverse + known.free;
  }

  /// Makes a turn count by what it moves.
  static Eigen::Matrix<double, 6, 1> turn_scale(const NormalEquations& both) {
    const double reach_mm =
        std::sqrt(both.information.topLeftCorner<3, 3>().trace() / (2.0 * both.weight + 1e-12)) + 1e-6;
    Eigen::Matrix<double, 6, 1> scale;
    scale << Eigen::Vector3d::Constant(1.0 / reach_mm), Eigen::Vector3d::Ones();
    return scale;
  }

  /// Moves cad_from_scan by one damped Gauss-Newton step, but not along directions that the data leave free:
  /// there the gradient is noise over nothing, and a circle would spin about its axis by degrees a round.
  double step(const Round& round) {
    NormalEquations both = round.surface;
    both += round.edge;
    const Eigen::Matrix<double, 6, 1> scale = turn_scale(both);
    const Eigen::Matrix<double, 6, 6> scaled = scale.asDiagonal() * both.information * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(scaled);
    const Eigen::Matrix<double, 6, 1> gradient =
        eigen.eigenvectors().transpose() * scale.cwiseProduct(both.gradient);
    Eigen::Matrix<double, 6, 1> along = Eigen::Matrix<double, 6, 1>::Zero();
    const double largest = eigen.eigenvalues()[5];
    for (int i = 0; i < 6; ++i)
      if (eigen.eigenvalues()[i] > kFreeEigenvalueRatio * largest)
        along[i] = -gradient[i] / (eigen.eigenvalues()[i] + kDamping * largest);
    const Eigen::Matrix<double, 6, 1> delta = scale.cwiseProduct(eigen.eigenvectors() * along);
    cad_from_scan_ = motion_of(delta, pivot_) * cad_from_scan_;
    reach_mm_ = 1.0 / scale[0];
    return delta.tail<3>().norm() + delta.head<3>().norm() * reach_mm_;
  }

  /// Whether the motion is again that of some rounds before: then the rounds between repeat for ever.
  [[nodiscard]] bool comes_back() {
    const bool again = std::any_of(past_.begin(), past_.end(), [&](const RigidMotion& past) {
      const RigidMotion since = cad_from_scan_ * past.inverse();
      const Eigen::Matrix3d turn = since.linear() - Eigen::Matrix3d::Identity();
      return (since * pivot_ - pivot_).norm() + reach_mm_ * turn.norm() < kStillMm;
    });
    past_.push_back(cad_from_scan_);
    if (past_.size() > kLongestCycle) past_.erase(past_.begin());
    return again;
  }

  const CadModel& cad_;
  const ScanModel& scan_;
  std::span<const Eigen::Vector3d> edge_mm_;
  const RigidIcpOptions& options_;
  RigidMotion cad_from_scan_;
  std::vector<RigidMotion> past_;  // of the last rounds
  double reach_mm_ = 0.0;          // what a turn of 1 rad moves
  Eigen::Vector3d pivot_ = Eigen::Vector3d::Zero();
  std::vector<std::size_t> sample_;
  std::vector<Residual> surface_;  // of sample_
  std::vector<EdgePair> edges_;    // of edge_mm_
  double scale_mm_ = 0.0, floor_mm_ = 0.0;
};

}  // namespace

Determined determined(const Eigen::Matrix<double, 6, 6>& information, double reach_mm) {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  Eigen::Matrix<double, 6, 1> scale;
  scale << Eigen::Vector3d::Constant(1.0 / reach_mm), Eigen::Vector3d::Ones();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(
      Matrix6(scale.asDiagonal() * information * scale.asDiagonal()));
  Eigen::Matrix<double, 6, 1> inverse = Eigen::Matrix<double, 6, 1>::Zero(), free = inverse;
  for (int i = 0; i < 6; ++i) {
    if (eigen.eigenvalues()[i] > kFreeEigenvalueRatio * eigen.eigenvalues()[5])
      inverse[i] = 1.0 / eigen.eigenvalues()[i];
    else
      free[i] = reach_mm * reach_mm;
  }
  const Matrix6 v = scale.asDiagonal() * eigen.eigenvectors();
  return {v * inverse.asDiagonal() * v.transpose(), v * free.asDiagonal() * v.transpose()};
}

void RigidIcpOptions::check() const {
  if (max_iterations < 1 || max_iterations > 10000)
    throw Error(Fault::kRecipe, {.what = "registration.max_iterations is out of range",
                                 .found = std::to_string(max_iterations),
                                 .needed = "1 to 10000"});
  if (!(stop_change_ratio > 0.0 && stop_change_ratio < 1.0))
    throw Error(Fault::kRecipe, {.what = "registration.stop_change is out of range",
                                 .found = std::to_string(stop_change_ratio),
                                 .needed = "between 0 and 1"});
}

RigidIcpResult icp_point_to_point(std::span<const Eigen::Vector3d> model_mm, const NearestPoints& data,
                                  std::span<const Eigen::Vector3d> data_mm,
                                  const RigidMotion& start_scan_from_cad, const RigidIcpOptions& options) {
  options.check();
  RigidIcpResult result;
  result.scan_from_cad = start_scan_from_cad;
  if (data.size() == 0 || model_mm.size() < 3) {
    result.reason = "no contour points to match";
    return result;
  }
  std::vector<Eigen::Vector3d> partner(model_mm.size());
  double last_rms = 1e300;
  result.stop = "iteration limit";
  for (int k = 0; k < options.max_iterations; ++k) {
    for (std::size_t i = 0; i < model_mm.size(); ++i)
      partner[i] = data_mm[static_cast<std::size_t>(data.nearest(result.scan_from_cad * model_mm[i]).index)];
    const RigidFit fit =
        fit_rigid(model_mm, partner);  // from the model itself: the motions compose by themselves
    if (!fit.usable()) {
      result.reason = fit.reason;
      return result;
    }
    result.scan_from_cad = fit.to_from;
    result.rms_mm = result.edge_rms_mm = fit.rms_mm;
    result.iterations = k + 1;
    result.pairs = model_mm.size();
    if (std::abs(last_rms - fit.rms_mm) <= options.stop_change_ratio * fit.rms_mm) {
      result.stop = "converged";
      break;
    }
    last_rms = fit.rms_mm;
  }
  return result;
}

RigidIcpResult icp_point_to_plane(const CadModel& cad, const ScanModel& scan,
                                  const RigidMotion& start_scan_from_cad, const RigidIcpOptions& options) {
  return icp_point_to_plane(cad, scan, scan.edge_mm, start_scan_from_cad, options);
}

RigidIcpResult icp_point_to_plane(const CadModel& cad, const ScanModel& scan,
                                  std::span<const Eigen::Vector3d> edge_mm,
                                  const RigidMotion& start_scan_from_cad, const RigidIcpOptions& options) {
  options.check();
  return PointToPlane(cad, scan, edge_mm, options, start_scan_from_cad).run();
}

}  // namespace arris
