#include "report/worst_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris::report {
namespace {

// Nearest point of a triangle: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
               d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double scale = 1.0 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

// Brute force: ten flags a run, and independent of the query that made the deviations.
void find_nominal(const TriangleMesh& cad, WorstPoint& point) {
  double best2 = std::numeric_limits<double>::infinity();
  const auto vertex = [&](std::int32_t i) { return cad.vertices_mm[static_cast<std::size_t>(i)]; };
  for (const auto& t : cad.triangles) {
    const Eigen::Vector3d foot =
        nearest_on_triangle(point.p_cad_mm, vertex(t[0]), vertex(t[1]), vertex(t[2]));
    const double distance2 = (foot - point.p_cad_mm).squaredNorm();
    if (distance2 < best2) {
      best2 = distance2;
      point.nominal_cad_mm = foot;
    }
  }
  const double tolerance_mm = 1e-3 + 1e-3 * std::abs(point.deviation_mm);
  point.has_nominal = std::abs(std::sqrt(best2) - std::abs(point.deviation_mm)) < tolerance_mm;
}

}  // namespace

std::vector<std::size_t> spaced_extremes(std::span<const Eigen::Vector3f> points_mm,
                                         std::span<const float> deviation_mm, int count,
                                         double min_distance_mm, bool positive) {
  const std::size_t size = std::min(points_mm.size(), deviation_mm.size());
  const double distance2 = min_distance_mm * min_distance_mm;
  std::vector<std::size_t> chosen;
  const auto is_free = [&](std::size_t i) {
    return std::all_of(chosen.begin(), chosen.end(), [&](std::size_t j) {
      return (points_mm[i] - points_mm[j]).cast<double>().squaredNorm() >= distance2 && i != j;
    });
  };
  while (static_cast<int>(chosen.size()) < count) {
    std::size_t best = size;
    float best_value = 0.0F;
    for (std::size_t i = 0; i < size; ++i) {
      const float value = positive ? deviation_mm[i] : -deviation_mm[i];
      if (value > best_value && is_free(i)) {  // false for NaN
        best = i;
        best_value = value;
      }
    }
    if (best == size) break;
    chosen.push_back(best);
  }
  return chosen;
}

double flag_spacing_mm(const RunRecord& record) {
  const std::size_t size = std::min(record.cloud.size(), record.deviation_mm.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double sum2 = 0.0, count = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    if (!std::isfinite(record.deviation_mm[i])) continue;
    const Eigen::Vector3d p = record.cloud.local_mm(i);
    sum += p;
    sum2 += p.squaredNorm();
    count += 1.0;
  }
  if (count == 0.0) return 0.0;
  const Eigen::Vector3d mean = sum / count;
  return 0.2 * std::sqrt(std::max(0.0, sum2 / count - mean.squaredNorm()));
}

std::vector<WorstPoint> worst_points(const RunRecord& record, int count_each) {
  std::vector<WorstPoint> result;
  const double spacing_mm = flag_spacing_mm(record);
  const RigidMotion cad_from_scan = record.alignment.scan_from_cad.inverse();
  for (const bool positive : {true, false}) {
    int number = 0;
    for (const std::size_t i :
         spaced_extremes(record.cloud.points_mm, record.deviation_mm, count_each, spacing_mm, positive)) {
      WorstPoint point;
      point.id.push_back(positive ? 'H' : 'L');
      point.id.append(std::to_string(++number));
      point.index = i;
      point.deviation_mm = static_cast<double>(record.deviation_mm[i]);
      point.p_scan_mm = record.cloud.file_mm(i);
      point.p_cad_mm = cad_from_scan * point.p_scan_mm;
      point.in_tolerance = std::abs(point.deviation_mm) <= 0.5 * record.surface_profile_mm;
      find_nominal(record.cad, point);
      result.push_back(point);
    }
  }
  return result;
}

}  // namespace arris::report
