#include "registration/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "acquisition/geometry/parallel_for.hpp"
#include "registration/edge_pairs.hpp"
#include "registration/face_match.hpp"
#include "registration/free_directions.hpp"
#include "registration/loop_match.hpp"
#include "registration/rigid_icp.hpp"
#include "registration/surface_match.hpp"

namespace arris {
namespace {

constexpr int kSurfaceSample = 160;
constexpr double kTellingRatio = 0.5;  // of the longest followed contour: a small hole alone tells too little
constexpr double kSelfFitsRatio = 0.2;     // of the contour's size: the drawing nearly lies on itself
constexpr double kSelfLengthRatio = 1.15;  // of two of its contours
constexpr std::size_t kStartsAFace = 4;
constexpr std::size_t kMostTurned = 4, kMostSelfMotions = 100;
constexpr std::size_t kEdgeSample = 120, kScoredTogether = 4;
constexpr int kIcpRounds = 14, kMoreRefinements = 3, kSettlingRounds = 150;
constexpr double kFirstReachRatio = 2.0, kSecondReachRatio = 0.5;  // of the cap: edge points that take part
constexpr double kReachSpacings = 2.5;
constexpr double kStillInItRatio = 2.0;  // of what the best pose leaves: worse ones are not refined further

/// A start by its score, or by what that is at least: those are looked at first.
struct RankedStart {
  double misfit_mm = 0.0;
  bool is_score = false;
  std::size_t start = 0;
  auto operator<=>(const RankedStart&) const = default;
};

/// The loops that no operator has rejected.
std::vector<Contour> not_rejected(const ScanModel& scan) {
  std::vector<Contour> left;
  for (std::size_t l = 0; l < scan.loops.size(); ++l)
    if (!scan.is_rejected(l)) left.push_back(scan.loops[l]);
  return left;
}

}  // namespace

void sort_by_misfit(std::vector<PoseCandidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const PoseCandidate& a, const PoseCandidate& b) {
    return a.misfit.patient_mm < b.misfit.patient_mm;
  });
}

PoseSearch::PoseSearch(const CadModel& cad, double band_mm, int threads)
    : cad_(cad), band_mm_(band_mm), threads_(threads), score_(cad, band_mm) {
  for (const Curve& curve : cad.contours) loops_.push_back(curve.contour());
  const auto telling = [&](const Curve& curve) {
    return curve.length_mm() > kTellingRatio * 6.28 * score_.size_mm();
  };
  for (const Curve& curve : cad.contours)
    if (telling(curve)) telling_.push_back(curve.contour());
  for (const Curve& curve : cad.others)
    if (telling(curve)) loops_.push_back(curve.contour()), telling_.push_back(curve.contour());
}

/// The same scan with only the edge points near the contours at a start pose, of loops that run along them: a
/// gap may join a contour to the border of the scan.
ScanModel PoseSearch::along_contours(const LightScan& light, const RigidMotion& start,
                                     double reach_mm) const {
  const ScanModel& scan = light.model;
  const RigidMotion cad_from_scan = start.inverse();
  std::vector<Eigen::Vector3d> edges;
  const std::vector<LoopAssignment> assigned = assign_loops(cad_, scan.loops, start, 2.0 * band_mm_);
  for (std::size_t l = 0; l < scan.loops.size(); ++l)
    if (assigned[l].contour >= 0)
      for (const Eigen::Vector3d& p : scan.loops[l].points_mm)
        if (near_contours(cad_, cad_from_scan * p, reach_mm)) edges.push_back(p);
  if (edges.empty()) edges = scan.edge_mm;
  return {scan.points_mm,  scan.normals,        NearestPoints({}), {}, every(edges, kEdgeSample), {},
          scan.spacing_mm, scan.noise_sigma_mm, scan.side};
}

PoseCandidate PoseSearch::refined(const LightScan& scan, const RigidMotion& start, double reach_mm,
                                  int rounds) const {
  RigidIcpOptions icp;
  icp.max_iterations = rounds;
  icp.stop_change_ratio = rounds > kIcpRounds ? 1e-6 : 1e-3;
  icp.surface_points = kSurfaceSample;
  icp.start_scale_mm = std::min(0.6 * score_.cap_mm(), reach_mm);
  icp.band_mm = band_mm_;
  icp.threads = 1;
  const RigidIcpResult result = icp_point_to_plane(cad_, along_contours(scan, start, reach_mm), start, icp);
  PoseCandidate candidate;
  if (!result.usable()) return candidate;
  candidate.scan_from_cad = result.scan_from_cad;
  candidate.misfit = score_.of(scan, result.scan_from_cad);
  candidate.free = free_directions(result.information, result.pivot_mm, score_.size_mm());
  return candidate;
}

/// Of edge points that take part when the pose is nearly found.
double PoseSearch::near_mm(const LightScan& scan) const {
  return std::max(kSecondReachRatio * score_.cap_mm(), kReachSpacings * scan.model.spacing_mm);
}

PoseCandidate PoseSearch::refine(const LightScan& scan, const RigidMotion& start, double most_mm) const {
  return refined_further(scan, start, refined(scan, start, kFirstReachRatio * score_.cap_mm(), kIcpRounds),
                         most_mm);
}

PoseCandidate PoseSearch::refined_further(const LightScan& scan, const RigidMotion& start, PoseCandidate best,
                                          double most_mm) const {
  const double reach_mm = near_mm(scan);
  if (!best.usable() || best.misfit.patient_mm <= reach_mm / 2.0) return best;
  if (score_.least_of_start_mm(scan, start) < std::min(most_mm, best.misfit.patient_mm)) {
    const PoseMisfit at_start = score_.of(scan, start);
    if (at_start.patient_mm < best.misfit.patient_mm) {  // the edges of what lies about pulled it away
      best.scan_from_cad = start;
      best.misfit = at_start;
    }
  }
  if (best.misfit.patient_mm > most_mm) return best;
  for (int again = 0; again < kMoreRefinements && best.misfit.patient_mm > reach_mm / 2.0; ++again) {
    PoseCandidate next = refined(scan, best.scan_from_cad, reach_mm, kIcpRounds);
    if (next.misfit.patient_mm >= best.misfit.patient_mm) break;
    best = std::move(next);
  }
  return best;
}

PoseCandidate PoseSearch::settled(const LightScan& scan, const PoseCandidate& candidate) const {
  PoseCandidate found = refined(scan, candidate.scan_from_cad, near_mm(scan), kSettlingRounds);
  found.flip = candidate.flip;
  return found;
}

std::string PoseSearch::free_by_surface(const ScanModel& scan, bool flip, const RigidMotion& start) const {
  LightScan light(scan, flip, false);
  light.model.edge_mm.clear();
  light.model.edge_normals.clear();
  light.model.loops.clear();
  light.edges = NearestPoints({});
  std::string words;
  for (const std::string& direction : refine(light, start).free)
    words += (words.empty() ? "" : ", ") + direction;
  return words.empty() ? words : "; the surface alone leaves these free: " + words;
}

std::vector<RigidMotion> PoseSearch::starts(const LightScan& scan, StartSource source) const {
  if (source == StartSource::kSurface)
    return match_surfaces(cad_, scan.model, scan.spacing_mm, band_mm_, threads_);
  if (source == StartSource::kFaces)
    return match_faces(cad_, scan.model, score_.cap_mm(), kStartsAFace, threads_);
  std::vector<RigidMotion> starts;
  const std::vector<Contour> loops = not_rejected(scan.model);
  for (const LoopMatch& match :
       source == StartSource::kLoops ? match_loops(loops_, loops) : match_pieces(telling_, loops))
    starts.push_back(match.scan_from_cad);
  return starts;
}

/// Of all its contours: a round hole that is laid on itself says nothing of the others.
double PoseSearch::self_misfit_mm(const RigidMotion& motion) const {
  constexpr std::size_t kStride = 6;
  const std::vector<PoseScore::Sample>& samples = score_.samples();
  double sum = 0.0;
  for (std::size_t i = 0; i < samples.size(); i += kStride) {
    const double off_mm = nearest_contour(cad_.contours, motion * samples[i].place_mm).foot.distance_mm;
    sum += std::pow(std::min(off_mm, score_.cap_mm()), 2) * kStride;
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

std::vector<RigidMotion> PoseSearch::self_motions() const {
  std::vector<RigidMotion> motions = {RigidMotion::Identity()};
  std::vector<std::pair<double, std::size_t>> order;
  for (const LoopMatch& match : match_loops(telling_, telling_, kSelfLengthRatio)) {
    if (match.rms_mm > kSelfFitsRatio * score_.size_mm() || motions.size() > kMostSelfMotions) break;
    if (std::any_of(motions.begin(), motions.end(), [&](const RigidMotion& other) {
          return moved_mm(match.scan_from_cad, other) < kSameStartRatio * score_.size_mm();
        }))
      continue;
    order.emplace_back(self_misfit_mm(match.scan_from_cad), motions.size());
    motions.push_back(match.scan_from_cad);
  }
  std::sort(order.begin(), order.end());
  if (order.size() > kMostTurned) order.resize(kMostTurned);
  std::vector<RigidMotion> best;
  for (const auto& [misfit_mm, i] : order) best.push_back(motions[i]);
  return best;
}

std::vector<PoseCandidate> PoseSearch::turned(const LightScan& scan, const PoseCandidate& candidate,
                                              std::span<const RigidMotion> self_motions) const {
  std::vector<PoseCandidate> found(self_motions.size());
  parallel_for(found.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      found[i] = refine(scan, candidate.scan_from_cad * self_motions[i],
                        kStillInItRatio * candidate.misfit.patient_mm);
      found[i].flip = candidate.flip;
    }
  });
  return found;
}

std::optional<RigidMotion> PoseSearch::self_motion_between(const PoseCandidate& a, const PoseCandidate& b,
                                                           std::span<const RigidMotion> self_motions) const {
  std::optional<RigidMotion> nearest;
  double least_mm = kSameStartRatio * score_.size_mm();
  for (const RigidMotion& motion : self_motions) {
    const double off_mm = moved_mm(a.scan_from_cad * motion, b.scan_from_cad);
    if (off_mm >= least_mm) continue;
    nearest = motion;
    least_mm = off_mm;
  }
  return nearest;
}

double PoseSearch::moved_mm(const RigidMotion& a, const RigidMotion& b) const {
  double moved = 0.0;
  for (const PoseScore::Sample& s : score_.samples())
    moved = std::max(moved, (a * s.place_mm - b * s.place_mm).norm());
  return moved;
}

std::vector<RigidMotion> PoseSearch::best_apart(const LightScan& scan, const std::vector<RigidMotion>& starts,
                                                std::size_t count) const {
  std::vector<RankedStart> ranked(starts.size());
  parallel_for(starts.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      ranked[i] = {score_.least_of_start_mm(scan, starts[i]), false, i};
  });
  std::priority_queue<RankedStart, std::vector<RankedStart>, std::greater<>> queue(std::greater<>(),
                                                                                   std::move(ranked));
  std::vector<RigidMotion> chosen;
  const auto is_new = [&](std::size_t i) {
    return std::none_of(chosen.begin(), chosen.end(), [&](const RigidMotion& other) {
      return moved_mm(starts[i], other) < kSameStartRatio * score_.size_mm();
    });
  };
  while (!queue.empty() && chosen.size() < count) {
    std::vector<RankedStart> bounded;  // those next in turn of which only a bound is known
    for (; !queue.empty() && !queue.top().is_score && bounded.size() < kScoredTogether; queue.pop())
      if (is_new(queue.top().start)) bounded.push_back(queue.top());
    parallel_for(bounded.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        bounded[k] = {score_.of_start(scan, starts[bounded[k].start]).patient_mm, true, bounded[k].start};
    });
    for (const RankedStart& start : bounded) queue.push(start);
    if (!bounded.empty() || queue.empty() || !queue.top().is_score) continue;
    if (is_new(queue.top().start)) chosen.push_back(starts[queue.top().start]);
    queue.pop();
  }
  return chosen;
}

std::vector<PoseCandidate> PoseSearch::candidates(const LightScan& scan, StartSource source,
                                                  std::size_t refined, double known_mm) const {
  const std::vector<RigidMotion> chosen = best_apart(scan, starts(scan, source), refined);
  std::vector<PoseCandidate> found(chosen.size());
  parallel_for(chosen.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      found[i] = this->refined(scan, chosen[i], kFirstReachRatio * score_.cap_mm(), kIcpRounds);
  });
  for (const PoseCandidate& pose : found) known_mm = std::min(known_mm, pose.misfit.patient_mm);
  parallel_for(found.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      found[i] = refined_further(scan, chosen[i], std::move(found[i]), kStillInItRatio * known_mm);
  });
  sort_by_misfit(found);
  return found;
}

bool PoseSearch::within(const PoseCandidate& a, const PoseCandidate& b, double size_ratio) const {
  const double tolerance_mm = size_ratio * score_.size_mm();
  if (moved_mm(a.scan_from_cad, b.scan_from_cad) < tolerance_mm) return true;
  if (a.free.empty()) return false;
  const RigidMotion g = a.scan_from_cad.inverse() * b.scan_from_cad;
  return std::all_of(score_.samples().begin(), score_.samples().end(), [&](const PoseScore::Sample& s) {
    return nearest_contour(cad_.contours, g * s.place_mm).foot.distance_mm < tolerance_mm;
  });
}

}  // namespace arris
