#include "registration/coarse_candidates.hpp"

#include <algorithm>
#include <utility>

#include "registration/support_fit.hpp"

namespace arris {
namespace {

constexpr std::size_t kRefined = 4, kRefinedMore = 8;  // starts a source that are refined
constexpr std::size_t kSharpened = 4;                  // of the best poses, when none fits
constexpr int kSharpeningRounds = 3, kSharpeningPoints = 500;

/// The poses of the scan as it is and, when nothing says which side was seen, with the other side up.
std::vector<PoseCandidate> proper(CoarseContext& context, StartSource source, std::size_t refined) {
  std::vector<PoseCandidate> found = context.search.candidates(context.light(false), source, refined);
  context.fitness.sort(found);
  if (!context.side_open()) return found;
  std::vector<PoseCandidate> flipped = context.search.candidates(context.light(true), source, refined);
  for (PoseCandidate& candidate : flipped) candidate.flip = true;
  found.insert(found.end(), flipped.begin(), flipped.end());
  context.fitness.sort(found);
  return found;
}

/// The poses and those by which a motion of the drawing turns the best of them.
CoarseCandidates with_turned(CoarseContext& context, CoarseCandidates found) {
  if (!found.any()) return found;
  std::vector<PoseCandidate>& poses = found.poses;
  found.self_motions = context.search.self_motions();
  const LightScan& scan = context.light(poses.front().flip);
  const std::vector<PoseCandidate> more = context.search.turned(scan, poses.front(), found.self_motions);
  poses.insert(poses.end(), more.begin(), more.end());
  context.fitness.sort(poses);
  // The best one may be on its way along an oval.
  const PoseCandidate settled = context.search.settled(scan, poses.front());
  if (settled.misfit.patient_mm < poses.front().misfit.patient_mm) poses.front() = settled;
  context.fitness.sort(poses);
  return found;
}

/// The best of a pose and of those that the edge by support makes of it in turn.
PoseCandidate sharpened_one(CoarseContext& context, PoseCandidate pose) {
  RigidIcpOptions icp;
  icp.surface_points = kSharpeningPoints;
  icp.band_mm = context.options.band_mm;
  EdgeFitOptions edge;
  edge.threads = icp.threads = context.options.threads;
  const LightScan& scan = context.light(pose.flip);
  RigidMotion start = pose.scan_from_cad;
  for (int round = 0; round < kSharpeningRounds; ++round) {
    const RigidIcpResult fit = fit_to_support(context.cad, context.scan, start, edge, icp).rigid;
    if (!fit.usable()) break;
    start = fit.scan_from_cad;
    const PoseMisfit misfit = context.search.score().of(scan, start);
    if (misfit.patient_mm >= pose.misfit.patient_mm) break;
    pose.scan_from_cad = start;
    pose.misfit = misfit;
  }
  return pose;
}

}  // namespace

CoarseCandidates coarse_candidates(CoarseContext& context) {
  CoarseCandidates found;
  std::vector<PoseCandidate>& poses = found.poses;
  found.start = "matching loops";
  poses = proper(context, StartSource::kLoops, kRefined);
  if (found.any() && context.fitness.fits_whole(poses.front())) return with_turned(context, std::move(found));
  const auto add = [&](StartSource source, const char* words) {
    const double before_mm = poses.empty() ? 1e300 : poses.front().misfit.patient_mm;
    const std::vector<PoseCandidate> more = proper(context, source, kRefinedMore);
    poses.insert(poses.end(), more.begin(), more.end());
    context.fitness.sort(poses);
    const bool better = !poses.empty() && poses.front().misfit.patient_mm < before_mm;
    if (better) found.start = words;
    return better;
  };
  add(StartSource::kPieces, "matching pieces of contours");
  const auto fits = [&] { return !poses.empty() && context.fitness.fits(poses.front()); };
  if (!fits()) add(StartSource::kSurface, "matching surfaces");
  if (!fits()) found.by_faces = add(StartSource::kFaces, "matching the edges of faces");
  return with_turned(context, std::move(found));
}

std::vector<PoseCandidate> sharpened(CoarseContext& context, std::vector<PoseCandidate> poses) {
  sort_by_misfit(poses);
  for (std::size_t i = 0; i < std::min(kSharpened, poses.size()); ++i)
    if (poses[i].usable()) poses[i] = sharpened_one(context, std::move(poses[i]));
  context.fitness.sort(poses);
  return poses;
}

}  // namespace arris
