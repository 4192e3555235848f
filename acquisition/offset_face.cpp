#include "acquisition/offset_face.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "acquisition/smooth_regions.hpp"
#include "acquisition/types/error.hpp"
#include "acquisition/types/frames.hpp"
#include "acquisition/vertex_at.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr int kQuadricTerms = 5;           // slope 2, curvature 3
constexpr double kLeastPivotRatio = 1e-4;  // below it the vertices do not tell a term of the quadric
constexpr double kSliverRatio = 1e-2;      // height over longest side: its winding says nothing
constexpr double kLeastAreaRatio = 0.1;  // a face that shrinks to less has all but reached the bend's centre

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// The vertices that share a triangle with each vertex, itself among them; sorted.
std::vector<std::vector<std::int32_t>> rings(const TriangleMesh& mesh) {
  std::vector<std::vector<std::int32_t>> ring(mesh.vertices_mm.size());
  for (const auto& t : mesh.triangles)
    for (const std::int32_t v : t) ring[at(v)].insert(ring[at(v)].end(), t.begin(), t.end());
  for (auto& of : ring) {
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
  }
  return ring;
}

class SheetNormals {
 public:
  SheetNormals(const TriangleMesh& mesh, double crease_rad)
      : mesh_(mesh),
        crease_cos_(std::cos(crease_rad)),
        ring_(rings(mesh)),
        mean_(mesh.vertices_mm.size(), Vector3d::Zero()) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::int32_t v : mesh.triangles[t]) mean_[at(v)] += double_area_mm2(mesh, t);
    for (Vector3d& n : mean_) n = n.norm() > 0.0 ? Vector3d(n.normalized()) : Vector3d(Vector3d::UnitZ());
  }

  [[nodiscard]] Vector3d normal_of(std::size_t v) const {
    const std::vector<std::int32_t> near = two_rings(v);
    const bool creased = std::any_of(
        near.begin(), near.end(), [&](std::int32_t j) { return mean_[at(j)].dot(mean_[v]) < crease_cos_; });
    if (creased || near.size() <= kQuadricTerms) return mean_[v];
    const Vector3d rough = quadric_normal(v, near, mean_[v]);  // again in its own plane, without tilt
    const Vector3d fitted = quadric_normal(v, near, rough);
    return fitted.dot(mean_[v]) < crease_cos_ ? mean_[v] : fitted;
  }

 private:
  [[nodiscard]] std::vector<std::int32_t> two_rings(std::size_t v) const {
    std::vector<std::int32_t> near;
    for (const std::int32_t j : ring_[v]) near.insert(near.end(), ring_[at(j)].begin(), ring_[at(j)].end());
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
  }

  /// Height over the plane of `up`, z = g . x + x' H x / 2, through vertex v: its normal there.
  [[nodiscard]] Vector3d quadric_normal(std::size_t v, const std::vector<std::int32_t>& near,
                                        const Vector3d& up) const {
    const Eigen::Matrix3d frame = frame_with_z(up);
    double reach_mm = 0.0;
    for (const std::int32_t j : near)
      reach_mm = std::max(reach_mm, (mesh_.vertices_mm[at(j)] - mesh_.vertices_mm[v]).norm());
    Eigen::MatrixXd terms(static_cast<Eigen::Index>(near.size()), kQuadricTerms);
    Eigen::VectorXd heights(terms.rows());
    for (Eigen::Index i = 0; i < terms.rows(); ++i) {
      const Vector3d q = frame.transpose() *
                         (mesh_.vertices_mm[at(near[static_cast<std::size_t>(i)])] - mesh_.vertices_mm[v]) /
                         reach_mm;
      terms.row(i) << q.x(), q.y(), q.x() * q.x(), q.x() * q.y(), q.y() * q.y();
      heights[i] = q.z();
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(kLeastPivotRatio);
    const Eigen::VectorXd fit = solver.compute(terms).solve(heights);
    return (frame * Vector3d(-fit[0], -fit[1], 1.0)).normalized();
  }

  const TriangleMesh& mesh_;
  double crease_cos_;
  std::vector<std::vector<std::int32_t>> ring_;
  std::vector<Vector3d> mean_;
};

void refuse_folds(const TriangleMesh& sheet, const TriangleMesh& moved, double along_mm) {
  std::size_t folded = 0, first = 0;
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const Vector3d before_mm2 = double_area_mm2(sheet, t);
    if (double_area_mm2(moved, t).dot(before_mm2) >= kLeastAreaRatio * before_mm2.squaredNorm()) continue;
    const double longest_mm = side_mm(sheet, t, longest_side(sheet, t));
    if (before_mm2.norm() < kSliverRatio * longest_mm * longest_mm) continue;
    if (folded++ == 0) first = t;
  }
  if (folded == 0) return;
  const Vector3d& p_mm = sheet.vertices_mm[at(sheet.triangles[first][0])];
  char found[160];
  std::snprintf(found, sizeof found,
                "%zu triangles turn over, the first at (%.1f, %.1f, %.1f), when moved by %.3f mm", folded,
                p_mm.x(), p_mm.y(), p_mm.z(), std::abs(along_mm));
  throw Error(Fault::kInput, {.what = "the part is thicker than its drawing can be bent",
                              .where = "part.thickness_mm",
                              .found = found,
                              .needed = "a thickness below the smallest bend radius of the drawn face",
                              .next = "check part.thickness_mm and part.cad_is"});
}

}  // namespace

std::vector<Vector3d> sheet_normals(const TriangleMesh& mesh, double crease_rad) {
  const SheetNormals of(mesh, crease_rad);
  std::vector<Vector3d> normals;
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) normals.push_back(of.normal_of(v));
  return normals;
}

OffsetFace offset_face(const TriangleMesh& sheet, double along_mm, double crease_rad) {
  OffsetFace face{sheet, sheet_normals(sheet, crease_rad)};
  for (std::size_t v = 0; v < face.normals.size(); ++v)
    face.mesh.vertices_mm[v] += along_mm * face.normals[v];
  refuse_folds(sheet, face.mesh, along_mm);
  return face;
}

OffsetFace turned(OffsetFace face) {
  for (auto& t : face.mesh.triangles) std::swap(t[1], t[2]);
  for (Vector3d& n : face.normals) n = -n;
  return face;
}

std::vector<Contour> contours_on(const OffsetFace& face, const TriangleMesh& sheet,
                                 const std::vector<Contour>& contours) {
  const VertexAt vertex(sheet);
  std::vector<Contour> moved = contours;
  for (Contour& contour : moved) {
    const Vector3d drawn_normal = contour.normals.front();
    for (std::size_t i = 0; i < contour.points_mm.size(); ++i) {
      const std::size_t v = vertex(contour.points_mm[i]);
      contour.points_mm[i] = face.mesh.vertices_mm[v];
      contour.normals[i] = face.normals[v];
    }
    if (contour.normals.front().dot(drawn_normal) > 0.0) continue;
    for (std::vector<Vector3d>* list : {&contour.points_mm, &contour.normals}) {
      std::reverse(list->begin(), list->end());
      std::rotate(list->begin(), list->end() - 2, list->end());  // the first edge stays the first
    }
  }
  return moved;
}

}  // namespace arris
