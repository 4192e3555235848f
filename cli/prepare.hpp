#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/contour_extract.hpp"
#include "acquisition/types/point_cloud.hpp"
#include "registration/scene.hpp"

namespace arris {

/// How a scan becomes a ScanModel.
struct PrepareOptions {
  std::optional<Eigen::Vector3d> seen_from_mm;  ///< a point on the air side, file coordinates of the scan
  ContourOptions contour;
  int threads = 0;
};

/// A scan ready for registration, with what the operator should know of its contours.
struct PreparedScan {
  ScanModel model;
  ContourSet contours;
  std::string
      side_decided_by;  ///< "normals in the file", "triangles in the file", "seen_from"; empty: undecided
};

/// Normals, their side, point spacing, noise and contours of a scan. Throws Error(kInput) below 30 points.
/// Cost O(N log N).
[[nodiscard]] PreparedScan prepare_scan(const Scan& scan, const PrepareOptions& options);

/// A drawing ready for registration.
///   others   contours of the drawing that are not followed; threads: 0, all of the machine
[[nodiscard]] CadModel prepare_cad(const TriangleMesh& mesh, const std::vector<Contour>& accepted,
                                   const std::vector<Contour>& others = {}, int threads = 0);

}  // namespace arris
