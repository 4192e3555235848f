#include "registration/surface_match.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "acquisition/geometry/rigid_fit.hpp"
#include "registration/edge_pairs.hpp"
#include "registration/fpfh.hpp"
#include "registration/normal_equations.hpp"

namespace arris {
namespace {

constexpr double kPointsWanted = 700.0;  // of the drawing's band
constexpr double kStepSpacings = 1.5;    // of the scan: no finer
constexpr double kRadiusSteps = 5.0;     // of a descriptor
constexpr std::size_t kPartners = 3;     // of the drawing's points for each of the scan's
constexpr std::size_t kMostPairs = 1500;
constexpr double kFarSteps = 8.0;    // pairs nearer to each other say little
constexpr double kAgreeSteps = 1.2;  // by which two distances may differ
constexpr double kAgreeAngle = 0.3;  // rad, by which two angles between normals may
constexpr std::size_t kSeeds = 40, kFewestInGroup = 12;
constexpr double kPlainRatio = 0.25;  // of the mean descriptor's distances: a point that looks like most
constexpr int kGncRounds = 8;
constexpr double kGncFactor = 0.6;

struct Oriented {
  std::vector<Eigen::Vector3d> points_mm, normals;
};

/// The first point of each cube of the grid: measured ones, never means.
Oriented one_a_cube(const Oriented& all, double step_mm) {
  std::map<std::tuple<long, long, long>, bool> taken;
  Oriented kept;
  for (std::size_t i = 0; i < all.points_mm.size(); ++i) {
    const Eigen::Vector3d cube = (all.points_mm[i] / step_mm).array().floor();
    bool& is_taken = taken[{std::lround(cube.x()), std::lround(cube.y()), std::lround(cube.z())}];
    if (std::exchange(is_taken, true)) continue;
    kept.points_mm.push_back(all.points_mm[i]);
    kept.normals.push_back(all.normals[i]);
  }
  return kept;
}

double area_mm2(const TriangleMesh& mesh, std::size_t t) {
  const auto corner = [&](int k) -> const Eigen::Vector3d& {
    return mesh.vertices_mm[std::size_t(mesh.triangles[t][std::size_t(k)])];
  };
  return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
}

/// Points of the drawing near its contours, on a grid in each triangle.
Oriented drawn_points(const CadModel& cad, double band_mm, double step_mm) {
  Oriented all;
  for (std::size_t t = 0; t < cad.mesh.triangles.size(); ++t) {
    const auto& corners = cad.mesh.triangles[t];
    const Eigen::Vector3d& a = cad.mesh.vertices_mm[std::size_t(corners[0])];
    const Eigen::Vector3d ab = cad.mesh.vertices_mm[std::size_t(corners[1])] - a;
    const Eigen::Vector3d ac = cad.mesh.vertices_mm[std::size_t(corners[2])] - a;
    const int n = std::max(1, static_cast<int>(std::ceil(2.0 * std::max(ab.norm(), ac.norm()) / step_mm)));
    for (int i = 0; i < n; ++i)
      for (int k = 0; i + k < n; ++k) {
        const double u = (i + 1.0 / 3.0) / n, v = (k + 1.0 / 3.0) / n;
        const Eigen::Vector3d p = a + u * ab + v * ac;
        if (!near_contours(cad, p, band_mm)) continue;
        SurfacePoint foot;
        foot.triangle = static_cast<std::int32_t>(t);
        foot.barycentric = {1.0 - u - v, u, v};
        all.points_mm.push_back(p);
        all.normals.push_back(cad.smooth_normal(foot));
      }
  }
  return one_a_cube(all, step_mm);
}

/// The drawing's area near its contours, by the triangles' middles.
double band_area_mm2(const CadModel& cad, double band_mm) {
  double sum = 0.0;
  for (std::size_t t = 0; t < cad.mesh.triangles.size(); ++t) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::int32_t corner : cad.mesh.triangles[t])
      middle += cad.mesh.vertices_mm[std::size_t(corner)] / 3.0;
    if (near_contours(cad, middle, band_mm)) sum += area_mm2(cad.mesh, t);
  }
  return sum;
}

struct Pair {
  std::size_t scan = 0, cad = 0;
  float distance2 = 0.0F;
};

/// How far each descriptor is from the mean one; a surface of one kind (plane, cylinder, sphere) has none
/// that stands out.
std::vector<float> standing_out(const std::vector<Fpfh>& all) {
  Fpfh mean{};
  for (const Fpfh& one : all)
    for (std::size_t b = 0; b < mean.size(); ++b) mean[b] += one[b] / static_cast<float>(all.size());
  std::vector<float> far;
  for (const Fpfh& one : all) far.push_back(distance2(one, mean));
  return far;
}

/// The points of the scan that stand out, each with the drawing's points that look most like it.
std::vector<Pair> alike(const std::vector<Fpfh>& scan, const std::vector<Fpfh>& cad) {
  std::vector<Pair> pairs;
  const std::vector<float> far = standing_out(scan);
  float most = 0.0F;
  for (const float f : far) most = std::max(most, f);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (far[i] < kPlainRatio * kPlainRatio * most) continue;
    std::vector<Pair> best;
    for (std::size_t k = 0; k < cad.size(); ++k) {
      const Pair pair{i, k, distance2(scan[i], cad[k])};
      if (best.size() == kPartners && pair.distance2 >= best.back().distance2) continue;
      best.insert(std::upper_bound(best.begin(), best.end(), pair,
                                   [](const Pair& a, const Pair& b) { return a.distance2 < b.distance2; }),
                  pair);
      if (best.size() > kPartners) best.pop_back();
    }
    pairs.insert(pairs.end(), best.begin(), best.end());
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance2 < b.distance2; });
  if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
  return pairs;
}

/// Which pairs agree with which: bit rows.
class Agreement {
 public:
  Agreement(const std::vector<Pair>& pairs, const Oriented& scan, const Oriented& cad, double step_mm)
      : words_((pairs.size() + 63) / 64), bits_(pairs.size() * words_, 0) {
    for (std::size_t i = 0; i < pairs.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (agree(pairs[i], pairs[k], scan, cad, step_mm)) set(i, k), set(k, i);
  }
  [[nodiscard]] bool at(std::size_t i, std::size_t k) const {
    return (bits_[i * words_ + k / 64] >> (k % 64) & 1U) != 0;
  }
  /// How many agree with both.
  [[nodiscard]] int common(std::size_t i, std::size_t k) const {
    int count = 0;
    for (std::size_t w = 0; w < words_; ++w)
      count += __builtin_popcountll(bits_[i * words_ + w] & bits_[k * words_ + w]);
    return count;
  }

 private:
  static bool agree(const Pair& a, const Pair& b, const Oriented& scan, const Oriented& cad, double step_mm) {
    const double on_scan = (scan.points_mm[a.scan] - scan.points_mm[b.scan]).norm();
    const double on_cad = (cad.points_mm[a.cad] - cad.points_mm[b.cad]).norm();
    if (on_cad < kFarSteps * step_mm || std::abs(on_scan - on_cad) > kAgreeSteps * step_mm) return false;
    const auto angle = [](const Eigen::Vector3d& n, const Eigen::Vector3d& m) {
      return std::acos(std::clamp(n.dot(m), -1.0, 1.0));
    };
    return std::abs(angle(scan.normals[a.scan], scan.normals[b.scan]) -
                    angle(cad.normals[a.cad], cad.normals[b.cad])) < kAgreeAngle;
  }
  void set(std::size_t i, std::size_t k) { bits_[i * words_ + k / 64] |= std::uint64_t{1} << (k % 64); }

  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

/// The seed and the pairs that agree with it and with most others that do.
std::vector<std::size_t> group_of(std::size_t seed, const Agreement& agreement, std::size_t count) {
  std::vector<std::pair<int, std::size_t>> ranked;
  for (std::size_t k = 0; k < count; ++k)
    if (agreement.at(seed, k)) ranked.emplace_back(-agreement.common(seed, k), k);
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::size_t> group = {seed};
  for (const auto& [fewer, k] : ranked) {
    if (2 * fewer > ranked.front().first) break;  // half as many as the best has
    group.push_back(k);
  }
  return group;
}

/// The motion of a group, its outliers let go step by step.
RigidFit fit_group(const std::vector<std::size_t>& group, const std::vector<Pair>& pairs,
                   const Oriented& scan, const Oriented& cad, double step_mm) {
  std::vector<Eigen::Vector3d> from, to;
  for (const std::size_t k : group) {
    from.push_back(cad.points_mm[pairs[k].cad]);
    to.push_back(scan.points_mm[pairs[k].scan]);
  }
  std::vector<double> weights(group.size(), 1.0);
  RigidFit fit = fit_rigid(from, to);
  double scale_mm = 8.0 * step_mm;
  for (int round = 0; round < kGncRounds && fit.usable();
       ++round, scale_mm = std::max(step_mm, kGncFactor * scale_mm)) {
    for (std::size_t k = 0; k < group.size(); ++k)
      weights[k] = geman_mcclure_weight((fit.to_from * from[k] - to[k]).squaredNorm(), scale_mm);
    fit = fit_rigid(from, to, weights);
  }
  return fit;
}

}  // namespace

std::vector<RigidMotion> match_surfaces(const CadModel& cad, const ScanModel& scan, double spacing_mm,
                                        double band_mm, int threads) {
  const double step_mm =
      std::max(kStepSpacings * spacing_mm, std::sqrt(band_area_mm2(cad, band_mm) / kPointsWanted));
  const Oriented drawn = drawn_points(cad, band_mm, step_mm);
  const Oriented seen = one_a_cube({scan.points_mm, scan.normals}, step_mm);
  const double radius_mm = kRadiusSteps * step_mm;
  const std::vector<Pair> pairs = alike(fpfh_of(seen.points_mm, seen.normals, radius_mm, threads),
                                        fpfh_of(drawn.points_mm, drawn.normals, radius_mm, threads));
  const Agreement agreement(pairs, seen, drawn, step_mm);
  std::vector<std::pair<int, std::size_t>> seeds;
  for (std::size_t i = 0; i < pairs.size(); ++i) seeds.emplace_back(-agreement.common(i, i), i);
  std::sort(seeds.begin(), seeds.end());
  if (seeds.size() > kSeeds) seeds.resize(kSeeds);
  std::vector<RigidMotion> motions;
  for (const auto& [fewer, seed] : seeds) {
    const std::vector<std::size_t> group = group_of(seed, agreement, pairs.size());
    if (group.size() < kFewestInGroup) continue;
    const RigidFit fit = fit_group(group, pairs, seen, drawn, step_mm);
    if (fit.usable()) motions.push_back(fit.to_from);
  }
  return motions;
}

}  // namespace arris
