#include "registration/surface_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/curve_order.hpp"
#include "acquisition/geometry/median.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "registration/normal_equations.hpp"
#include "registration/surface_shape.hpp"

namespace arris {
namespace {

constexpr double kCosNormalsAgree = 0.5;  // correspondences need normals within 60 degrees
constexpr double kSameFootMm = 0.1;  // beside its foot a point still sees the tangent plane: off by < 0.1 um
constexpr std::size_t kChunk = 256;

bool normals_agree(const ScanModel& scan, const Eigen::Vector3d& deformed, const Eigen::Vector3d& measured) {
  const double cosine = deformed.dot(measured);
  return (scan.side == SideKnown::kYes ? cosine : std::abs(cosine)) > kCosNormalsAgree;
}

/// Residual to the deformed surface at the pair's foot; returns how far the point lies beside that foot.
double look_from_foot(const std::vector<Eigen::Vector3d>& shift_mm, SurfacePair& pair) {
  const LocalShape shape = local_shape(pair.row, shift_mm);
  const Eigen::Vector3d apart_mm = pair.p_mm - pair.foot_mm - shape.shift_mm;
  pair.guess_mm = shape.shift_mm;
  pair.normal = shape.normal;
  pair.residual_mm = shape.normal.dot(apart_mm);
  return (apart_mm - pair.residual_mm * shape.normal).norm();
}

void find_partner(const CadModel& cad, const SurfaceBasis& basis,
                  const std::vector<Eigen::Vector3d>& shift_mm, double reach_mm, SurfacePair& pair) {
  if (pair.row.usable() && look_from_foot(shift_mm, pair) < kSameFootMm) return;
  pair.row = {};
  const SurfacePoint foot = cad.surface.closest(pair.p_mm - pair.guess_mm, reach_mm, pair.triangle);
  pair.triangle = foot.triangle;
  if (foot.triangle < 0) return;
  pair.foot_mm = foot.foot_mm;
  pair.on_border = foot.on_border;
  pair.row = basis.row(foot.foot_mm, cad.smooth_normal(foot));
  if (pair.row.usable()) look_from_foot(shift_mm, pair);
}

}  // namespace

std::vector<std::size_t> points_near(const CadModel& cad, const ScanModel& scan,
                                     const RigidMotion& scan_from_cad, double reach_mm, int threads) {
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  std::vector<char> near(scan.points_mm.size(), reach_mm < 0.0 ? 1 : 0);
  if (reach_mm >= 0.0)
    parallel_for(near.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Eigen::Vector3d p_mm = cad_from_scan * scan.points_mm[i];
        for (const Curve& curve : cad.contours)
          if (curve.is_within(p_mm, reach_mm)) near[i] = 1;
      }
    });
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i]) points.push_back(i);
  return points;
}

std::vector<std::size_t> beside_each_other(const ScanModel& scan, const std::vector<std::size_t>& points,
                                           int threads) {
  std::vector<Eigen::Vector3f> places_mm;
  for (const std::size_t i : points) places_mm.push_back(scan.points_mm[i].cast<float>());
  std::vector<std::size_t> ordered;
  for (const std::uint32_t k : curve_order(places_mm, threads)) ordered.push_back(points[k]);
  return ordered;
}

void pair_surface(const CadModel& cad, const ScanModel& scan, const std::vector<std::size_t>& points,
                  const RigidMotion& scan_from_cad, const SurfaceBasis& basis,
                  const std::vector<Eigen::Vector3d>& shift_mm, double reach_mm, int threads,
                  std::vector<SurfacePair>& pairs) {
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  pairs.resize(points.size());
  parallel_for(points.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SurfacePair& pair = pairs[i];
      pair.p_mm = cad_from_scan * scan.points_mm[points[i]];
      find_partner(cad, basis, shift_mm, reach_mm, pair);
      pair.on_face = pair.row.usable() && !pair.on_border &&
                     normals_agree(scan, pair.normal, cad_from_scan.linear() * scan.normals[points[i]]);
    }
  });
}

void renew_rows(const SurfaceBasis& basis, int threads, std::vector<SurfacePair>& pairs) {
  parallel_for(pairs.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (pairs[i].row.usable()) pairs[i].row = basis.row(pairs[i].foot_mm, pairs[i].row.normal);
  });
}

double residual_sigma_mm(const std::vector<SurfacePair>& pairs, double scale_mm) {
  std::vector<double> sizes;
  for (const SurfacePair& pair : pairs)
    if (pair.on_face && std::abs(pair.residual_mm) < 2.0 * scale_mm)
      sizes.push_back(std::abs(pair.residual_mm));
  return 1.4826 * median_of(std::move(sizes));
}

void add_surface(const std::vector<SurfacePair>& pairs, std::size_t begin, std::size_t end, double sigma_mm,
                 double scale_mm, SurfaceSystem& system) {
  std::vector<double> shares;
  AlongSums sums(*system.band, static_cast<std::size_t>(system.corner.size()));
  for (std::size_t i = begin; i < end; ++i) {
    const SurfacePair& pair = pairs[i];
    if (!pair.on_face) continue;
    shares.clear();
    for (const BasisRow::Weights& w : pair.row.weight) shares.push_back(w[BasisRow::kValue]);
    const double weight =
        geman_mcclure_weight(pair.residual_mm * pair.residual_mm, scale_mm) / (sigma_mm * sigma_mm);
    sums.add(pair.row.node, shares, pair.normal, -weight * pair.residual_mm, weight);
  }
  system += sums;
}

}  // namespace arris
