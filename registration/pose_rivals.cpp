#include "registration/pose_rivals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "acquisition/geometry/parallel_for.hpp"
#include "registration/path_symmetry.hpp"
#include "registration/pose_evidence.hpp"

namespace arris {
namespace {

constexpr double kHiddenRivalRatio = 0.7;  // of what the best pose shows: a hidden one with less is no rival
constexpr double kSelfMotionRatio = 0.06;  // of the contour's size: how well a motion of the drawing is known

/// One judgement: what is asked, and what was fitted to the end for it.
class PoseRivals {
 public:
  PoseRivals(CoarseContext& context, const CoarseCandidates& found) : context_(context), found_(found) {}

  [[nodiscard]] RivalVerdict judge();

 private:
  /// Two poses of the same side fitted to the end. Those of the best one, and of others elsewhere, are kept:
  /// what lies at the same place comes to the same end.
  struct Settled {
    PoseCandidate best, other;
  };
  [[nodiscard]] Settled settled(const PoseCandidate& best, const PoseCandidate& other);
  [[nodiscard]] bool no_rival(const PoseCandidate& other, const PoseCandidate& best) const;
  [[nodiscard]] bool comes_to(const PoseCandidate& best, const PoseCandidate& other);
  [[nodiscard]] bool only_bending_decides(const PoseCandidate& best, const PoseCandidate& other,
                                          const PathSymmetry& path);
  void refuse_ambiguous(const PoseCandidate& best, const PoseCandidate& other);
  void refuse_untold(const PoseCandidate& best, const PoseCandidate& other);

  CoarseContext& context_;
  const CoarseCandidates& found_;
  std::optional<PoseCandidate> settled_best_;
  std::vector<std::pair<PoseCandidate, PoseCandidate>> settled_others_;  ///< as found, and at the end
  RivalVerdict verdict_;
};

PoseRivals::Settled PoseRivals::settled(const PoseCandidate& best, const PoseCandidate& other) {
  for (const auto& [found, at_the_end] : settled_others_)
    if (found.flip == other.flip && context_.search.same_place(found, other))
      return {*settled_best_, at_the_end};
  const LightScan& scan = context_.light(best.flip);
  Settled both;
  parallel_for(settled_best_ ? 1 : 2, 1, context_.options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      (i == 0 ? both.other : both.best) = context_.search.settled(scan, i == 0 ? other : best);
  });
  if (settled_best_) both.best = *settled_best_;
  settled_best_ = both.best;
  settled_others_.emplace_back(other, both.other);
  return both;
}

/// Hangs where nothing was scanned, and shows less of its edges than the best pose does.
bool PoseRivals::no_rival(const PoseCandidate& other, const PoseCandidate& best) const {
  return context_.fitness.is_hidden(other) &&
         other.misfit.shown_ratio < kHiddenRivalRatio * best.misfit.shown_ratio;
}

/// Whether two poses are one when both are fitted to the end.
bool PoseRivals::comes_to(const PoseCandidate& best, const PoseCandidate& other) {
  if (best.flip != other.flip) return false;
  const auto [a, b] = settled(best, other);
  return a.usable() && b.usable() && context_.search.one_start(a, b);
}

/// Whether the other pose is a fit as well and lays the drawing's contours, as far as the scan shows them,
/// where the best one does, but not the path: its worse score comes from how the part is bent, or from noise.
bool PoseRivals::only_bending_decides(const PoseCandidate& best, const PoseCandidate& other,
                                      const PathSymmetry& path) {
  if (!context_.fitness.fits_too(other, best)) return false;
  const auto [a, b] = settled(best, other);
  if (!a.usable() || !context_.fitness.fits_too(b, best)) return false;
  const std::optional<RigidMotion> motion = context_.search.self_motion_between(a, b, found_.self_motions);
  if (!motion || path.maps_onto_itself(*motion)) return false;
  const double size_mm = context_.search.score().size_mm();
  const PoseTolerance tolerance =
      pose_tolerance(context_.scan.spacing_mm, size_mm, context_.fitness.fits_mm());
  const double within_mm = kSelfMotionRatio * size_mm;
  // A path round the edges that are seen goes where they are, nearly the same from either pose.
  if (context_.options.edges_needed && path.farthest_off_mm(*motion) <= tolerance.in_face_mm + within_mm)
    return false;
  const LightScan& scan = context_.light(best.flip);
  return lays_shown_on_itself(context_.cad, scan, a.scan_from_cad, *motion, tolerance, within_mm) &&
         !edges_tell_apart(context_.cad, scan, a.scan_from_cad, b.scan_from_cad, tolerance);
}

void PoseRivals::refuse_ambiguous(const PoseCandidate& best, const PoseCandidate& other) {
  const bool sides = best.flip != other.flip;
  verdict_.reason = fmt::format(
      "{} fit alike (runner-up {:.0f} % of the best): {}", sides ? "both sides of the part" : "two poses",
      100.0 * verdict_.runner_up_ratio,
      sides ? "nothing says which side the scanner saw; give normals in the file, scan.seen_from or "
              "scan.initial"
            : "scan also a hole or a corner that tells them apart, or give scan.initial in the recipe");
  if (!context_.options.edges_needed)
    verdict_.reason += context_.search.free_by_surface(context_.scan, best.flip, best.scan_from_cad);
}

void PoseRivals::refuse_untold(const PoseCandidate& best, const PoseCandidate& other) {
  verdict_.reason = fmt::format(
      "two poses fit alike: turned by {:.0f} degrees the drawing's contours that the scan shows lie on "
      "themselves, and the tool path does not, so that only bending or noise would choose (runner-up "
      "{:.0f} % of the best); scan also a hole or a corner that tells them apart, or give "
      "scan.initial in the recipe",
      rotation_between_rad(best.scan_from_cad, other.scan_from_cad) * 180.0 / std::numbers::pi,
      100.0 * verdict_.runner_up_ratio);
}

RivalVerdict PoseRivals::judge() {
  const PoseCandidate& best = found_.poses.front();
  std::vector<Contour> contours;
  for (const Curve& curve : context_.cad.contours) contours.push_back(curve.contour());
  const PathSymmetry symmetry(context_.options.path.empty() ? contours : context_.options.path);
  std::vector<const PoseCandidate*> places = {&best};
  for (const PoseCandidate& other : found_.poses) {
    const bool told = std::any_of(places.begin(), places.end(), [&](const PoseCandidate* place) {
      return other.flip == place->flip && context_.search.same_place(*place, other);
    });
    if (told || !other.usable()) continue;
    const double worse = context_.fitness.times_worse(other, best);
    const bool alike = worse < context_.options.ambiguity_ratio;
    if (alike && no_rival(other, best)) continue;
    const bool same_path = other.flip == best.flip &&
                           symmetry.maps_onto_itself(best.scan_from_cad.inverse() * other.scan_from_cad);
    if (alike && same_path) {
      places.push_back(&other);
      continue;
    }
    if (!alike && verdict_.reason.empty() && !same_path && other.flip == best.flip &&
        only_bending_decides(best, other, symmetry)) {
      verdict_.runner_up_ratio = worse;
      refuse_untold(best, other);
      continue;
    }
    if (alike && comes_to(best, other)) continue;
    if (verdict_.runner_up_ratio != 0.0 && worse >= verdict_.runner_up_ratio) continue;
    verdict_.runner_up_ratio = worse;
    if (alike) refuse_ambiguous(best, other);
  }
  verdict_.equal_poses = static_cast<int>(places.size());
  return std::move(verdict_);
}

}  // namespace

RivalVerdict judge_rivals(CoarseContext& context, const CoarseCandidates& found) {
  return PoseRivals(context, found).judge();
}

}  // namespace arris
