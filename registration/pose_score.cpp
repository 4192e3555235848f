#include "registration/pose_score.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"
#include "registration/edge_pairs.hpp"

namespace arris {
namespace {

constexpr std::size_t kSurfaceSample = 160, kLightPoints = 8 * kSurfaceSample;
constexpr std::size_t kEdgeScored = 2000;  // a thinned edge would score its own gaps, some 5 mm
constexpr int kContourSamples = 60, kOtherSamples = 16;
constexpr std::size_t kLoopSample = 12;
constexpr double kCapRatio = 0.15;  // of the contour's size
constexpr double kPatientKept = 0.8, kMiddleKept = 0.85, kStrictKept = 0.95, kSurfaceKept = 0.8;
constexpr double kBesideRatio = 0.3;  // of the cap: lower or higher than this past an edge is not the part
constexpr double kCoveredSpacings = 3.0;
constexpr double kCoveredRatio = 0.6;  // of a contour's samples
constexpr double kLengthsAgree = 0.2;  // of a hole of the scan and one of the drawing
constexpr double kCosNormalsAgree = 0.5;
constexpr double kShownRatio = 0.7, kShownSpacings = 1.5;  // of the cap; of the spacing
constexpr double kFaceRatio = 0.3;      // of the points that an even scan has there: the face is seen
constexpr double kGoesOnRatio = 0.5;    // .. beyond the edge: it is no edge; strays are fewer
constexpr double kGoesOnSlope = 0.3;    // how steep the face may be against the drawing's
constexpr double kHiddenRatio = 0.4;    // of the cap: what a place costs where nothing can be told
constexpr double kProbeSpacings = 2.0;  // beside an edge: where the scan has material, and where none
constexpr double kProbeRatio = 0.075, kProbeMostRatio = 0.5;  // of the contour's size
constexpr double kProbeHeightRatio = 0.5;  // of the cap: a bent part stands off its drawing
constexpr double kProbeSeesRatio = 0.8;    // of the distance from the edge
constexpr double kFootSpacings = 60.0;     // a loop of a larger radius is no foot of a clamp
constexpr std::size_t kFewestOnSurface = 10;

/// Mean of the smallest share of the values: what a gap or a clamp adds is not judged.
double trimmed_mean(std::vector<double>& values, double kept_ratio) {
  std::sort(values.begin(), values.end());
  const std::size_t kept =
      std::max<std::size_t>(1, static_cast<std::size_t>(kept_ratio * double(values.size())));
  double sum = 0.0;
  for (std::size_t i = 0; i < kept; ++i) sum += values[i];
  return sum / static_cast<double>(kept);
}

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

void reflect(std::vector<Eigen::Vector3d>& list) {
  for (Eigen::Vector3d& p : list) p.x() = -p.x();
}

void negate(std::vector<Eigen::Vector3d>& list) {
  for (Eigen::Vector3d& n : list) n = -n;
}

ScanModel light_copy(const ScanModel& scan, bool flip, bool mirror) {
  ScanModel light{every(scan.points_mm, kLightPoints),
                  every(scan.normals, kLightPoints),
                  NearestPoints({}),
                  scan.loops,
                  every(scan.edge_mm, kEdgeScored),
                  every(scan.edge_normals, kEdgeScored),
                  scan.spacing_mm,
                  scan.noise_sigma_mm,
                  SideKnown::kYes,
                  scan.loop_rejected};
  if (mirror) {
    for (auto* list : {&light.points_mm, &light.normals, &light.edge_mm, &light.edge_normals}) reflect(*list);
    for (Contour& loop : light.loops) reflect(loop.points_mm), reflect(loop.normals);
  }
  if (flip) {
    for (auto* list : {&light.normals, &light.edge_normals}) negate(*list);
    for (Contour& loop : light.loops) negate(loop.normals);
  }
  if (flip != mirror)
    for (Contour& loop : light.loops) {
      std::reverse(loop.points_mm.begin(), loop.points_mm.end());
      std::reverse(loop.normals.begin(), loop.normals.end());
    }
  return light;
}

std::vector<Eigen::Vector3d> places_along(const Curve& curve, int count) {
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < count; ++i) places.push_back(curve.point_mm(i * curve.length_mm() / count));
  return places;
}

/// Square of what a distance holds beyond the offset of angle-gap edge points.
double beyond2(double distance2_mm2, const LightScan& scan) {
  return std::pow(std::max(0.0, std::sqrt(distance2_mm2) - scan.model.spacing_mm), 2);
}

}  // namespace

LightScan::LightScan(const ScanModel& scan, bool flip, bool mirror)
    : model(light_copy(scan, flip, mirror)),
      edges(model.edge_mm),
      spacing_mm(scan.spacing_mm *
                 std::sqrt(std::max(1.0, double(scan.points_mm.size()) / double(kLightPoints)))),
      scan_(scan),
      flip_(flip),
      mirror_(mirror) {
  for (const Contour& loop : model.loops) stood_on.push_back(is_stood_on(loop));
}

/// Whether most of what the scan shows within a small loop that runs around no material stands over it.
bool LightScan::is_stood_on(const Contour& loop) const {
  const double radius_mm = length_mm(loop) / 6.28;
  if (loop.points_mm.size() < 8 || radius_mm > kFootSpacings * scan_.spacing_mm || runs_around_material(loop))
    return false;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), up = middle;
  for (const Eigen::Vector3d& p : loop.points_mm) middle += p / static_cast<double>(loop.points_mm.size());
  for (const Eigen::Vector3d& n : loop.normals) up += n;
  middle = unmirrored(middle), up = unmirrored(up.normalized());
  std::vector<Neighbour> near;
  scan_.tree.within(middle, 2.0 * radius_mm, near);
  const auto over = std::count_if(near.begin(), near.end(), [&](const Neighbour& n) {
    const double over_mm = up.dot(scan_.points_mm[static_cast<std::size_t>(n.index)] - middle);
    return over_mm > 0.2 * radius_mm && n.distance2_mm2 - over_mm * over_mm < radius_mm * radius_mm;
  });
  const double even = 3.14 * radius_mm * radius_mm / (scan_.spacing_mm * scan_.spacing_mm);
  return static_cast<double>(over) > kFaceRatio * even;
}

bool LightScan::covers(const Eigen::Vector3d& p_mm, double reach_mm) const {
  const Neighbour nearest = scan_.tree.nearest(unmirrored(p_mm));
  return nearest.index >= 0 && nearest.distance2_mm2 < reach_mm * reach_mm;
}

LightScan::Patch LightScan::patch_at(const Eigen::Vector3d& p_mm, const Eigen::Vector3d& normal,
                                     double reach_mm, double height_mm) const {
  const double even = 3.14 * reach_mm * reach_mm / (scan_.spacing_mm * scan_.spacing_mm);
  const Eigen::Vector3d p = unmirrored(p_mm), up = unmirrored(normal);
  std::vector<Neighbour> near;
  scan_.tree.within(p, std::hypot(reach_mm, height_mm), near);
  std::vector<double> heights_mm;
  for (const Neighbour& n : near) {
    const auto i = static_cast<std::size_t>(n.index);
    const double over_mm = up.dot(scan_.points_mm[i] - p), cosine = up.dot(scan_.normals[i]);
    if (std::abs(over_mm) < height_mm && n.distance2_mm2 - over_mm * over_mm < reach_mm * reach_mm &&
        (flip_ ? -cosine : cosine) > kCosNormalsAgree)
      heights_mm.push_back(over_mm);
  }
  if (heights_mm.empty()) return {};
  return {static_cast<double>(heights_mm.size()) / std::max(1.0, even), median_of(std::move(heights_mm))};
}

PoseScore::PoseScore(const CadModel& cad, double band_mm) : cad_(cad), band_mm_(band_mm) {
  for (const Curve& curve : cad.contours) {
    for (int i = 0; i < kContourSamples; ++i) {
      const double s_mm = i * curve.length_mm() / kContourSamples;
      samples_.push_back(
          {curve.point_mm(s_mm), inward_of(curve, s_mm), curve.normal(s_mm), curve.length_mm() / 6.28});
    }
    size_mm_ = std::max(size_mm_, curve.length_mm() / 6.28);
  }
  cap_mm_ = kCapRatio * size_mm_;
  for (const Curve& curve : cad.others) {
    others_mm_.push_back(places_along(curve, kOtherSamples));
    if (!runs_around_material(curve.contour())) hole_length_mm_.push_back(curve.length_mm());
  }
}

/// What a place costs, squared, where nothing can be told.
double PoseScore::hidden2(const LightScan& scan) const {
  return std::min(cap_mm_ * cap_mm_,
                  std::pow(kHiddenRatio * cap_mm_, 2) + std::pow(scan.model.spacing_mm, 2));
}

std::vector<PoseScore::Place> PoseScore::edges(const LightScan& scan,
                                               const RigidMotion& scan_from_cad) const {
  const double cap2 = cap_mm_ * cap_mm_;
  std::vector<Place> places;
  for (const Sample& sample : samples_) {
    const Neighbour nearest = scan.edges.nearest(scan_from_cad * sample.place_mm);
    places.push_back({nearest.index < 0 ? cap2 : std::min(cap2, nearest.distance2_mm2), Seen::kEdge});
  }
  return places;
}

/// Where the contour would run over the scan's face, no edge of the scan counts: a cluttered scan has edges
/// everywhere. Where the face beside it is not in the scan, nothing can be told.
void PoseScore::judge_support(const LightScan& scan, const RigidMotion& scan_from_cad,
                              std::vector<Place>& places) const {
  const double cap2 = cap_mm_ * cap_mm_;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& s = samples_[i];
    const double probe_mm =
        std::min(kProbeMostRatio * s.size_mm,
                 std::max(kProbeSpacings * scan.model.spacing_mm, kProbeRatio * s.size_mm));
    const double reach_mm = kProbeSeesRatio * probe_mm;
    const Eigen::Vector3d up = scan_from_cad.linear() * s.normal;
    const LightScan::Patch face = scan.patch_at(scan_from_cad * (s.place_mm + probe_mm * s.inward), up,
                                                reach_mm, kProbeHeightRatio * cap_mm_);
    if (face.covered_ratio < kFaceRatio) {
      places[i] = {hidden2(scan), Seen::kNothing};
      continue;
    }
    const Eigen::Vector3d outside = scan_from_cad * (s.place_mm - probe_mm * s.inward);
    const LightScan::Patch beyond =
        scan.patch_at(outside + face.height_mm * up, up, reach_mm, kGoesOnSlope * reach_mm);
    if (beyond.covered_ratio >= kGoesOnRatio) places[i] = {cap2, Seen::kFaceGoesOn};
  }
}

/// Of scan points in the band. A table seen through an opening is no evidence: its foot is an edge of the
/// part, and it lies lower. Points over the face or in it are, whatever they are, for the part should be
/// seen.
std::vector<double> PoseScore::surface2(const LightScan& scan, const RigidMotion& cad_from_scan) const {
  const double cap2 = cap_mm_ * cap_mm_;
  std::vector<double> squared;
  for (std::size_t i = 0; i < scan.model.points_mm.size() && squared.size() < kSurfaceSample; ++i) {
    const Eigen::Vector3d x = cad_from_scan * scan.model.points_mm[i];
    if (pair_edge(cad_, x, band_mm_).contour < 0) continue;
    const SurfacePoint foot = cad_.surface.closest(x, band_mm_);
    if (foot.triangle >= 0 && foot.on_border &&
        std::abs(foot.normal.dot(x - foot.foot_mm)) > kBesideRatio * cap_mm_)
      continue;
    const bool agrees = foot.triangle >= 0 &&
                        foot.normal.dot(cad_from_scan.linear() * scan.model.normals[i]) > kCosNormalsAgree;
    const double off2 = foot.distance_mm * foot.distance_mm;
    const bool over = foot.triangle >= 0 && foot.normal.dot(x - foot.foot_mm) > kBesideRatio * cap_mm_;
    squared.push_back(std::min(agrees ? off2 : cap2, over ? hidden2(scan) : cap2));
  }
  return squared;
}

/// Mean over the drawing's other contours that the scan covers: squared distance, median along the contour,
/// from the scan's edge. A second hole in the wrong place gives a wrong pose away.
double PoseScore::other_contours2(const LightScan& scan, const RigidMotion& scan_from_cad) const {
  const double cap2 = cap_mm_ * cap_mm_;
  double sum = 0.0;
  int counted = 0;
  for (const std::vector<Eigen::Vector3d>& places_mm : others_mm_) {
    std::vector<double> off2;
    for (const Eigen::Vector3d& p : places_mm) {
      const Eigen::Vector3d x = scan_from_cad * p;
      if (!scan.covers(x, kCoveredSpacings * scan.model.spacing_mm)) continue;
      const Neighbour nearest = scan.edges.nearest(x);
      off2.push_back(nearest.index < 0 ? cap2 : std::min(cap2, beyond2(nearest.distance2_mm2, scan)));
    }
    if (double(off2.size()) < kCoveredRatio * double(places_mm.size())) continue;
    sum += median_of(std::move(off2));
    ++counted;
  }
  return counted == 0 ? 0.0 : sum / counted;
}

/// Whether a loop of the scan may be another hole of the CAD: it runs around no material, as the border of
/// what was scanned does, and has the length of one, as the rim of a gap has hardly ever.
bool PoseScore::may_be_other_hole(const Contour& loop) const {
  if (hole_length_mm_.empty() || loop.points_mm.size() < 8 || runs_around_material(loop)) return false;
  const double loop_mm = length_mm(loop);
  return std::any_of(hole_length_mm_.begin(), hole_length_mm_.end(),
                     [&](double hole_mm) { return std::abs(loop_mm - hole_mm) < kLengthsAgree * hole_mm; });
}

/// Mean over the better half of the scan's holes of the squared distance, median along the hole, from the
/// CAD's contours, followed or not: the feet of clamps make loops as well.
double PoseScore::stray_holes2(const LightScan& scan, const RigidMotion& cad_from_scan) const {
  std::vector<double> loop2;
  for (std::size_t l = 0; l < scan.model.loops.size(); ++l) {
    const Contour& loop = scan.model.loops[l];
    if (scan.stood_on[l] || !may_be_other_hole(loop)) continue;
    const std::size_t stride = std::max<std::size_t>(1, loop.points_mm.size() / kLoopSample);
    std::vector<double> off2;
    int beside = 0;
    for (std::size_t i = 0; i < loop.points_mm.size(); i += stride) {
      const Eigen::Vector3d x = cad_from_scan * loop.points_mm[i];
      beside += cad_.surface.closest(x, kBesideRatio * cap_mm_).triangle < 0;
      double nearest_mm = cap_mm_;
      for (const auto* curves : {&cad_.contours, &cad_.others})
        for (const Curve& curve : *curves) nearest_mm = std::min(nearest_mm, curve.nearest(x).distance_mm);
      off2.push_back(beyond2(nearest_mm * nearest_mm, scan));
    }
    if (2 * beside > static_cast<int>(off2.size())) continue;  // of a clamp or the table
    loop2.push_back(median_of(std::move(off2)));               // around a gap the loop leaves the edge
  }
  return loop2.empty() ? 0.0 : trimmed_mean(loop2, 0.5 + 0.5 / double(loop2.size()));
}

PoseMisfit PoseScore::of_start(const LightScan& scan, const RigidMotion& scan_from_cad) const {
  return misfit(scan, scan_from_cad, edges(scan, scan_from_cad));
}

PoseMisfit PoseScore::of(const LightScan& scan, const RigidMotion& scan_from_cad) const {
  std::vector<Place> places = edges(scan, scan_from_cad);
  judge_support(scan, scan_from_cad, places);
  return misfit(scan, scan_from_cad, places);
}

PoseMisfit PoseScore::misfit(const LightScan& scan, const RigidMotion& scan_from_cad,
                             const std::vector<Place>& places) const {
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  std::vector<double> surface = surface2(scan, cad_from_scan);
  if (surface.size() < kFewestOnSurface) return {cap_mm_, cap_mm_, cap_mm_, 0.0, 0.0};
  const double shown2 = std::pow(std::max(kShownRatio * cap_mm_, kShownSpacings * scan.model.spacing_mm), 2);
  PoseMisfit misfit{0.0, 0.0, 0.0, 0.0, 0.0};
  const double share = 1.0 / static_cast<double>(cad_.contours.size());
  for (std::size_t c = 0; c < cad_.contours.size(); ++c) {  // one by one: a small one counts as a large one
    std::vector<double> along;
    for (std::size_t i = c * kContourSamples; i < (c + 1) * kContourSamples; ++i) {
      along.push_back(places[i].off2_mm2);
      const bool shown = places[i].seen == Seen::kEdge && places[i].off2_mm2 < shown2;
      misfit.shown_ratio += shown * share / kContourSamples;
      misfit.against_ratio += (places[i].seen == Seen::kFaceGoesOn) * share / kContourSamples;
    }
    misfit.patient_mm += share * trimmed_mean(along, kPatientKept);
    misfit.middle_mm += share * trimmed_mean(along, kMiddleKept);
    misfit.strict_mm += share * trimmed_mean(along, kStrictKept);
  }
  const double rest = trimmed_mean(surface, kSurfaceKept) + other_contours2(scan, scan_from_cad) +
                      stray_holes2(scan, cad_from_scan);
  misfit.patient_mm = std::sqrt(misfit.patient_mm + rest);
  misfit.middle_mm = std::sqrt(misfit.middle_mm + rest);
  misfit.strict_mm = std::sqrt(misfit.strict_mm + rest);
  return misfit;
}

}  // namespace arris
