#include "registration/loop_match.hpp"

#include <algorithm>

#include "acquisition/geometry/polyline.hpp"
#include "acquisition/geometry/rigid_fit.hpp"

namespace arris {
namespace {

constexpr std::size_t kArcs = 64;
constexpr std::size_t kKeptShifts = 4;
constexpr double kNearlyClosedRatio = 0.15;  // ends this near, in lengths: a loop with a gap
constexpr double kShortestChainRatio =
    0.35;  // of the CAD loop; a shorter piece does not tell where it belongs
constexpr double kWindowRatios[] = {0.5, 0.33};  // of the CAD loop: what a scan loop must follow of it
constexpr double kWindowFitsRatio =
    0.03;  // rms over its length: bending and a ragged edge, not another shape
constexpr double kWindowsALength = 16.0;
constexpr std::size_t kKeptWindows = 16;
constexpr double kSamePlaceRatio = 0.015;       // of the length of a contour
constexpr double kRaggedRatios[] = {1.0, 0.9};  // a ragged chain is longer than the edge it follows

/// Means over n equal arcs of a stretch of the curve, which smooths a ragged scan edge to the scale of an
/// arc.
std::vector<Eigen::Vector3d> arc_means(const Curve& curve, double start_mm, double stretch_mm) {
  constexpr int kSamplesPerArc = 4;
  std::vector<Eigen::Vector3d> points(kArcs, Eigen::Vector3d::Zero());
  const double arc_mm = stretch_mm / static_cast<double>(kArcs);
  for (std::size_t i = 0; i < kArcs; ++i)
    for (int k = 0; k < kSamplesPerArc; ++k) {
      const double s_mm = start_mm + (static_cast<double>(i) + (k + 0.5) / kSamplesPerArc) * arc_mm;
      points[i] += curve.point_mm(curve.wrap_mm(s_mm)) / kSamplesPerArc;
    }
  return points;
}

/// A loop that only a gap keeps open is taken as closed.
Contour without_small_gap(Contour loop) {
  if (!loop.closed && loop.points_mm.size() >= 8)
    loop.closed =
        (loop.points_mm.front() - loop.points_mm.back()).norm() < kNearlyClosedRatio * length_mm(loop);
  return loop;
}

/// Local minima of the fit over all start shifts, best first.
void add_best_shifts(const std::vector<RigidFit>& fits, int cad_loop, int scan_loop,
                     std::vector<LoopMatch>& matches) {
  std::vector<LoopMatch> local;
  const std::size_t n = fits.size();
  for (std::size_t k = 0; k < n; ++k) {
    const RigidFit& fit = fits[k];
    if (!fit.usable() || fit.rms_mm > fits[(k + n - 1) % n].rms_mm || fit.rms_mm > fits[(k + 1) % n].rms_mm)
      continue;
    local.push_back({fit.to_from, fit.rms_mm, cad_loop, scan_loop});
  }
  std::stable_sort(local.begin(), local.end(), [](auto& a, auto& b) { return a.rms_mm < b.rms_mm; });
  if (local.size() > kKeptShifts) local.resize(kKeptShifts);
  matches.insert(matches.end(), local.begin(), local.end());
}

std::vector<RigidFit> fits_of_closed(const Curve& cad, const Curve& scan) {
  const std::vector<Eigen::Vector3d> from = arc_means(cad, 0.0, cad.length_mm());
  std::vector<Eigen::Vector3d> to = arc_means(scan, 0.0, scan.length_mm());
  std::vector<RigidFit> fits;
  for (std::size_t shift = 0; shift < kArcs; ++shift) {
    fits.push_back(fit_rigid(from, to));
    std::rotate(to.begin(), to.begin() + 1, to.end());
  }
  return fits;
}

/// The stretch of the CAD's loop from each of kArcs starts.
std::vector<std::vector<Eigen::Vector3d>> stretches_of(const Curve& cad, double stretch_mm) {
  std::vector<std::vector<Eigen::Vector3d>> stretches;
  for (std::size_t shift = 0; shift < kArcs; ++shift)
    stretches.push_back(arc_means(
        cad, cad.length_mm() * static_cast<double>(shift) / static_cast<double>(kArcs), stretch_mm));
  return stretches;
}

std::vector<RigidFit> fits_to(const std::vector<std::vector<Eigen::Vector3d>>& stretches,
                              const std::vector<Eigen::Vector3d>& to) {
  std::vector<RigidFit> fits;
  for (const std::vector<Eigen::Vector3d>& from : stretches) fits.push_back(fit_rigid(from, to));
  return fits;
}

void sort_by_rms(std::vector<LoopMatch>& matches) {
  std::stable_sort(matches.begin(), matches.end(), [](auto& a, auto& b) { return a.rms_mm < b.rms_mm; });
}

/// How far two motions put a contour apart, by a few of its places.
double moved_mm(const Curve& cad, const RigidMotion& a, const RigidMotion& b) {
  double moved = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d p = cad.point_mm(0.25 * k * cad.length_mm());
    moved = std::max(moved, (a * p - b * p).norm());
  }
  return moved;
}

/// The best stretches of one length of a scan loop or chain.
void add_best_windows(const Curve& cad, const Curve& scan, double window_mm, LoopMatch names,
                      std::vector<LoopMatch>& matches) {
  const double step_mm = cad.length_mm() / kWindowsALength;
  const std::vector<std::vector<Eigen::Vector3d>> stretches = stretches_of(cad, window_mm);
  const double last_mm = scan.length_mm() - (scan.closed() ? 0.0 : window_mm);
  std::vector<LoopMatch> best;
  for (double start_mm = 0.0; start_mm < last_mm; start_mm += step_mm) {
    std::vector<LoopMatch> here;
    add_best_shifts(fits_to(stretches, arc_means(scan, start_mm, window_mm)), names.cad_loop, names.scan_loop,
                    here);
    for (const LoopMatch& match : here)
      if (match.rms_mm < kWindowFitsRatio * window_mm) best.push_back(match);
  }
  sort_by_rms(best);
  std::vector<LoopMatch> kept;  // one of those that lay the contour in the same place
  for (const LoopMatch& match : best) {
    if (kept.size() == kKeptWindows) break;
    if (std::none_of(kept.begin(), kept.end(), [&](const LoopMatch& other) {
          return moved_mm(cad, match.scan_from_cad, other.scan_from_cad) < kSamePlaceRatio * cad.length_mm();
        }))
      kept.push_back(match);
  }
  matches.insert(matches.end(), kept.begin(), kept.end());
}

}  // namespace

std::vector<LoopMatch> match_loops(const std::vector<Contour>& cad_loops,
                                   const std::vector<Contour>& scan_loops, double length_ratio) {
  std::vector<LoopMatch> matches;
  for (std::size_t c = 0; c < cad_loops.size(); ++c) {
    if (!cad_loops[c].closed || cad_loops[c].points_mm.size() < 8) continue;
    const Curve cad(cad_loops[c]);
    for (std::size_t l = 0; l < scan_loops.size(); ++l) {
      if (scan_loops[l].points_mm.size() < 8) continue;
      const Contour loop = without_small_gap(scan_loops[l]);
      const Curve scan(loop);
      const double ratio = scan.length_mm() / cad.length_mm();
      if (ratio > length_ratio) continue;
      const int cad_index = static_cast<int>(c), scan_index = static_cast<int>(l);
      if (loop.closed && ratio > 1.0 / length_ratio) {
        add_best_shifts(fits_of_closed(cad, scan), cad_index, scan_index, matches);
      } else if (!loop.closed && ratio > kShortestChainRatio) {
        for (const double ragged : kRaggedRatios)
          add_best_shifts(
              fits_to(stretches_of(cad, ragged * scan.length_mm()), arc_means(scan, 0.0, scan.length_mm())),
              cad_index, scan_index, matches);
      }
    }
  }
  sort_by_rms(matches);
  return matches;
}

std::vector<LoopMatch> match_pieces(const std::vector<Contour>& cad_loops,
                                    const std::vector<Contour>& scan_loops) {
  std::vector<LoopMatch> matches;
  for (std::size_t c = 0; c < cad_loops.size(); ++c) {
    if (!cad_loops[c].closed || cad_loops[c].points_mm.size() < 8) continue;
    const Curve cad(cad_loops[c]);
    for (std::size_t l = 0; l < scan_loops.size(); ++l) {
      if (scan_loops[l].points_mm.size() < 8) continue;
      const Curve scan(without_small_gap(scan_loops[l]));
      for (const double ratio : kWindowRatios)
        if (scan.length_mm() > 1.1 * ratio * cad.length_mm())
          add_best_windows(cad, scan, ratio * cad.length_mm(),
                           {RigidMotion::Identity(), 0.0, static_cast<int>(c), static_cast<int>(l)}, matches);
    }
  }
  sort_by_rms(matches);
  return matches;
}

}  // namespace arris
