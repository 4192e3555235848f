#include "registration/pose_fitness.hpp"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

constexpr double kFitsCapRatio = 0.25;  // of the cap, beyond the spacing
constexpr double kFewestShown = 0.40;   // of the contours: less shows no pose
constexpr double kWellShown = 0.55;     // of the contours
constexpr double kSeenCapRatio = 0.2;   // as kFitsCapRatio, of the places that tell anything
constexpr double kMostAgainst = 0.2, kMostAgainstWhole = 0.1;  // of the contours: the face goes on there
constexpr double kNotWorseRatio = 0.95;  // of the strict misfits: who wins by the patient one
constexpr double kAlsoFitsRatio = 1.5;   // of what the best pose leaves: the other is a fit if it is one
constexpr int kFewestConfirming = 3;
constexpr double kConfirmsSpacings = 0.5;                       // beyond the spacing
constexpr double kConfirmedCapRatio = 0.4;                      // as kFitsCapRatio
constexpr double kQuarterMissing = 0.78, kTenthMissing = 0.92;  // shown of the contours

}  // namespace

double PoseFitness::beyond_spacing_mm(double misfit_mm) const {
  return std::sqrt(std::max(0.0, misfit_mm * misfit_mm - spacing_mm_ * spacing_mm_));
}

double PoseFitness::fits_mm() const {
  return kFitsCapRatio * cap_mm_;
}

bool PoseFitness::not_contradicted(const PoseCandidate& pose) const {
  return (pose.misfit.shown_ratio >= kFewestShown || !edges_needed_) &&
         pose.misfit.against_ratio <= kMostAgainst;
}

bool PoseFitness::is_hidden(const PoseCandidate& pose) const {
  return edges_needed_ && pose.misfit.shown_ratio < kFewestShown;
}

bool PoseFitness::fits(const PoseCandidate& pose) const {
  return beyond_spacing_mm(pose.misfit.patient_mm) <= fits_mm() && not_contradicted(pose);
}

bool PoseFitness::fits_whole(const PoseCandidate& pose) const {
  return fits(pose) && pose.misfit.against_ratio <= kMostAgainstWhole &&
         beyond_spacing_mm(pose.misfit.strict_mm) <= fits_mm();
}

bool PoseFitness::fits_where_seen(const PoseCandidate& pose) const {
  return pose.misfit.shown_ratio >= kWellShown && pose.misfit.against_ratio <= kMostAgainstWhole &&
         beyond_spacing_mm(pose.misfit.seen_mm) <= kSeenCapRatio * cap_mm_;
}

bool PoseFitness::confirmed_by_others(const PoseCandidate& pose) const {
  return pose.misfit.others >= kFewestConfirming && not_contradicted(pose) &&
         pose.misfit.others_mm <= kConfirmsSpacings * spacing_mm_ &&
         beyond_spacing_mm(pose.misfit.patient_mm) <= kConfirmedCapRatio * cap_mm_;
}

bool PoseFitness::fits_too(const PoseCandidate& pose, const PoseCandidate& best) const {
  const double most_mm = std::max(fits_mm(), kAlsoFitsRatio * beyond_spacing_mm(best.misfit.patient_mm));
  return pose.usable() && beyond_spacing_mm(pose.misfit.patient_mm) <= most_mm && not_contradicted(pose);
}

void PoseFitness::sort(std::vector<PoseCandidate>& found) const {
  sort_by_misfit(found);
  std::stable_partition(found.begin(), found.end(),
                        [&](const PoseCandidate& pose) { return !is_hidden(pose); });
}

double PoseFitness::contradicted_mm(const PoseMisfit& misfit) const {
  return std::sqrt(misfit.patient_mm * misfit.patient_mm + misfit.against_ratio * cap_mm_ * cap_mm_);
}

double PoseFitness::times_worse(const PoseCandidate& other, const PoseCandidate& best) const {
  double worst = other.misfit.patient_mm / best.misfit.patient_mm;
  const auto ask = [&](double ratio) {
    if (worst >= kNotWorseRatio) worst = ratio < kNotWorseRatio ? ratio : std::max(worst, ratio);
  };
  if (best.misfit.shown_ratio >= kTenthMissing)
    ask(other.misfit.strict_mm / best.misfit.strict_mm);
  else if (best.misfit.shown_ratio >= kQuarterMissing)
    ask(other.misfit.middle_mm / best.misfit.middle_mm);
  ask(contradicted_mm(other.misfit) / contradicted_mm(best.misfit));
  return worst;
}

}  // namespace arris
