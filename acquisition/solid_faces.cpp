#include "acquisition/solid_faces.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/polyline.hpp"
#include "acquisition/geometry/surface_query.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr double kSeenCos = 0.5;  // 60 degrees, as for partners of points
constexpr std::size_t kThicknessSamples = 400;
constexpr std::size_t kPartnerSamples = 60;

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// How two rims lie to each other: mean distance, and mean cosine of their normals.
struct RimPair {
  double distance_mm = 0.0, cosine = 0.0;
};

RimPair compare(const Contour& contour, const Contour& other) {
  const Curve curve(other);
  const std::size_t stride = std::max<std::size_t>(1, contour.points_mm.size() / kPartnerSamples);
  RimPair pair;
  double count = 0.0;
  for (std::size_t i = 0; i < contour.points_mm.size(); i += stride, count += 1.0) {
    const CurveFoot foot = curve.nearest(contour.points_mm[i]);
    pair.distance_mm += foot.distance_mm;
    pair.cosine += contour.normals[i].dot(curve.normal(foot.arc_mm));
  }
  return {pair.distance_mm / count, pair.cosine / count};
}

}  // namespace

SolidFaces::SolidFaces(const TriangleMesh& solid, double sharp_edge_rad) : solid_(solid), vertex_(solid) {
  const MeshAdjacency neighbours = adjacency(solid);
  regions_ = smooth_regions(solid, neighbours, face_normals(solid, neighbours), sharp_edge_rad);
  for (std::size_t t = 0; t < solid.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      triangle_of_side_[{solid.triangles[t][k], solid.triangles[t][(k + 1) % 3]}] =
          static_cast<std::int32_t>(t);
}

std::vector<int> SolidFaces::regions_beside(const Contour& contour, bool beyond) const {
  std::vector<int> beside;
  for (std::size_t i = 0; i < contour.points_mm.size(); ++i) {
    auto a = static_cast<std::int32_t>(vertex_(contour.points_mm[i]));
    auto b = static_cast<std::int32_t>(vertex_(contour.points_mm[(i + 1) % contour.points_mm.size()]));
    if (beyond) std::swap(a, b);
    if (const auto side = triangle_of_side_.find({a, b}); side != triangle_of_side_.end())
      beside.push_back(regions_.of[at(side->second)]);
  }
  std::sort(beside.begin(), beside.end());
  beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
  if (beside.empty()) throw Error(Fault::kBug, "a contour runs along no side of its mesh");
  return beside;
}

const Contour* SolidFaces::partner_of(const Contour& contour, std::span<const Contour> all) const {
  const std::vector<int> walls = regions_beside(contour, true);
  const auto is_wall = [&](int region) { return std::binary_search(walls.begin(), walls.end(), region); };
  const Contour* partner = nullptr;
  double nearest_mm = 0.0;
  for (const Contour& other : all) {
    if (other.id == contour.id || is_wall(face_of(other))) continue;
    const std::vector<int> beyond = regions_beside(other, true);
    if (std::none_of(beyond.begin(), beyond.end(), is_wall)) continue;
    const RimPair pair = compare(contour, other);
    if (pair.cosine > -kSeenCos || (partner != nullptr && pair.distance_mm >= nearest_mm)) continue;
    partner = &other;
    nearest_mm = pair.distance_mm;
  }
  return partner;
}

std::vector<int> SolidFaces::visible_with(std::vector<int> faces, const Vector3d& towards) const {
  for (std::size_t region = 0; region < regions_.mean_normal.size(); ++region)
    if (regions_.mean_normal[region].dot(towards) >= kSeenCos) faces.push_back(static_cast<int>(region));
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

TriangleMesh SolidFaces::mesh_of(const std::vector<int>& regions) const {
  TriangleMesh mesh;
  std::vector<std::int32_t> number(solid_.vertices_mm.size(), -1);
  for (std::size_t t = 0; t < solid_.triangles.size(); ++t) {
    if (std::find(regions.begin(), regions.end(), regions_.of[t]) == regions.end()) continue;
    auto& corners = mesh.triangles.emplace_back(solid_.triangles[t]);
    for (std::int32_t& v : corners) {
      if (number[at(v)] < 0) {
        number[at(v)] = static_cast<std::int32_t>(mesh.vertices_mm.size());
        mesh.vertices_mm.push_back(solid_.vertices_mm[at(v)]);
      }
      v = number[at(v)];
    }
  }
  return mesh;
}

SolidThickness SolidFaces::thickness_behind(int face) const {
  const Vector3d& towards = regions_.mean_normal[static_cast<std::size_t>(face)];
  std::vector<int> behind;
  for (std::size_t region = 0; region < regions_.mean_normal.size(); ++region)
    if (regions_.mean_normal[region].dot(towards.normalized()) <= -kSeenCos)
      behind.push_back(static_cast<int>(region));
  if (behind.empty()) return {};
  const TriangleMesh front = mesh_of({face}), back = mesh_of(behind);
  const SurfaceQuery query(back);
  std::vector<double> distances_mm;
  const std::size_t stride = std::max<std::size_t>(1, front.triangles.size() / kThicknessSamples);
  for (std::size_t t = 0; t < front.triangles.size(); t += stride) {
    Vector3d middle_mm = Vector3d::Zero();
    for (const std::int32_t v : front.triangles[t]) middle_mm += front.vertices_mm[at(v)] / 3.0;
    distances_mm.push_back(query.closest(middle_mm).distance_mm);
  }
  std::sort(distances_mm.begin(), distances_mm.end());
  const auto quantile = [&](double share) {
    return distances_mm[static_cast<std::size_t>(share * static_cast<double>(distances_mm.size() - 1))];
  };
  return {quantile(0.5), quantile(0.9) - quantile(0.1), true};
}

}  // namespace arris
