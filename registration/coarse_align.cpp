#include "registration/coarse_align.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "acquisition/geometry/parallel_for.hpp"
#include "registration/path_symmetry.hpp"
#include "registration/pose_evidence.hpp"
#include "registration/pose_fitness.hpp"
#include "registration/pose_search.hpp"
#include "registration/support_fit.hpp"
#include "registration/unit_guess.hpp"

namespace arris {
namespace {

constexpr std::size_t kRefined = 4, kRefinedMore = 8,
                      kRefinedOfGood = 2;   // starts a hypothesis that are refined
constexpr double kHiddenRivalRatio = 0.7;   // of what the best pose shows: a hidden one with less is no rival
constexpr double kMirrorBetterRatio = 0.6;  // of the scores beyond what the point spacing alone leaves
constexpr double kMirrorLeastRatio = 0.1;   // of the cap: a pose that leaves no more is not doubted
constexpr double kMirrorOfAmbiguousRatio = 0.8;  // of the scores, when two poses fit alike
constexpr double kInitialFitsRatio = 0.08;  // of the contour's size: a long side on a short one leaves more
constexpr std::size_t kNearSample = 500;
constexpr double kSelfMotionRatio = 0.06;  // of the contour's size: how well a motion of the drawing is known
constexpr std::size_t kSharpened = 4;      // of the best poses, when none fits
constexpr int kSharpeningRounds = 3, kSharpeningPoints = 500;

std::string millimetres(double value_mm) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value_mm);
  return text;
}

std::string percent(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * ratio);
  return text;
}

/// One search: what was asked, and what each step found.
class CoarseSearch {
 public:
  CoarseSearch(const CadModel& cad, const ScanModel& scan, const CoarseAlignOptions& options)
      : cad_(cad),
        scan_(scan),
        options_(options),
        search_(cad, options.band_mm, options.threads),
        fitness_(scan.spacing_mm, search_.score().cap_mm(), options.edges_needed) {}

  CoarseAlignment from_initial();
  CoarseAlignment from_nothing();

 private:
  [[nodiscard]] std::string near_initial() const;
  /// The scan, or that with its other side up, made ready when first asked for.
  [[nodiscard]] const LightScan& light(bool flip);
  [[nodiscard]] std::vector<PoseCandidate> proper(StartSource source, std::size_t refined);
  [[nodiscard]] std::vector<PoseCandidate> with_turned(std::vector<PoseCandidate> found);
  [[nodiscard]] std::vector<PoseCandidate> all_candidates();
  [[nodiscard]] PoseCandidate sharpened(PoseCandidate pose);
  [[nodiscard]] std::vector<PoseCandidate> all_sharpened(std::vector<PoseCandidate> found);
  void take(const PoseCandidate& best);
  void refuse_no_start();
  void refuse_no_fit(const PoseCandidate& best);
  [[nodiscard]] bool refuse_wrong_hand(const std::vector<PoseCandidate>& found);
  void judge_runner_up(const std::vector<PoseCandidate>& proper);
  /// Two poses of the same side fitted to the end. Those of the best one, and of others elsewhere, are kept:
  /// what lies at the same place comes to the same end.
  struct Settled {
    PoseCandidate best, other;
  };
  [[nodiscard]] Settled settled(const PoseCandidate& best, const PoseCandidate& other);
  [[nodiscard]] bool comes_to(const PoseCandidate& best, const PoseCandidate& other);
  [[nodiscard]] bool only_bending_decides(const PoseCandidate& best, const PoseCandidate& other,
                                          const PathSymmetry& path);
  void refuse_ambiguous(const PoseCandidate& best, const PoseCandidate& other);
  void refuse_untold(const PoseCandidate& best, const PoseCandidate& other);
  [[nodiscard]] bool side_open() const { return scan_.side == SideKnown::kNo; }

  const CadModel& cad_;
  const ScanModel& scan_;
  const CoarseAlignOptions& options_;
  PoseSearch search_;
  PoseFitness fitness_;
  std::array<std::optional<LightScan>, 2> light_;
  std::vector<RigidMotion> self_motions_;
  bool best_by_faces_ = false;
  std::optional<PoseCandidate> settled_best_;
  std::vector<std::pair<PoseCandidate, PoseCandidate>> settled_others_;  ///< as found, and at the end
  CoarseAlignment result_;
};

void CoarseSearch::take(const PoseCandidate& best) {
  result_.scan_from_cad = best.scan_from_cad;
  result_.score_mm = best.misfit.patient_mm;
  result_.flipped_normals = best.flip;
}

/// In words, what the initial pose puts near the contours that hold the part, and near its face.
std::string CoarseSearch::near_initial() const {
  const RigidMotion& initial = *options_.initial_scan_from_cad;
  double nearest2_mm2 = 1e300;
  for (const PoseScore::Sample& sample : search_.score().samples())
    nearest2_mm2 = std::min(nearest2_mm2, scan_.tree.nearest(initial * sample.place_mm).distance2_mm2);
  const std::vector<Eigen::Vector3d> points_mm = every(scan_.points_mm, kNearSample);
  const RigidMotion cad_from_scan = initial.inverse();
  const auto near = std::count_if(points_mm.begin(), points_mm.end(), [&](const Eigen::Vector3d& p) {
    return cad_.surface.closest(cad_from_scan * p, options_.band_mm).triangle >= 0;
  });
  const std::string within = " within " + millimetres(options_.band_mm) + " mm (band_mm) of ";
  std::string words = "the initial pose of the recipe puts too few scan points" + within +
                      (options_.edges_needed ? "the contours" : "the contours that hold the part");
  if (!points_mm.empty())
    words += " (the nearest is " + millimetres(std::sqrt(nearest2_mm2)) + " mm away), and " +
             percent(double(near) / double(points_mm.size())) + " of them" + within + "the part's face";
  return words;
}

CoarseAlignment CoarseSearch::from_initial() {
  result_.start = "initial pose";
  const RigidMotion& initial = *options_.initial_scan_from_cad;
  PoseCandidate best;
  for (const bool flip : {false, true}) {
    if (flip && !side_open()) break;  // else the pose decides which side the normals are on
    PoseCandidate refined = search_.refine(light(flip), initial);
    refined.flip = flip;
    if (refined.misfit.patient_mm < best.misfit.patient_mm) best = refined;
  }
  if (!best.usable()) {
    result_.reason = "no points in the band: " + near_initial();
    result_.no_points = true;
    return result_;
  }
  take(best);
  if (rotation_between_rad(initial, best.scan_from_cad) > options_.within_rad)
    result_.reason = "the data turn the part by more than the initial pose allows (within_deg)" +
                     search_.free_by_surface(scan_, best.flip, initial);
  else if (options_.edges_needed &&
           fitness_.beyond_spacing_mm(result_.score_mm) > kInitialFitsRatio * search_.score().size_mm())
    result_.reason = "the initial pose does not fit: the scan's edge stays " + millimetres(result_.score_mm) +
                     " mm from the contours";
  return result_;
}

const LightScan& CoarseSearch::light(bool flip) {
  std::optional<LightScan>& made = light_[flip ? 1 : 0];
  if (!made) made.emplace(scan_, flip, false);
  return *made;
}

/// The poses of the scan as it is and, when nothing says which side was seen, with the other side up.
std::vector<PoseCandidate> CoarseSearch::proper(StartSource source, std::size_t refined) {
  std::vector<PoseCandidate> found = search_.candidates(light(false), source, refined);
  fitness_.sort(found);
  if (!side_open()) return found;
  std::vector<PoseCandidate> flipped = search_.candidates(light(true), source, refined);
  for (PoseCandidate& candidate : flipped) candidate.flip = true;
  found.insert(found.end(), flipped.begin(), flipped.end());
  fitness_.sort(found);
  return found;
}

std::vector<PoseCandidate> CoarseSearch::with_turned(std::vector<PoseCandidate> found) {
  if (found.empty() || !found.front().usable()) return found;
  self_motions_ = search_.self_motions();
  const LightScan& scan = light(found.front().flip);
  const std::vector<PoseCandidate> more = search_.turned(scan, found.front(), self_motions_);
  found.insert(found.end(), more.begin(), more.end());
  fitness_.sort(found);
  const PoseCandidate settled = search_.settled(scan, found.front());  // it may be on its way along an oval
  if (settled.misfit.patient_mm < found.front().misfit.patient_mm) found.front() = settled;
  fitness_.sort(found);
  return found;
}

/// Whole loops first; then pieces of contours, where no loop fits well; then the surface, and all edges of
/// its faces, where nothing fits.
std::vector<PoseCandidate> CoarseSearch::all_candidates() {
  result_.start = "matching loops";
  std::vector<PoseCandidate> found = proper(StartSource::kLoops, kRefined);
  if (!found.empty() && fitness_.fits_whole(found.front())) return with_turned(std::move(found));
  const auto add = [&](StartSource source, const char* words) {
    const double before_mm = found.empty() ? 1e300 : found.front().misfit.patient_mm;
    const std::vector<PoseCandidate> more = proper(source, kRefinedMore);
    found.insert(found.end(), more.begin(), more.end());
    fitness_.sort(found);
    const bool better = !found.empty() && found.front().misfit.patient_mm < before_mm;
    if (better) result_.start = words;
    return better;
  };
  add(StartSource::kPieces, "matching pieces of contours");
  const auto fits = [&] { return !found.empty() && fitness_.fits(found.front()); };
  if (!fits()) add(StartSource::kSurface, "matching surfaces");
  if (!fits()) best_by_faces_ = add(StartSource::kFaces, "matching the edges of faces");
  return with_turned(std::move(found));
}

void CoarseSearch::refuse_no_start() {
  result_.unit_ratio = unit_that_fits(cad_, scan_);
  result_.reason =
      options_.edges_needed
          ? "no closed contour of the scan has the length of an accepted CAD contour"
          : "role cut: no outline and no datum hole of the drawing is in the scan as a closed loop, so every "
            "slide along the face and the turn about its normal are free; scan one of them all round, or "
            "give "
            "scan.initial";
}

void CoarseSearch::refuse_no_fit(const PoseCandidate& best) {
  result_.reason = "no pose fits: the best one leaves " + millimetres(best.misfit.patient_mm) +
                   " mm between scan and part; is it this part, and does the scan show the contour?";
  if (!options_.edges_needed) result_.reason += search_.free_by_surface(scan_, best.flip, best.scan_from_cad);
  result_.unit_ratio = unit_that_fits(cad_, scan_);
}

/// The best of a pose and of those that the edge by support makes of it in turn.
PoseCandidate CoarseSearch::sharpened(PoseCandidate pose) {
  RigidIcpOptions icp;
  icp.surface_points = kSharpeningPoints;
  icp.band_mm = options_.band_mm;
  EdgeFitOptions edge;
  edge.threads = icp.threads = options_.threads;
  const LightScan& scan = light(pose.flip);
  RigidMotion start = pose.scan_from_cad;
  for (int round = 0; round < kSharpeningRounds; ++round) {
    const RigidIcpResult fit = fit_to_support(cad_, scan_, start, edge, icp).rigid;
    if (!fit.usable()) break;
    start = fit.scan_from_cad;
    const PoseMisfit misfit = search_.score().of(scan, start);
    if (misfit.patient_mm >= pose.misfit.patient_mm) break;
    pose.scan_from_cad = start;
    pose.misfit = misfit;
  }
  return pose;
}

/// The best few poses, of which none fits, on the edge by support: extracted points, a spacing inside it and
/// some of them strays, may be what is left, and what hides a pose.
std::vector<PoseCandidate> CoarseSearch::all_sharpened(std::vector<PoseCandidate> found) {
  sort_by_misfit(found);
  for (std::size_t i = 0; i < std::min(kSharpened, found.size()); ++i)
    if (found[i].usable()) found[i] = sharpened(std::move(found[i]));
  fitness_.sort(found);
  return found;
}

/// A scan whose mirror image fits, or that fits inside out, is an input error and not a pose.
bool CoarseSearch::refuse_wrong_hand(const std::vector<PoseCandidate>& found) {
  const PoseCandidate& best = found.front();
  const double left_mm = fitness_.beyond_spacing_mm(best.misfit.patient_mm);
  const bool good =
      side_open() || (!best_by_faces_ &&
                      (fitness_.fits_whole(best) || left_mm < kMirrorLeastRatio * search_.score().cap_mm()));
  const std::size_t refined = good ? kRefinedOfGood : kRefined;
  const std::vector<PoseCandidate> mirrored =
      search_.candidates(LightScan(scan_, false, true), StartSource::kLoops, refined, best.misfit.patient_mm);
  if (!mirrored.empty() && mirrored.front().usable())
    result_.mirror_ratio = mirrored.front().misfit.patient_mm / best.misfit.patient_mm;
  if (good) return false;
  // A drawing laid on any edges there are is near to many scans: then no other hand may fit better at all.
  const double better_ratio = best_by_faces_ ? 1.0 : kMirrorBetterRatio;
  const auto fits_better = [&](const std::vector<PoseCandidate>& others) {
    return !others.empty() &&
           fitness_.beyond_spacing_mm(others.front().misfit.patient_mm) < better_ratio * left_mm;
  };
  result_.mirrored = fits_better(mirrored);
  result_.inverted = fits_better(search_.candidates(light(true), StartSource::kLoops, refined));
  if (!result_.mirrored && !result_.inverted) return false;
  result_.reason = result_.mirrored
                       ? "the mirror image of the scan fits the part and the scan itself does not"
                       : "the scan fits the part with its normals turned round, and not as they are";
  return true;
}

void CoarseSearch::refuse_ambiguous(const PoseCandidate& best, const PoseCandidate& other) {
  const std::string by = " fit alike (runner-up " + percent(result_.runner_up_ratio) + " of the best): ";
  result_.reason =
      best.flip != other.flip
          ? "both sides of the part" + by +
                "nothing says which side the scanner saw; give normals in the file, "
                "scan.seen_from or scan.initial"
          : "two poses" + by +
                "scan also a hole or a corner that tells them apart, or give scan.initial in the "
                "recipe";
  if (!options_.edges_needed) result_.reason += search_.free_by_surface(scan_, best.flip, best.scan_from_cad);
}

CoarseSearch::Settled CoarseSearch::settled(const PoseCandidate& best, const PoseCandidate& other) {
  for (const auto& [found, at_the_end] : settled_others_)
    if (found.flip == other.flip && search_.same_place(found, other)) return {*settled_best_, at_the_end};
  const LightScan& scan = light(best.flip);
  Settled both;
  parallel_for(settled_best_ ? 1 : 2, 1, options_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      (i == 0 ? both.other : both.best) = search_.settled(scan, i == 0 ? other : best);
  });
  if (settled_best_) both.best = *settled_best_;
  settled_best_ = both.best;
  settled_others_.emplace_back(other, both.other);
  return both;
}

/// Whether two poses are one when both are fitted to the end.
bool CoarseSearch::comes_to(const PoseCandidate& best, const PoseCandidate& other) {
  if (best.flip != other.flip) return false;
  const auto [a, b] = settled(best, other);
  return a.usable() && b.usable() && search_.one_start(a, b);
}

/// Whether the other pose is a fit as well and lays the drawing's contours, as far as the scan shows them,
/// where the best one does, but not the path: its worse score comes from how the part is bent, or from noise.
bool CoarseSearch::only_bending_decides(const PoseCandidate& best, const PoseCandidate& other,
                                        const PathSymmetry& path) {
  if (!fitness_.fits_too(other, best)) return false;
  const auto [a, b] = settled(best, other);
  if (!a.usable() || !fitness_.fits_too(b, best)) return false;
  const std::optional<RigidMotion> motion = search_.self_motion_between(a, b, self_motions_);
  if (!motion || path.maps_onto_itself(*motion)) return false;
  const double size_mm = search_.score().size_mm();
  const PoseTolerance tolerance = pose_tolerance(scan_.spacing_mm, size_mm, fitness_.fits_mm());
  const double within_mm = kSelfMotionRatio * size_mm;
  // A path round the edges that are seen goes where they are, nearly the same from either pose.
  if (options_.edges_needed && path.farthest_off_mm(*motion) <= tolerance.in_face_mm + within_mm)
    return false;
  const LightScan& scan = light(best.flip);
  return lays_shown_on_itself(cad_, scan, a.scan_from_cad, *motion, tolerance, within_mm) &&
         !edges_tell_apart(cad_, scan, a.scan_from_cad, b.scan_from_cad, tolerance);
}

void CoarseSearch::refuse_untold(const PoseCandidate& best, const PoseCandidate& other) {
  const double turn_deg = rotation_between_rad(best.scan_from_cad, other.scan_from_cad) * 180.0 / 3.14159265;
  char turn[32];
  std::snprintf(turn, sizeof turn, "%.0f", turn_deg);
  result_.reason = "two poses fit alike: turned by " + std::string(turn) +
                   " degrees the drawing's contours that the scan shows lie on themselves, and the tool path "
                   "does not, so that only bending or noise would choose (runner-up " +
                   percent(result_.runner_up_ratio) +
                   " of the best); scan also a hole or a corner that tells them apart, or give scan.initial "
                   "in the recipe";
}

/// The best pose elsewhere must be clearly worse, but where it lays the whole tool path on itself; and no
/// score is enough where the scan's edges do not tell the two apart.
void CoarseSearch::judge_runner_up(const std::vector<PoseCandidate>& proper) {
  const PoseCandidate& best = proper.front();
  std::vector<Contour> contours;
  for (const Curve& curve : cad_.contours) contours.push_back(curve.contour());
  const PathSymmetry symmetry(options_.path.empty() ? contours : options_.path);
  std::vector<const PoseCandidate*> places = {&best};
  for (const PoseCandidate& other : proper) {
    const bool told = std::any_of(places.begin(), places.end(), [&](const PoseCandidate* place) {
      return other.flip == place->flip && search_.same_place(*place, other);
    });
    if (told || !other.usable()) continue;
    const double worse = fitness_.times_worse(other, best);
    const bool no_rival =
        fitness_.is_hidden(other) && other.misfit.shown_ratio < kHiddenRivalRatio * best.misfit.shown_ratio;
    if (no_rival && worse < options_.ambiguity_ratio) continue;
    const bool same_path = other.flip == best.flip &&
                           symmetry.maps_onto_itself(best.scan_from_cad.inverse() * other.scan_from_cad);
    if (worse < options_.ambiguity_ratio && same_path) {
      places.push_back(&other);
      continue;
    }
    if (worse >= options_.ambiguity_ratio && result_.usable() && !same_path && other.flip == best.flip &&
        only_bending_decides(best, other, symmetry)) {
      result_.runner_up_ratio = worse;
      refuse_untold(best, other);
      continue;
    }
    if (worse < options_.ambiguity_ratio && comes_to(best, other)) continue;
    if (result_.runner_up_ratio != 0.0 && worse >= result_.runner_up_ratio) continue;
    result_.runner_up_ratio = worse;
    if (worse < options_.ambiguity_ratio) refuse_ambiguous(best, other);
  }
  result_.equal_poses = static_cast<int>(places.size());
}

CoarseAlignment CoarseSearch::from_nothing() {
  std::vector<PoseCandidate> found = all_candidates();
  if (found.empty() || !found.front().usable()) {
    refuse_no_start();
    return result_;
  }
  take(found.front());
  if (refuse_wrong_hand(found)) return result_;
  const auto fits = [&] { return fitness_.fits(found.front()) || fitness_.fits_where_seen(found.front()); };
  if (!fits()) {
    found = all_sharpened(std::move(found));
    take(found.front());
  }
  // Else every pose is about as bad as another.
  if (!fits() && !fitness_.confirmed_by_others(found.front())) {
    refuse_no_fit(found.front());
    return result_;
  }
  judge_runner_up(found);
  // Shape alone would take a mirrored scan, and an inverted drawing, as they come.
  if (result_.usable() && side_open())
    result_.reason =
        "nothing says which side of the part the scanner saw: give normals in the file, scan.seen_from (a "
        "point in the air in front of the part) or scan.initial";
  // A bent part that is nearly its own mirror image fits either way: only said, not called mirrored.
  if (!result_.usable() && !side_open() && result_.mirror_ratio > 0.0 &&
      result_.mirror_ratio < kMirrorOfAmbiguousRatio)
    result_.reason += "; the scan's mirror image fits better (" + percent(result_.mirror_ratio) +
                      " of the best): was it exported mirrored?";
  if (!result_.usable()) result_.unit_ratio = unit_that_fits(cad_, scan_);
  return result_;
}

}  // namespace

CoarseAlignment coarse_align(const CadModel& cad, const ScanModel& scan, const CoarseAlignOptions& options) {
  CoarseSearch search(cad, scan, options);
  return options.initial_scan_from_cad ? search.from_initial() : search.from_nothing();
}

}  // namespace arris
