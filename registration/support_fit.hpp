#pragma once

#include <vector>

#include "registration/found_edge.hpp"
#include "registration/rigid_icp.hpp"

namespace arris {

/// The edges by support relative to one rigid motion: the splines are loose and the gates wide, for they
/// carry the whole deformation.
[[nodiscard]] std::vector<ContourResult> edges_from_rigid(const CadModel& cad, const ScanModel& scan,
                                                          const RigidMotion& scan_from_cad,
                                                          const EdgeFitOptions& options);

/// A rigid motion from the edges by support, and these as they are seen from the start.
struct SupportFit {
  RigidIcpResult rigid;
  std::vector<ContourResult> edges;
};

/// One rigid ICP on the edges by support that are seen from a start pose. Strays, and the rim of a gap, are
/// extracted edge points as good as any; support tells them apart, as long as the start is near.
[[nodiscard]] SupportFit fit_to_support(const CadModel& cad, const ScanModel& scan, const RigidMotion& start,
                                        const EdgeFitOptions& edge, RigidIcpOptions icp);

}  // namespace arris
