#include "registration/light_scan.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"

namespace arris {
namespace {

constexpr std::size_t kLightPoints = 1280;
constexpr std::size_t kEdgeScored = 2000;  // a thinned edge would score its own gaps, some 5 mm
constexpr double kCosNormalsAgree = 0.5;
constexpr double kFootSpacings = 60.0;  // a loop of a larger radius is no foot of a clamp
constexpr double kStandsRatio = 0.3;    // of the points that an even scan of what stands there has

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

}  // namespace

bool runs_around_material(const Contour& loop) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero(), normal = area;
  const std::size_t n = loop.points_mm.size();
  for (std::size_t i = 0; i < n; ++i) {
    area += (loop.points_mm[i] - loop.points_mm[0]).cross(loop.points_mm[(i + 1) % n] - loop.points_mm[0]);
    normal += loop.normals[i];
  }
  return area.dot(normal) > 0.0;
}

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
  return static_cast<double>(over) > kStandsRatio * even;
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

}  // namespace arris
