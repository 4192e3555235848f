#include "registration/whole_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/curve_order.hpp"
#include "acquisition/geometry/evenly_drawn.hpp"
#include "acquisition/geometry/median.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "registration/coarse_align.hpp"
#include "registration/normal_equations.hpp"

namespace arris {
namespace {

constexpr double kAnneal = 0.5;       // robust scale of the next round over this one
constexpr double kScaleSigmas = 3.0;  // its end, in robust standard deviations of the residuals
constexpr double kSmallestScaleMm = 1e-6;
constexpr double kReachScales = 3.0;
constexpr double kFewSettledMm = 0.05, kManySettledMm = 2e-3;  // a step this small ends the few, the many
constexpr int kMostFew = 60, kMostMany = 30;
constexpr double kFreeRatio =
    1e-4;  // of the largest eigenvalue, as in rigid ICP: held too badly to be moved along
constexpr int kMostRefills = 3;
constexpr double kRefillMargin = 1.2;
constexpr double kFewestPartnersRatio = 0.1;
constexpr double kFewestPartners = 6.0;
constexpr std::size_t kChunk = 512;

/// Points drawn evenly from the scan, in an order that has neighbours together.
std::vector<Eigen::Vector3d> drawn(std::span<const Eigen::Vector3f> points_mm, std::size_t count) {
  std::vector<Eigen::Vector3f> chosen;
  for (const std::size_t i : evenly_drawn(points_mm.size(), count)) chosen.push_back(points_mm[i]);
  std::vector<Eigen::Vector3d> ordered;
  for (const std::uint32_t i : curve_order(chosen, 1)) ordered.push_back(chosen[i].cast<double>());
  return ordered;
}

class WholeFitter {
 public:
  WholeFitter(const SurfaceQuery& cad, const RigidMotion& start, const WholeFitOptions& options)
      : cad_(cad), options_(options), cad_from_scan_(start.inverse()), scale_mm_(options.start_scale_mm) {}

  /// Rounds with these points until the step is small and the scale has come down.
  void settle(std::vector<Eigen::Vector3d> points_mm, double settled_mm, int most_rounds, WholeFit& result) {
    points_mm_ = std::move(points_mm);
    feet_.assign(points_mm_.size(), {});
    result.points = points_mm_.size();
    for (int round = 0; round < most_rounds; ++round, ++result.rounds) {
      const NormalEquations equations = accumulate(result);
      if (!result.usable()) return;
      const bool scale_is_down = scale_mm_ <= floor_mm_ * 1.001;
      const double moved_mm = step(equations);
      scale_mm_ = std::max(floor_mm_, kAnneal * scale_mm_);
      if (scale_is_down && moved_mm < settled_mm) return;
    }
    result.reason = "the fit of the whole scan does not settle: it still moves after " +
                    std::to_string(most_rounds) + " rounds";
  }

  void tell(WholeFit& result) const {
    result.scan_from_cad = cad_from_scan_.inverse();
    result.sd_mm = sd_mm_;
    result.free_directions = free_directions(held_, pivot_mm_, reach_mm_);
    if (result.usable() && !cad_from_scan_.matrix().allFinite())
      result.reason = "the fit did not stay finite";
  }
  [[nodiscard]] double sd_mm() const { return sd_mm_; }

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;

  struct Row {
    Eigen::Vector3d x_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double residual_mm = 0.0;
    std::int32_t triangle = -1;  // of the round before too: where the search begins
    bool valid = false;
  };

  void find_feet() {
    const double reach_mm = kReachScales * scale_mm_;
    parallel_for(points_mm_.size(), kChunk, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Row& row = feet_[i];
        row.x_mm = cad_from_scan_ * points_mm_[i];
        const SurfacePoint foot = cad_.closest(row.x_mm, reach_mm, row.triangle);
        row.triangle = foot.triangle;
        row.valid = foot.triangle >= 0 && !foot.on_border;
        row.normal = foot.normal;
        row.residual_mm = foot.normal.dot(row.x_mm - foot.foot_mm);
      }
    });
  }

  NormalEquations accumulate(WholeFit& result) {
    find_feet();
    std::vector<double> sizes_mm;
    Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
    double partners = 0.0;
    for (const Row& row : feet_) {
      if (row.valid) {
        sum_mm += row.x_mm;
        ++partners;
        sizes_mm.push_back(std::abs(row.residual_mm));
      } else if (row.triangle < 0) {  // else the scale would shrink to the few places where a bent part fits
        sizes_mm.push_back(kReachScales * scale_mm_);
      }
    }
    result.partner_ratio = partners / std::max(1.0, static_cast<double>(feet_.size()));
    if (partners < kFewestPartners || result.partner_ratio < kFewestPartnersRatio) {
      result.reason = std::to_string(static_cast<std::size_t>(partners)) + " of " +
                      std::to_string(feet_.size()) + " scan points lie near the drawing's surface";
      return {};
    }
    pivot_mm_ = sum_mm / partners;
    NormalEquations equations;
    double spread2_mm2 = 0.0;
    for (const Row& row : feet_) {
      if (!row.valid) continue;
      const double weight = geman_mcclure_weight(row.residual_mm * row.residual_mm, scale_mm_);
      equations.add(row.x_mm - pivot_mm_, row.normal, row.residual_mm, weight);
      spread2_mm2 += (row.x_mm - pivot_mm_).squaredNorm();
    }
    reach_mm_ = std::sqrt(spread2_mm2 / partners) + 1e-6;
    result.rms_mm = equations.weight > 0.0 ? std::sqrt(equations.cost / equations.weight) : 0.0;
    floor_mm_ = std::clamp(kScaleSigmas * 1.4826 * median_of(std::move(sizes_mm)), kSmallestScaleMm,
                           options_.start_scale_mm);
    return equations;
  }

  /// One Gauss-Newton step, not along what the surface leaves free; returns what it moves.
  double step(const NormalEquations& equations) {
    Vector6 scale;
    scale << Eigen::Vector3d::Constant(1.0 / reach_mm_), Eigen::Vector3d::Ones();  // a turn by what it moves
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(
        Matrix6(scale.asDiagonal() * equations.information * scale.asDiagonal()));
    const Vector6 pull = eigen.eigenvectors().transpose() * scale.cwiseProduct(equations.gradient);
    Vector6 along = Vector6::Zero(), held = Vector6::Zero();
    double least = eigen.eigenvalues()[5];
    for (int i = 5; i >= 0 && eigen.eigenvalues()[i] > kFreeRatio * eigen.eigenvalues()[5]; --i) {
      least = eigen.eigenvalues()[i];
      along[i] = -pull[i] / least;
      held[i] = 1.0;
    }
    sd_mm_ = std::sqrt(equations.cost / equations.weight / least);
    const Matrix6 back = scale.cwiseInverse().asDiagonal() * eigen.eigenvectors();
    held_ = back * held.asDiagonal() * back.transpose();
    Vector6 delta = scale.cwiseProduct(eigen.eigenvectors() * along);
    const double moved_mm = delta.tail<3>().norm() + delta.head<3>().norm() * reach_mm_;
    // A step beyond what the start may be off by follows the misfit of a bent part, not the pose.
    if (moved_mm > options_.start_scale_mm) delta *= options_.start_scale_mm / moved_mm;
    cad_from_scan_ = motion_of(delta, pivot_mm_) * cad_from_scan_;
    return moved_mm;
  }

  const SurfaceQuery& cad_;
  const WholeFitOptions& options_;
  RigidMotion cad_from_scan_;
  std::vector<Eigen::Vector3d> points_mm_;
  std::vector<Row> feet_;           // of points_mm_
  Matrix6 held_ = Matrix6::Zero();  // information of 1 in what the surface holds, 0 in what it leaves free
  Eigen::Vector3d pivot_mm_ = Eigen::Vector3d::Zero();
  double sd_mm_ = 0.0, reach_mm_ = 1.0, scale_mm_, floor_mm_ = 0.0;
};

}  // namespace

WholeFit fit_whole(const SurfaceQuery& cad, std::span<const Eigen::Vector3f> points_mm,
                   const RigidMotion& start_scan_from_cad, const WholeFitOptions& options) {
  WholeFit result;
  WholeFitter fitter(cad, start_scan_from_cad, options);
  fitter.settle(drawn(points_mm, static_cast<std::size_t>(options.few_points)), kFewSettledMm, kMostFew,
                result);
  auto count = static_cast<double>(options.many_points);
  for (int refill = 0; refill < kMostRefills && result.usable(); ++refill) {
    fitter.settle(drawn(points_mm, static_cast<std::size_t>(count)), kManySettledMm, kMostMany, result);
    const double lacking = fitter.sd_mm() / options.wanted_sd_mm;
    if (lacking <= 1.0 || result.points >= points_mm.size()) break;
    count = std::min(static_cast<double>(points_mm.size()), count * kRefillMargin * lacking * lacking);
  }
  fitter.tell(result);
  return result;
}

}  // namespace arris
