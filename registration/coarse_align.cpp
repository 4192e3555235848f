#include "registration/coarse_align.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "acquisition/geometry/median.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "registration/edge_pairs.hpp"
#include "registration/loop_match.hpp"
#include "registration/rigid_icp.hpp"

namespace arris {
namespace {

constexpr std::size_t kSurfaceSample = 160;
constexpr std::size_t kEdgeSample = 120;
constexpr std::size_t kEdgeScored = 2000;      // a thinned edge would score its own gaps, some 5 mm
constexpr std::size_t kRefined = 4;            // candidates a hypothesis that are refined
constexpr double kFitsCapRatio = 0.8;          // of the largest distance that scores count
constexpr double kFreeEigenvalueRatio = 1e-4;  // methods: slippage, Gelfand and Guibas 2003
constexpr double kEdgeKept = 0.75, kSurfaceKept = 0.9;
constexpr std::size_t kLoopSample = 12;
constexpr double kLengthsAgree[] = {0.75, 1.33};  // of a loop of the scan and the contour that it is
constexpr double kMirrorBetterRatio = 0.6;        // of the scores beyond what the point spacing alone leaves
constexpr double kMirrorOfAmbiguousRatio = 0.8;   // of the scores, when two poses fit alike
constexpr double kExtentsAgree[] = {0.8,
                                    15.0};  // of scan and contour: no wrong unit is needed to explain them
constexpr double kScaledExtentMost = 6.0;   // and in another unit only this far from the contour's
constexpr std::size_t kLongestLoops = 3;
constexpr double kInitialFitsRatio = 0.08;  // of the contour's size: a long side on a short one leaves more
constexpr double kUnitRatios[] = {25.4, 1000.0, 1.0 / 25.4, 1.0 / 1000.0};

template <class T>
std::vector<T> every(const std::vector<T>& values, std::size_t count) {
  if (values.size() <= count) return values;
  std::vector<T> chosen(count);
  for (std::size_t i = 0; i < count; ++i) chosen[i] = values[i * values.size() / count];
  return chosen;
}

/// A small copy of the scan for scoring: as it is, with the other side up, or mirrored in x.
ScanModel hypothesis(const ScanModel& scan, bool flip, bool mirror) {
  ScanModel light{every(scan.points_mm, 8 * kSurfaceSample),
                  every(scan.normals, 8 * kSurfaceSample),
                  NearestPoints({}),
                  scan.loops,
                  every(scan.edge_mm, kEdgeScored),
                  every(scan.edge_normals, kEdgeScored),
                  scan.spacing_mm,
                  scan.noise_sigma_mm,
                  SideKnown::kYes};
  const auto reflect = [](Eigen::Vector3d& p) { p.x() = -p.x(); };
  const auto negate = [](Eigen::Vector3d& n) { n = -n; };
  if (mirror) {
    for (auto* list : {&light.points_mm, &light.normals, &light.edge_mm, &light.edge_normals})
      std::for_each(list->begin(), list->end(), reflect);
    for (Contour& loop : light.loops) {
      std::for_each(loop.points_mm.begin(), loop.points_mm.end(), reflect);
      std::for_each(loop.normals.begin(), loop.normals.end(), reflect);
    }
  }
  if (flip) {
    for (auto* list : {&light.normals, &light.edge_normals})
      std::for_each(list->begin(), list->end(), negate);
    for (Contour& loop : light.loops) std::for_each(loop.normals.begin(), loop.normals.end(), negate);
  }
  if (flip != mirror)
    for (Contour& loop : light.loops) {
      std::reverse(loop.points_mm.begin(), loop.points_mm.end());
      std::reverse(loop.normals.begin(), loop.normals.end());
    }
  return light;
}

/// The loops that no operator has rejected.
std::vector<Contour> not_rejected(const ScanModel& scan, const std::vector<Contour>& loops) {
  std::vector<Contour> left;
  for (std::size_t l = 0; l < loops.size(); ++l)
    if (!scan.is_rejected(l)) left.push_back(loops[l]);
  return left;
}

/// Mean of the smallest share of the values: what a gap or a clamp adds is not judged.
double trimmed_mean(std::vector<double>& values, double kept_ratio) {
  std::sort(values.begin(), values.end());
  const std::size_t kept =
      std::max<std::size_t>(1, static_cast<std::size_t>(kept_ratio * double(values.size())));
  double sum = 0.0;
  for (std::size_t i = 0; i < kept; ++i) sum += values[i];
  return sum / static_cast<double>(kept);
}

struct Candidate {
  RigidMotion scan_from_cad = RigidMotion::Identity();
  double score_mm = 1e300;
  bool flip = false, mirror = false;
  std::vector<std::string> free;
};

/// Loops have their material on the left.
bool runs_around_material(const Contour& loop) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero(), normal = area;
  const std::size_t n = loop.points_mm.size();
  for (std::size_t i = 0; i < n; ++i) {
    area += (loop.points_mm[i] - loop.points_mm[0]).cross(loop.points_mm[(i + 1) % n] - loop.points_mm[0]);
    normal += loop.normals[i];
  }
  return area.dot(normal) > 0.0;
}

class Search {
 public:
  Search(const CadModel& cad, const CoarseAlignOptions& options) : cad_(cad), options_(options) {
    for (const Curve& curve : cad.contours) {
      loops_.push_back(curve.contour());
      const double step_mm = curve.length_mm() / 60.0;
      for (int i = 0; i < 60; ++i) samples_mm_.push_back(curve.point_mm(i * step_mm));
      size_mm_ = std::max(size_mm_, curve.length_mm() / 6.28);
    }
    cap_mm_ = 0.15 * size_mm_;
  }

  const std::vector<Contour>& loops() const { return loops_; }
  double size_mm() const { return size_mm_; }
  double cap_mm() const { return cap_mm_; }

  /// Trimmed rms, both ways: contour samples to the scan's edge points, scan points in the band to the
  /// surface.
  double score(const ScanModel& light, const NearestPoints& edges, const RigidMotion& scan_from_cad) const {
    const double cap2 = cap_mm_ * cap_mm_;
    std::vector<double> edge2, surface2;
    for (const Eigen::Vector3d& p : samples_mm_) {
      const Neighbour nearest = edges.nearest(scan_from_cad * p);
      edge2.push_back(nearest.index < 0 ? cap2 : std::min(cap2, nearest.distance2_mm2));
    }
    const RigidMotion cad_from_scan = scan_from_cad.inverse();
    for (std::size_t i = 0; i < light.points_mm.size() && surface2.size() < kSurfaceSample; ++i) {
      const Eigen::Vector3d x = cad_from_scan * light.points_mm[i];
      if (pair_edge(cad_, x, options_.band_mm).contour < 0) continue;
      const SurfacePoint foot = cad_.surface.closest(x, cap_mm_);
      const bool agrees =
          foot.triangle >= 0 && foot.normal.dot(cad_from_scan.linear() * light.normals[i]) > 0.5;
      surface2.push_back(agrees ? std::min(cap2, foot.distance_mm * foot.distance_mm) : cap2);
    }
    if (surface2.size() < 10) return cap_mm_;
    return std::sqrt(trimmed_mean(edge2, kEdgeKept) + trimmed_mean(surface2, kSurfaceKept) +
                     stray_loops2(light, cad_from_scan));
  }

  /// Whether a loop of the scan may be another hole of the CAD: it runs around no material, as the border of
  /// what was scanned does, and has the length of one, as the rim of a gap has hardly ever.
  bool may_be_other_hole(const Contour& loop) const {
    if (runs_around_material(loop)) return false;
    const double loop_mm = length_mm(loop);
    return std::any_of(cad_.others.begin(), cad_.others.end(), [&](const Curve& hole) {
      return loop_mm > kLengthsAgree[0] * hole.length_mm() && loop_mm < kLengthsAgree[1] * hole.length_mm() &&
             !runs_around_material(hole.contour());
    });
  }

  /// Mean over the scan's holes of the squared distance, median along the hole, from the CAD's contours,
  /// followed or not: a second hole in the wrong place gives a wrong pose away.
  double stray_loops2(const ScanModel& light, const RigidMotion& cad_from_scan) const {
    if (cad_.others.empty()) return 0.0;
    std::vector<double> loop2;
    for (const Contour& loop : light.loops) {
      if (!may_be_other_hole(loop)) continue;
      const std::size_t stride = std::max<std::size_t>(1, loop.points_mm.size() / kLoopSample);
      std::vector<double> off2;
      for (std::size_t i = 0; i < loop.points_mm.size(); i += stride) {
        const Eigen::Vector3d x = cad_from_scan * loop.points_mm[i];
        double nearest_mm = cap_mm_;
        for (const auto* curves : {&cad_.contours, &cad_.others})
          for (const Curve& curve : *curves) nearest_mm = std::min(nearest_mm, curve.nearest(x).distance_mm);
        off2.push_back(nearest_mm * nearest_mm);
      }
      loop2.push_back(median_of(std::move(off2)));  // around a gap the loop leaves the edge
    }
    double mean = 0.0;
    for (const double value : loop2) mean += value / static_cast<double>(loop2.size());
    return mean;
  }

  /// The same scan with only the edge points of loops that run along the contours at a start pose.
  ScanModel along_contours(const ScanModel& light, const RigidMotion& start) const {
    std::vector<Eigen::Vector3d> edges;
    const std::vector<LoopAssignment> assigned =
        assign_loops(cad_, light.loops, start, 2.0 * options_.band_mm);
    for (std::size_t l = 0; l < light.loops.size(); ++l)
      if (assigned[l].contour >= 0)
        edges.insert(edges.end(), light.loops[l].points_mm.begin(), light.loops[l].points_mm.end());
    if (edges.empty()) edges = light.edge_mm;
    return {light.points_mm,  light.normals,        NearestPoints({}), {}, every(edges, kEdgeSample), {},
            light.spacing_mm, light.noise_sigma_mm, light.side};
  }

  Candidate refine(const ScanModel& light, const NearestPoints& edges, const RigidMotion& start) const {
    RigidIcpOptions icp;
    icp.max_iterations = 14;
    icp.stop_change_ratio = 1e-3;
    icp.surface_points = static_cast<int>(kSurfaceSample);
    icp.start_scale_mm = 0.6 * cap_mm_;
    icp.band_mm = options_.band_mm;
    icp.threads = 1;
    const RigidIcpResult result = icp_point_to_plane(cad_, along_contours(light, start), start, icp);
    Candidate candidate;
    if (!result.usable()) return candidate;
    candidate.scan_from_cad = result.scan_from_cad;
    candidate.score_mm = score(light, edges, result.scan_from_cad);
    candidate.free = free_directions(result.information, result.pivot_mm, size_mm_);
    return candidate;
  }

  /// In words, what the surface alone leaves free near a pose: where no edge holds the part it slides. Empty:
  /// nothing.
  std::string free_by_surface(ScanModel light, const RigidMotion& start) const {
    light.edge_mm.clear();
    light.edge_normals.clear();
    light.loops.clear();
    const Candidate candidate = refine(light, NearestPoints({}), start);
    std::string words;
    for (const std::string& direction : candidate.free) words += (words.empty() ? "" : ", ") + direction;
    return words.empty() ? words : "; the surface alone leaves these free: " + words;
  }

  /// The best distinct poses of one hypothesis, best first.
  std::vector<Candidate> candidates(const ScanModel& scan, bool flip, bool mirror,
                                    std::size_t refined) const {
    const ScanModel light = hypothesis(scan, flip, mirror);
    const NearestPoints edges(light.edge_mm);
    const std::vector<LoopMatch> matches = match_loops(loops_, not_rejected(scan, light.loops));
    std::vector<std::pair<double, RigidMotion>> starts(matches.size());
    parallel_for(matches.size(), 1, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        starts[i] = {score(light, edges, matches[i].scan_from_cad), matches[i].scan_from_cad};
    });
    std::stable_sort(starts.begin(), starts.end(), [](auto& a, auto& b) { return a.first < b.first; });
    if (starts.size() > refined) starts.resize(refined);
    std::vector<Candidate> found(starts.size());
    parallel_for(starts.size(), 1, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found[i] = refine(light, edges, starts[i].second);
    });
    for (Candidate& candidate : found) candidate.flip = flip, candidate.mirror = mirror;
    std::stable_sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.score_mm < b.score_mm; });
    return found;
  }

  /// True if the two poses put the contours in the same place, point by point or, where a motion along the
  /// contour is free (a circle), as curves.
  bool same_place(const Candidate& a, const Candidate& b) const {
    const RigidMotion g = a.scan_from_cad.inverse() * b.scan_from_cad;
    double moved = 0.0, off_curve = 0.0;
    for (const Eigen::Vector3d& p : samples_mm_) {
      moved = std::max(moved, (g * p - p).norm());
      double nearest = 1e300;
      for (const Curve& curve : cad_.contours) nearest = std::min(nearest, curve.nearest(g * p).distance_mm);
      off_curve = std::max(off_curve, nearest);
    }
    const double tolerance_mm = 0.06 * size_mm_;
    return moved < tolerance_mm || (!a.free.empty() && off_curve < tolerance_mm);
  }

 private:
  const CadModel& cad_;
  const CoarseAlignOptions& options_;
  std::vector<Contour> loops_;
  std::vector<Eigen::Vector3d> samples_mm_;
  double size_mm_ = 0.0, cap_mm_ = 0.0;
};

/// Corner to corner of the box around the points; mm.
double extent_mm(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points_mm) box.extend(p);
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

/// The unit in which a loop would fit, when none fits as stated and the scan's extent is not that of such a
/// part either: a scan of many small loops has one of any length.
double unit_that_fits(const CadModel& cad, const ScanModel& scan) {
  const double scan_mm = extent_mm(scan.points_mm);
  double part_mm = 0.0;  // of the largest: a whole plate in inches is as large as a small hole in millimetres
  for (const Curve& curve : cad.contours) part_mm = std::max(part_mm, extent_mm(curve.contour().points_mm));
  if (scan_mm > kExtentsAgree[0] * part_mm && scan_mm < kExtentsAgree[1] * part_mm) return 1.0;
  for (const double ratio : kUnitRatios)
    for (const Curve& curve : cad.contours) {
      const double scaled_extent = scan_mm * ratio / extent_mm(curve.contour().points_mm);
      if (scaled_extent < kExtentsAgree[0] || scaled_extent > kScaledExtentMost) continue;
      for (std::size_t l = 0; l < std::min(kLongestLoops, scan.loops.size()); ++l) {
        const double scaled = length_mm(scan.loops[l]) * ratio / curve.length_mm();
        if (scan.loops[l].closed && scaled > 0.8 && scaled < 1.25) return ratio;
      }
    }
  return 1.0;
}

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

CoarseAlignment from_initial(const ScanModel& scan, const CoarseAlignOptions& options, const Search& search) {
  CoarseAlignment result;
  result.start = "initial pose";
  Candidate best;
  for (const bool flip : {false, true}) {
    if (flip && scan.side == SideKnown::kYes) break;  // else the pose decides which side the normals are on
    const ScanModel light = hypothesis(scan, flip, false);
    Candidate refined = search.refine(light, NearestPoints(light.edge_mm), *options.initial_scan_from_cad);
    refined.flip = flip;
    if (refined.score_mm < best.score_mm) best = refined;
  }
  if (best.score_mm > 1e299) {
    result.reason = "no points in the band: the initial pose of the recipe puts no scan point near the part";
    result.no_points = true;
    return result;
  }
  result.scan_from_cad = best.scan_from_cad;
  result.score_mm = best.score_mm;
  result.flipped_normals = best.flip;
  const double turned = rotation_between_rad(*options.initial_scan_from_cad, best.scan_from_cad);
  if (turned > options.within_rad)
    result.reason =
        "the data turn the part by more than the initial pose allows (within_deg)" +
        search.free_by_surface(hypothesis(scan, best.flip, false), *options.initial_scan_from_cad);
  else if (options.edges_needed && best.score_mm > kInitialFitsRatio * search.size_mm())
    result.reason = "the initial pose does not fit: the scan's edge stays " + millimetres(best.score_mm) +
                    " mm from the contours";
  return result;
}

/// What a score holds beyond the offset of angle-gap edge points, about a spacing.
double beyond_spacing(double score_mm, const ScanModel& scan) {
  return std::sqrt(std::max(0.0, score_mm * score_mm - scan.spacing_mm * scan.spacing_mm));
}

std::string ambiguity(const Candidate& best, const Candidate& other, double ratio) {
  if (best.flip != other.flip)
    return "both sides of the part fit alike (runner-up " + percent(ratio) +
           " of the best): nothing says which side the scanner saw; give normals in the file, scan.seen_from "
           "or "
           "scan.initial";
  return "two poses fit alike (runner-up " + percent(ratio) +
         " of the best): scan also a hole or a corner that tells them apart, or give scan.initial in the "
         "recipe";
}

}  // namespace

std::vector<std::string> free_directions(const Eigen::Matrix<double, 6, 6>& information,
                                         const Eigen::Vector3d& pivot_mm, double size_mm) {
  std::vector<std::string> words;
  Eigen::Matrix<double, 6, 1> scale;
  scale << Eigen::Vector3d::Constant(1.0 / size_mm), Eigen::Vector3d::Ones();
  const Eigen::Matrix<double, 6, 6> scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(scaled);
  for (int i = 0; i < 6; ++i) {
    if (eigen.eigenvalues()[i] > kFreeEigenvalueRatio * eigen.eigenvalues()[5]) continue;
    const Eigen::Vector3d turn = eigen.eigenvectors().col(i).head<3>();
    const Eigen::Vector3d shift = eigen.eigenvectors().col(i).tail<3>();
    const bool is_turn = turn.norm() > 0.5;
    const Eigen::Vector3d axis = (is_turn ? turn : shift).normalized();
    // A screw about the pivot: its axis passes where the shift is undone by the turn.
    const Eigen::Vector3d through =
        is_turn ? Eigen::Vector3d(pivot_mm + axis.cross(shift) * size_mm / turn.norm()) : pivot_mm;
    char text[200];
    std::snprintf(text, sizeof text, "%s (%.3f %.3f %.3f) through (%.1f %.1f %.1f) mm, CAD frame",
                  is_turn ? "turn about the axis" : "shift along", axis.x(), axis.y(), axis.z(), through.x(),
                  through.y(), through.z());
    words.emplace_back(text);
  }
  return words;
}

CoarseAlignment coarse_align(const CadModel& cad, const ScanModel& scan, const CoarseAlignOptions& options) {
  const Search search(cad, options);
  if (options.initial_scan_from_cad) return from_initial(scan, options, search);

  CoarseAlignment result;
  result.start = "matching loops";
  std::vector<Candidate> proper = search.candidates(scan, false, false, kRefined);
  const bool side_open = scan.side == SideKnown::kNo;
  if (side_open) {
    const std::vector<Candidate> flipped = search.candidates(scan, true, false, kRefined);
    proper.insert(proper.end(), flipped.begin(), flipped.end());
    std::stable_sort(proper.begin(), proper.end(), [](auto& a, auto& b) { return a.score_mm < b.score_mm; });
  }
  if (proper.empty() || proper.front().score_mm > 1e299) {
    result.unit_ratio = unit_that_fits(cad, scan);
    result.reason = options.edges_needed
                        ? "no closed contour of the scan has the length of an accepted CAD contour"
                        : "role cut: no outline and no datum hole of the drawing is in the scan as a closed "
                          "loop, so every "
                          "slide along the face and the turn about its normal are free; scan one of them all "
                          "round, or give "
                          "scan.initial";
    return result;
  }
  const Candidate& best = proper.front();
  result.scan_from_cad = best.scan_from_cad;
  result.score_mm = best.score_mm;
  result.flipped_normals = best.flip;
  const std::vector<Candidate> mirrored = search.candidates(scan, false, true, 2);
  if (!mirrored.empty()) result.mirror_ratio = mirrored.front().score_mm / best.score_mm;
  if (!side_open && best.score_mm > 2.0 * scan.spacing_mm) {
    const auto fits_better = [&](const std::vector<Candidate>& others) {
      return !others.empty() && beyond_spacing(others.front().score_mm, scan) <
                                    kMirrorBetterRatio * beyond_spacing(best.score_mm, scan);
    };
    result.mirrored = fits_better(mirrored);
    result.inverted = fits_better(search.candidates(scan, true, false, 2));
    if (result.mirrored || result.inverted) {
      result.reason = result.mirrored
                          ? "the mirror image of the scan fits the part and the scan itself does not"
                          : "the scan fits the part with its normals turned round, and not as they are";
      return result;
    }
  }
  if (best.score_mm > kFitsCapRatio * search.cap_mm()) {  // then every pose is about as bad as another
    result.reason = "no pose fits: the best one leaves " + millimetres(best.score_mm) +
                    " mm between scan and part; is it this part, and does the scan show the contour?";
    result.unit_ratio = unit_that_fits(cad, scan);
    return result;
  }
  for (const Candidate& other : proper) {
    if (&other == &best || other.score_mm > 1e299) continue;
    if (other.flip == best.flip && search.same_place(best, other)) continue;
    result.runner_up_ratio = other.score_mm / best.score_mm;
    if (result.runner_up_ratio < options.ambiguity_ratio)
      result.reason = ambiguity(best, other, result.runner_up_ratio) +
                      (options.edges_needed
                           ? std::string()
                           : search.free_by_surface(hypothesis(scan, best.flip, false), best.scan_from_cad));
    break;
  }
  // Shape alone would take a mirrored scan, and an inverted drawing, as they come.
  if (result.usable() && side_open)
    result.reason =
        "nothing says which side of the part the scanner saw: give normals in the file, scan.seen_from (a "
        "point "
        "in the air in front of the part) or scan.initial";
  // A bent part that is nearly its own mirror image fits either way: only said, not called mirrored.
  if (!result.usable() && !side_open && result.mirror_ratio > 0.0 &&
      result.mirror_ratio < kMirrorOfAmbiguousRatio)
    result.reason += "; the scan's mirror image fits better (" + percent(result.mirror_ratio) +
                     " of the best): was it exported mirrored?";
  if (!result.usable()) result.unit_ratio = unit_that_fits(cad, scan);
  return result;
}

}  // namespace arris
