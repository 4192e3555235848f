#include "registration/coarse_align.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "registration/coarse_candidates.hpp"
#include "registration/coarse_context.hpp"
#include "registration/pose_rivals.hpp"
#include "registration/unit_guess.hpp"

namespace arris {
namespace {

constexpr std::size_t kRefined = 4, kRefinedOfGood = 2;  // starts that are refined of the other hand's
constexpr double kMirrorBetterRatio = 0.6;       // of the scores beyond what the point spacing alone leaves
constexpr double kMirrorLeastRatio = 0.1;        // of the cap: a pose that leaves no more is not doubted
constexpr double kMirrorOfAmbiguousRatio = 0.8;  // of the scores, when two poses fit alike
constexpr double kInitialFitsRatio = 0.08;  // of the contour's size: a long side on a short one leaves more
constexpr std::size_t kNearSample = 500;

/// Takes or refuses what was given or found, in words.
class CoarseAligner {
 public:
  CoarseAligner(const CadModel& cad, const ScanModel& scan, const CoarseAlignOptions& options)
      : context_(cad, scan, options) {}

  [[nodiscard]] CoarseAlignment from_initial();
  [[nodiscard]] CoarseAlignment from_nothing();

 private:
  [[nodiscard]] std::string near_initial() const;
  void take(const PoseCandidate& best);
  void refuse_no_start();
  void refuse_no_fit(const PoseCandidate& best);
  [[nodiscard]] bool refuse_wrong_hand(const CoarseCandidates& found);
  void refuse_by_rivals(const CoarseCandidates& found);

  CoarseContext context_;
  CoarseAlignment result_;
};

void CoarseAligner::take(const PoseCandidate& best) {
  result_.scan_from_cad = best.scan_from_cad;
  result_.score_mm = best.misfit.patient_mm;
  result_.flipped_normals = best.flip;
}

/// In words, what the initial pose puts near the contours that hold the part, and near its face.
std::string CoarseAligner::near_initial() const {
  const RigidMotion& initial = *context_.options.initial_scan_from_cad;
  double nearest2_mm2 = 1e300;
  for (const PoseScore::Sample& sample : context_.search.score().samples())
    nearest2_mm2 =
        std::min(nearest2_mm2, context_.scan.tree.nearest(initial * sample.place_mm).distance2_mm2);
  const std::vector<Eigen::Vector3d> points_mm = every(context_.scan.points_mm, kNearSample);
  const RigidMotion cad_from_scan = initial.inverse();
  const auto near = std::count_if(points_mm.begin(), points_mm.end(), [&](const Eigen::Vector3d& p) {
    return context_.cad.surface.closest(cad_from_scan * p, context_.options.band_mm).triangle >= 0;
  });
  const std::string within = fmt::format(" within {:.1f} mm (band_mm) of ", context_.options.band_mm);
  std::string words = "the initial pose of the recipe puts too few scan points" + within +
                      (context_.options.edges_needed ? "the contours" : "the contours that hold the part");
  if (!points_mm.empty())
    words += fmt::format(" (the nearest is {:.1f} mm away), and {:.0f} % of them{}the part's face",
                         std::sqrt(nearest2_mm2), 100.0 * double(near) / double(points_mm.size()), within);
  return words;
}

CoarseAlignment CoarseAligner::from_initial() {
  result_.start = "initial pose";
  const RigidMotion& initial = *context_.options.initial_scan_from_cad;
  PoseCandidate best;
  for (const bool flip : {false, true}) {
    if (flip && !context_.side_open()) break;  // else the pose decides which side the normals are on
    PoseCandidate refined = context_.search.refine(context_.light(flip), initial);
    refined.flip = flip;
    if (refined.misfit.patient_mm < best.misfit.patient_mm) best = refined;
  }
  if (!best.usable()) {
    result_.reason = "no points in the band: " + near_initial();
    result_.no_points = true;
    return result_;
  }
  take(best);
  if (rotation_between_rad(initial, best.scan_from_cad) > context_.options.within_rad)
    result_.reason = "the data turn the part by more than the initial pose allows (within_deg)" +
                     context_.search.free_by_surface(context_.scan, best.flip, initial);
  else if (context_.options.edges_needed && context_.fitness.beyond_spacing_mm(result_.score_mm) >
                                                kInitialFitsRatio * context_.search.score().size_mm())
    result_.reason = fmt::format(
        "the initial pose does not fit: the scan's edge stays {:.1f} mm from the contours", result_.score_mm);
  return result_;
}

void CoarseAligner::refuse_no_start() {
  result_.unit_ratio = unit_that_fits(context_.cad, context_.scan);
  result_.reason =
      context_.options.edges_needed
          ? "no closed contour of the scan has the length of an accepted CAD contour"
          : "role cut: no outline and no datum hole of the drawing is in the scan as a closed loop, so "
            "every slide along the face and the turn about its normal are free; scan one of them all round, "
            "or give scan.initial";
}

void CoarseAligner::refuse_no_fit(const PoseCandidate& best) {
  result_.reason = fmt::format(
      "no pose fits: the best one leaves {:.1f} mm between scan and part; is it this part, and does the scan "
      "show the contour?",
      best.misfit.patient_mm);
  if (!context_.options.edges_needed)
    result_.reason += context_.search.free_by_surface(context_.scan, best.flip, best.scan_from_cad);
  result_.unit_ratio = unit_that_fits(context_.cad, context_.scan);
}

/// A scan whose mirror image fits, or that fits inside out, is an input error and not a pose.
bool CoarseAligner::refuse_wrong_hand(const CoarseCandidates& found) {
  const PoseCandidate& best = found.poses.front();
  const double left_mm = context_.fitness.beyond_spacing_mm(best.misfit.patient_mm);
  const bool good = context_.side_open() ||
                    (!found.by_faces && (context_.fitness.fits_whole(best) ||
                                         left_mm < kMirrorLeastRatio * context_.search.score().cap_mm()));
  const std::size_t refined = good ? kRefinedOfGood : kRefined;
  const std::vector<PoseCandidate> mirrored = context_.search.candidates(
      LightScan(context_.scan, false, true), StartSource::kLoops, refined, best.misfit.patient_mm);
  if (!mirrored.empty() && mirrored.front().usable())
    result_.mirror_ratio = mirrored.front().misfit.patient_mm / best.misfit.patient_mm;
  if (good) return false;
  // A drawing laid on any edges there are is near to many scans: then no other hand may fit better at all.
  const double better_ratio = found.by_faces ? 1.0 : kMirrorBetterRatio;
  const auto fits_better = [&](const std::vector<PoseCandidate>& others) {
    return !others.empty() &&
           context_.fitness.beyond_spacing_mm(others.front().misfit.patient_mm) < better_ratio * left_mm;
  };
  result_.mirrored = fits_better(mirrored);
  result_.inverted =
      fits_better(context_.search.candidates(context_.light(true), StartSource::kLoops, refined));
  if (!result_.mirrored && !result_.inverted) return false;
  result_.reason = result_.mirrored
                       ? "the mirror image of the scan fits the part and the scan itself does not"
                       : "the scan fits the part with its normals turned round, and not as they are";
  return true;
}

/// What the other poses say, and, where it is settled by shape alone, the open side and the other hand.
void CoarseAligner::refuse_by_rivals(const CoarseCandidates& found) {
  RivalVerdict verdict = judge_rivals(context_, found);
  result_.runner_up_ratio = verdict.runner_up_ratio;
  result_.equal_poses = verdict.equal_poses;
  result_.reason = std::move(verdict.reason);
  // Shape alone would take a mirrored scan, and an inverted drawing, as they come.
  if (result_.usable() && context_.side_open())
    result_.reason =
        "nothing says which side of the part the scanner saw: give normals in the file, scan.seen_from (a "
        "point in the air in front of the part) or scan.initial";
  // A bent part that is nearly its own mirror image fits either way: only said, not called mirrored.
  if (!result_.usable() && !context_.side_open() && result_.mirror_ratio > 0.0 &&
      result_.mirror_ratio < kMirrorOfAmbiguousRatio)
    result_.reason +=
        fmt::format("; the scan's mirror image fits better ({:.0f} % of the best): was it exported mirrored?",
                    100.0 * result_.mirror_ratio);
  if (!result_.usable()) result_.unit_ratio = unit_that_fits(context_.cad, context_.scan);
}

CoarseAlignment CoarseAligner::from_nothing() {
  CoarseCandidates found = coarse_candidates(context_);
  result_.start = found.start;
  if (!found.any()) {
    refuse_no_start();
    return result_;
  }
  const PoseFitness& fitness = context_.fitness;
  const auto fits = [&] {
    return fitness.fits(found.poses.front()) || fitness.fits_where_seen(found.poses.front());
  };
  take(found.poses.front());
  if (refuse_wrong_hand(found)) return result_;
  if (!fits()) {
    found.poses = sharpened(context_, std::move(found.poses));
    take(found.poses.front());
  }
  // Else every pose is about as bad as another.
  if (!fits() && !fitness.confirmed_by_others(found.poses.front())) {
    refuse_no_fit(found.poses.front());
    return result_;
  }
  refuse_by_rivals(found);
  return result_;
}

}  // namespace

CoarseAlignment coarse_align(const CadModel& cad, const ScanModel& scan, const CoarseAlignOptions& options) {
  CoarseAligner aligner(cad, scan, options);
  return options.initial_scan_from_cad ? aligner.from_initial() : aligner.from_nothing();
}

}  // namespace arris
