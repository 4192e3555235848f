#include "registration/pose_score.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"
#include "registration/edge_pairs.hpp"

namespace arris {
namespace {

constexpr std::size_t kSurfaceSample = 160;
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
    if (!near_contours(cad_, x, band_mm_)) continue;
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
PoseScore::Others PoseScore::other_contours(const LightScan& scan, const RigidMotion& scan_from_cad) const {
  const double cap2 = cap_mm_ * cap_mm_;
  Others others;
  for (const std::vector<Eigen::Vector3d>& places_mm : others_mm_) {
    std::vector<double> off2;
    for (const Eigen::Vector3d& p : places_mm) {
      const Eigen::Vector3d x = scan_from_cad * p;
      if (!scan.covers(x, kCoveredSpacings * scan.model.spacing_mm)) continue;
      const Neighbour nearest = scan.edges.nearest(x);
      off2.push_back(nearest.index < 0 ? cap2 : std::min(cap2, beyond2(nearest.distance2_mm2, scan)));
    }
    if (double(off2.size()) < kCoveredRatio * double(places_mm.size())) continue;
    others.off2_mm2 += median_of(std::move(off2));
    ++others.counted;
  }
  if (others.counted > 0) others.off2_mm2 /= others.counted;
  return others;
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

double PoseScore::least_of_start_mm(const LightScan& scan, const RigidMotion& scan_from_cad) const {
  const std::vector<Place> places = edges(scan, scan_from_cad);
  const double share = 1.0 / static_cast<double>(cad_.contours.size());
  double patient_mm2 = 0.0;
  for (std::size_t c = 0; c < cad_.contours.size(); ++c) {
    std::vector<double> along;
    for (std::size_t i = c * kContourSamples; i < (c + 1) * kContourSamples; ++i)
      along.push_back(places[i].off2_mm2);
    patient_mm2 += share * trimmed_mean(along, kPatientKept);
  }
  return std::sqrt(patient_mm2);
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
  if (surface.size() < kFewestOnSurface) return {cap_mm_, cap_mm_, cap_mm_, cap_mm_};
  const double shown2 = std::pow(std::max(kShownRatio * cap_mm_, kShownSpacings * scan.model.spacing_mm), 2);
  PoseMisfit misfit{0.0, 0.0, 0.0, 0.0};
  const double share = 1.0 / static_cast<double>(cad_.contours.size());
  for (std::size_t c = 0; c < cad_.contours.size(); ++c) {  // one by one: a small one counts as a large one
    std::vector<double> along, telling;
    for (std::size_t i = c * kContourSamples; i < (c + 1) * kContourSamples; ++i) {
      along.push_back(places[i].off2_mm2);
      if (places[i].seen != Seen::kNothing) telling.push_back(places[i].off2_mm2);
      const bool shown = places[i].seen == Seen::kEdge && places[i].off2_mm2 < shown2;
      misfit.shown_ratio += shown * share / kContourSamples;
      misfit.against_ratio += (places[i].seen == Seen::kFaceGoesOn) * share / kContourSamples;
    }
    if (!telling.empty()) misfit.seen_mm += share * trimmed_mean(telling, kPatientKept);
    misfit.patient_mm += share * trimmed_mean(along, kPatientKept);
    misfit.middle_mm += share * trimmed_mean(along, kMiddleKept);
    misfit.strict_mm += share * trimmed_mean(along, kStrictKept);
  }
  const Others others = other_contours(scan, scan_from_cad);
  misfit.others_mm = std::sqrt(others.off2_mm2);
  misfit.others = others.counted;
  const double rest =
      trimmed_mean(surface, kSurfaceKept) + others.off2_mm2 + stray_holes2(scan, cad_from_scan);
  misfit.seen_mm = std::sqrt(misfit.seen_mm + rest);
  misfit.patient_mm = std::sqrt(misfit.patient_mm + rest);
  misfit.middle_mm = std::sqrt(misfit.middle_mm + rest);
  misfit.strict_mm = std::sqrt(misfit.strict_mm + rest);
  return misfit;
}

}  // namespace arris
