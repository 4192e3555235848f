#include "registration/bend_evidence.hpp"

#include <cmath>
#include <limits>

#include "registration/surface_factor.hpp"

namespace arris {
namespace {

constexpr double kStep = 1.5;
constexpr int kMostSteps = 11;  // to a hundredth

/// Logarithm of the probability of the scan, up to a constant: of the fit's quadratic form over all fields,
/// against that of the priors alone.
double log_evidence(const FitParts& parts, double scatter_ratio) {
  const double times = 1.0 / (scatter_ratio * scatter_ratio);
  SurfaceSystem prior = parts.other_priors;
  prior.add(parts.bends, times);
  SurfaceSystem fit = prior;
  fit += parts.data;
  parts.common.take_out_of(prior, times);
  parts.common.take_out_of(fit, times);
  const SurfaceFactor prior_factor(prior), fit_factor(fit);
  if (!prior_factor.usable() || !fit_factor.usable()) return -std::numeric_limits<double>::infinity();
  const double gain = fit.gradient.dot(fit_factor.solve(fit.gradient));  // by moving to this form's least
  return 0.5 * (prior_factor.log_determinant() - fit_factor.log_determinant() + gain -
                times * parts.common.squares);
}

}  // namespace

double likeliest_scatter_ratio(const FitParts& parts) {
  double ratio = 1.0, evidence = log_evidence(parts, ratio);
  for (int step = 0; step < kMostSteps; ++step) {
    const double here = log_evidence(parts, ratio / kStep);
    if (!(here > evidence)) break;
    ratio /= kStep;
    evidence = here;
  }
  return ratio;
}

}  // namespace arris
