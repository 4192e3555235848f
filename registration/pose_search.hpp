#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "registration/pose_score.hpp"

namespace arris {

/// A pose that was refined and scored.
struct PoseCandidate {
  RigidMotion scan_from_cad = RigidMotion::Identity();
  PoseMisfit misfit;
  bool flip = false, mirror = false;
  std::vector<std::string> free;  ///< motions that the data leave free, in words
  [[nodiscard]] bool usable() const { return misfit.patient_mm < 1e299; }
};

/// Where starts come from, in the order in which they are tried.
enum class StartSource {
  kLoops,    ///< closed loops and long chains of the scan laid whole on contours of the drawing
  kPieces,   ///< stretches of them, whatever their length: a clamp or the border of the view cut the contour
  kSurface,  ///< features of the surface, no contour at all
  kFaces,    ///< contours on all edges of a face at once, whatever loops these make
};

/// Finds poses of one drawing in a scan: starts from loops, pieces or the surface, a short rigid ICP from the
/// best, the score.
class PoseSearch {
 public:
  /// Keeps the reference. threads: 0 is all.
  PoseSearch(const CadModel& cad, double band_mm, int threads);

  [[nodiscard]] const PoseScore& score() const { return score_; }
  /// Short rigid ICP from a start, and where that leaves much, but not more than most_mm, further ones with
  /// the edge points that it brought near; not usable() where no points are near.
  [[nodiscard]] PoseCandidate refine(const LightScan& scan, const RigidMotion& start,
                                     double most_mm = 1e300) const;
  /// The same pose after a long rigid ICP: two that were stopped on their way along an oval come together.
  [[nodiscard]] PoseCandidate settled(const LightScan& scan, const PoseCandidate& candidate) const;
  /// The best distinct poses, best first: at most `refined` starts that lie apart are refined, those that
  /// leave far more than the best of them, or than a pose that leaves known_mm, only coarsely.
  [[nodiscard]] std::vector<PoseCandidate> candidates(const LightScan& scan, StartSource source,
                                                      std::size_t refined, double known_mm = 1e300) const;
  /// Motions that lay the drawing's contours nearly on themselves, best first; without the identity.
  [[nodiscard]] std::vector<RigidMotion> self_motions() const;
  /// The poses that differ from one by such a motion: where the starts missed the right one of them, this
  /// finds it.
  [[nodiscard]] std::vector<PoseCandidate> turned(const LightScan& scan, const PoseCandidate& candidate,
                                                  std::span<const RigidMotion> self_motions) const;
  /// The one of those motions that the second pose is nearly turned by from the first; none: they are no two
  /// ways to lay the part.
  [[nodiscard]] std::optional<RigidMotion> self_motion_between(
      const PoseCandidate& a, const PoseCandidate& b, std::span<const RigidMotion> self_motions) const;
  /// In words, what the surface alone leaves free near a pose: where no edge holds the part it slides. Empty:
  /// nothing.
  [[nodiscard]] std::string free_by_surface(const ScanModel& scan, bool flip, const RigidMotion& start) const;
  /// True if the two poses put the contours in the same place, point by point or, where a motion along the
  /// contour is free (a circle), as curves.
  [[nodiscard]] bool same_place(const PoseCandidate& a, const PoseCandidate& b) const {
    return within(a, b, kSamePlaceRatio);
  }
  /// The same for poses as near to each other as two starts of one pose.
  [[nodiscard]] bool one_start(const PoseCandidate& a, const PoseCandidate& b) const {
    return within(a, b, kSameStartRatio);
  }

 private:
  static constexpr double kSamePlaceRatio = 0.06, kSameStartRatio = 0.15;  // of the contour's size
  [[nodiscard]] bool within(const PoseCandidate& a, const PoseCandidate& b, double size_ratio) const;
  [[nodiscard]] ScanModel along_contours(const LightScan& scan, const RigidMotion& start,
                                         double reach_mm) const;
  [[nodiscard]] PoseCandidate refined(const LightScan& scan, const RigidMotion& start, double reach_mm,
                                      int rounds) const;
  /// Further ICPs where a pose leaves much, but not more than most_mm.
  [[nodiscard]] PoseCandidate refined_further(const LightScan& scan, const RigidMotion& start,
                                              PoseCandidate best, double most_mm) const;
  [[nodiscard]] double near_mm(const LightScan& scan) const;
  [[nodiscard]] std::vector<RigidMotion> starts(const LightScan& scan, StartSource source) const;
  /// The best starts that lie apart: several of one pose would crowd out the runner-up.
  [[nodiscard]] std::vector<RigidMotion> best_apart(const LightScan& scan,
                                                    const std::vector<RigidMotion>& starts,
                                                    std::size_t count) const;
  [[nodiscard]] double self_misfit_mm(const RigidMotion& motion) const;
  [[nodiscard]] double moved_mm(const RigidMotion& a, const RigidMotion& b) const;

  const CadModel& cad_;
  double band_mm_;
  int threads_;
  PoseScore score_;
  std::vector<Contour> loops_, telling_;  ///< to lay the scan's on: whole ones, and pieces of long ones
};

/// Best first; equal ones stay in order.
void sort_by_misfit(std::vector<PoseCandidate>& candidates);

}  // namespace arris
