#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// The nearest point of a mesh.
struct SurfacePoint {
  std::int32_t triangle = -1;                         ///< -1: nothing within the radius
  Eigen::Vector3d foot_mm = Eigen::Vector3d::Zero();  ///< nearest point of the mesh, in its frame
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< pseudo-normal there (face, edge or vertex), unit
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  double distance_mm = 0.0;  ///< >= 0
  double signed_mm = 0.0;    ///< positive outside the material; sign by the angle-weighted pseudo-normal
  bool on_border = false;  ///< the foot lies on a one-face edge: the distance is to an edge, not to the face
};

/// Nearest point and signed distance to a fixed triangle mesh; exact, thread-safe. A BoxTree finds the
/// candidates, every candidate's foot is worked out in double; triangles that tie: the lower index. A foot
/// within 1e-9 of its triangle's longest edge from an edge or vertex counts as on it. Triangles without area
/// are no target, but pass on the normals beyond them. Sign: Baerentzen and Aanaes, IEEE TVCG 11(3), 2005:
/// angle-weighted pseudo-normals, so edges never flip it.
class SurfaceQuery {
 public:
  /// Copies the mesh. Build O(n log n), on `threads` threads (0: all of the machine). Throws Error(kBug) for
  /// indices out of range.
  explicit SurfaceQuery(const TriangleMesh& mesh, int threads = 0);

  /// Nearest point within max_distance_mm (triangle -1 if there is none). `hint`: an earlier answer that is
  /// likely near, of a point that has moved a little; it makes the search quicker and changes nothing.
  [[nodiscard]] SurfacePoint closest(const Eigen::Vector3d& query_mm, double max_distance_mm = 1e30,
                                     std::int32_t hint = -1) const;

  /// The same answers for many points, one each in `answers`; several times quicker where points that follow
  /// each other lie near each other (curve_order), not slower than one by one otherwise.
  void closest(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm,
               std::span<SurfacePoint> answers) const;

  /// signed_mm of closest() for many points; NaN where nothing lies within the radius or the foot is on the
  /// border.
  void signed_distances(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm,
                        std::span<double> answers_mm) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;  // never changes: copies share it
};

}  // namespace arris
