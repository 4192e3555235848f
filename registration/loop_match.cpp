#include "registration/loop_match.hpp"

#include <algorithm>

#include "acquisition/geometry/polyline.hpp"
#include "acquisition/geometry/rigid_fit.hpp"

namespace arris {
namespace {

constexpr std::size_t kArcs = 64;
constexpr std::size_t kKeptShifts = 4;

/// Points at equal arcs of a loop; a ragged scan loop is smoothed to the scale of one arc by the mean of each arc.
std::vector<Eigen::Vector3d> at_equal_arcs(const Contour& loop) {
  const Curve curve(loop);
  constexpr int kSamplesPerArc = 4;
  std::vector<Eigen::Vector3d> points(kArcs, Eigen::Vector3d::Zero());
  const double arc_mm = curve.length_mm() / static_cast<double>(kArcs);
  for (std::size_t i = 0; i < kArcs; ++i)
    for (int k = 0; k < kSamplesPerArc; ++k) {
      const double s_mm = (static_cast<double>(i) + (k + 0.5) / kSamplesPerArc) * arc_mm;
      points[i] += curve.point_mm(curve.wrap_mm(s_mm)) / kSamplesPerArc;
    }
  return points;
}

bool comparable(const Contour& a, const Contour& b, double length_ratio) {
  if (!a.closed || !b.closed || a.points_mm.size() < 8 || b.points_mm.size() < 8) return false;
  const double ratio = length_mm(a) / length_mm(b);
  return ratio < length_ratio && ratio > 1.0 / length_ratio;
}

}  // namespace

std::vector<LoopMatch> match_loops(const std::vector<Contour>& cad_loops, const std::vector<Contour>& scan_loops,
                                   double length_ratio) {
  std::vector<LoopMatch> matches;
  for (std::size_t c = 0; c < cad_loops.size(); ++c)
    for (std::size_t l = 0; l < scan_loops.size(); ++l) {
      if (!comparable(cad_loops[c], scan_loops[l], length_ratio)) continue;
      const std::vector<Eigen::Vector3d> from = at_equal_arcs(cad_loops[c]);
      std::vector<Eigen::Vector3d> to = at_equal_arcs(scan_loops[l]);
      std::vector<RigidFit> fits;
      for (std::size_t shift = 0; shift < kArcs; ++shift) {
        fits.push_back(fit_rigid(from, to));
        std::rotate(to.begin(), to.begin() + 1, to.end());
      }
      std::vector<LoopMatch> local;
      for (std::size_t k = 0; k < kArcs; ++k) {
        const RigidFit& fit = fits[k];
        const RigidFit& before = fits[(k + kArcs - 1) % kArcs];
        const RigidFit& after = fits[(k + 1) % kArcs];
        if (!fit.usable() || fit.rms_mm > before.rms_mm || fit.rms_mm > after.rms_mm) continue;
        local.push_back({fit.to_from, fit.rms_mm, static_cast<int>(c), static_cast<int>(l)});
      }
      std::stable_sort(local.begin(), local.end(), [](auto& a, auto& b) { return a.rms_mm < b.rms_mm; });
      if (local.size() > kKeptShifts) local.resize(kKeptShifts);
      matches.insert(matches.end(), local.begin(), local.end());
    }
  std::stable_sort(matches.begin(), matches.end(), [](auto& a, auto& b) { return a.rms_mm < b.rms_mm; });
  return matches;
}

}  // namespace arris
