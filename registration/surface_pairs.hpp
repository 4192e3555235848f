#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/scene.hpp"
#include "registration/surface_basis.hpp"
#include "registration/surface_system.hpp"

namespace arris {

/// One scan point and its partner on the deformed CAD; CAD frame.
struct SurfacePair {
  BasisRow row;                                        ///< at the partner's nominal place
  Eigen::Vector3d foot_mm = Eigen::Vector3d::Zero();   ///< that place
  std::int32_t triangle = -1;                          ///< it lies on this one; -1: no partner
  Eigen::Vector3d p_mm = Eigen::Vector3d::Zero();      ///< the scan point
  Eigen::Vector3d guess_mm = Eigen::Vector3d::Zero();  ///< shift at the last partner: where to look next
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< deformed
  double residual_mm = 0.0;                            ///< out of the material
  bool on_border = false;                              ///< the partner lies on the rim of the face
  bool on_face = false;  ///< the partner lies on the face, not on its rim, and the normals agree
};

/// Scan points within reach_mm of an accepted contour at a rigid motion, as pairs without partner yet.
/// reach_mm < 0: all of them.
[[nodiscard]] std::vector<std::size_t> points_near(const CadModel& cad, const ScanModel& scan,
                                                   const RigidMotion& scan_from_cad, double reach_mm,
                                                   int threads);

/// The same points, those that follow each other near each other, so that what they need is at hand.
[[nodiscard]] std::vector<std::size_t> beside_each_other(const ScanModel& scan,
                                                         const std::vector<std::size_t>& points, int threads);

/// Renews the partner of every pair: the nominal surface point nearest to the scan point with the shift of
/// its last partner taken off (a fixed point; exact once the shifts stand still), unless the point still lies
/// above that partner's tangent plane within 0.1 mm of it. Normals within 60 degrees.
///   points   the scan point of each pair
void pair_surface(const CadModel& cad, const ScanModel& scan, const std::vector<std::size_t>& points,
                  const RigidMotion& scan_from_cad, const SurfaceBasis& basis,
                  const std::vector<Eigen::Vector3d>& shift_mm, double reach_mm, int threads,
                  std::vector<SurfacePair>& pairs);

/// Rows of another basis at the partners that the pairs have.
void renew_rows(const SurfaceBasis& basis, int threads, std::vector<SurfacePair>& pairs);

/// Robust residual (scaled median) of the pairs on the face within 2 scale_mm; mm.
[[nodiscard]] double residual_sigma_mm(const std::vector<SurfacePair>& pairs, double scale_mm);

/// Adds pairs [begin, end) point to plane, whitened by sigma_mm, with Geman-McClure weights of scale_mm.
void add_surface(const std::vector<SurfacePair>& pairs, std::size_t begin, std::size_t end, double sigma_mm,
                 double scale_mm, SurfaceSystem& system);

}  // namespace arris
