#include "registration/edge_posterior.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "registration/surface_factor.hpp"

namespace arris {
namespace {

constexpr int kMostSweeps = 60;
constexpr double kDamping = 0.5;
constexpr double kSettledSds = 1e-3;  // moves of a mean that no longer matter
constexpr double kBalance = 0.3375;   // blurs: -log of a bound is 1 there, so that a hard edge is not biased
constexpr double kLeastShare = 1e-280;
constexpr double kLeastPrecision = 1e-9;

double normal_density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}
double normal_share(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// The message that gives a bound's mean and variance when the rest says N(mean_mm, variance_mm2) of g: by
/// the first two derivatives, by the mean, of the point's probability. What lies so far out that it is more
/// likely a stray pulls, but makes nothing certain.
EdgeMessage message_of(double mean_mm, double variance_mm2, double stray_ratio, const WallPoints& wall) {
  const double spread_mm = std::sqrt(variance_mm2 + kEdgeBlurMm * kEdgeBlurMm);
  const double z = (mean_mm - kBalance * kEdgeBlurMm) / spread_mm;
  const WallPoints spread_wall{wall.width_mm, std::sqrt(variance_mm2 + wall.sd_mm * wall.sd_mm)};
  const double wall_ratio = spread_wall.ratio(mean_mm), wall_z = mean_mm / spread_wall.sd_mm;
  const double share = normal_share(z) + stray_ratio + wall_ratio;
  double slope = -z / spread_mm, bend = 0.0;
  if (share > kLeastShare) {
    const double rise = normal_density(z) / spread_mm, wall_rise = -wall_ratio * wall_z / spread_wall.sd_mm;
    slope = (rise + wall_rise) / share;
    bend = slope * slope + (rise * z / spread_mm -
                            wall_ratio * (wall_z * wall_z - 1.0) / (spread_wall.sd_mm * spread_wall.sd_mm)) /
                               share;
  }
  EdgeMessage message;
  if (bend > 0.0) message.precision_per_mm2 = bend / std::max(kLeastPrecision, 1.0 - variance_mm2 * bend);
  message.pull_per_mm = slope + message.precision_per_mm2 * (mean_mm + variance_mm2 * slope);
  return message;
}

/// Mean and variance of each site's g under a fit and messages that differ from those in it.
class SiteMarginals {
 public:
  SiteMarginals(const SurfaceSystem& fit, const std::vector<EdgeSite>& sites) {
    const SurfaceFactor factor(fit);
    const Eigen::VectorXd move = -factor.solve(fit.gradient);
    const auto count = static_cast<Eigen::Index>(sites.size());
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(fit.gradient.size(), count);
    fit_mm_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const EdgeSite& site = sites[static_cast<std::size_t>(i)];
      fit.put(site.row, columns.col(i));
      fit_mm_[i] = site.inside_mm + fit.dot(site.row, move);
      in_fit_.push_back(site.message);
    }
    spread_mm2_ = factor.spread(std::move(columns));
    mean_mm = fit_mm_;
    variance_mm2 = spread_mm2_.diagonal();
  }

  void update(const std::vector<EdgeSite>& sites) {
    const Eigen::Index count = fit_mm_.size();
    Eigen::VectorXd precision(count), pull(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      precision[i] = sites[k].message.precision_per_mm2 - in_fit_[k].precision_per_mm2;
      pull[i] = sites[k].message.pull_per_mm - in_fit_[k].pull_per_mm;
    }
    Eigen::MatrixXd more = precision.asDiagonal() * spread_mm2_;
    more.diagonal().array() += 1.0;
    const Eigen::MatrixXd inverse = more.partialPivLu().inverse();
    mean_mm = fit_mm_ + spread_mm2_ * (inverse * (pull - precision.cwiseProduct(fit_mm_)));
    variance_mm2 = spread_mm2_.cwiseProduct(inverse.transpose()).rowwise().sum();
  }

  Eigen::VectorXd mean_mm, variance_mm2;

 private:
  Eigen::MatrixXd spread_mm2_;  // at the fit
  Eigen::VectorXd fit_mm_;
  std::vector<EdgeMessage> in_fit_;
};

}  // namespace

void pass_messages(const SurfaceSystem& fit, double stray_ratio, std::vector<EdgeSite>& sites) {
  SiteMarginals now(fit, sites);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    for (std::size_t k = 0; k < sites.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      EdgeMessage& message = sites[k].message;
      const double rest = 1.0 / now.variance_mm2[i] - message.precision_per_mm2;
      if (!(rest > kLeastPrecision)) continue;
      const double rest_mm = (now.mean_mm[i] / now.variance_mm2[i] - message.pull_per_mm) / rest;
      const EdgeMessage wanted = message_of(rest_mm, 1.0 / rest, stray_ratio, sites[k].wall);
      message.precision_per_mm2 += kDamping * (wanted.precision_per_mm2 - message.precision_per_mm2);
      message.pull_per_mm += kDamping * (wanted.pull_per_mm - message.pull_per_mm);
    }
    const Eigen::VectorXd before_mm = now.mean_mm;
    now.update(sites);
    if (((now.mean_mm - before_mm).array().abs() < kSettledSds * now.variance_mm2.array().abs().sqrt()).all())
      break;
  }
}

}  // namespace arris
