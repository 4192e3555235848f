#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "registration/coarse_align.hpp"
#include "registration/deformation_field.hpp"
#include "registration/edge_fit.hpp"
#include "registration/edge_pairs.hpp"
#include "registration/projection_field.hpp"
#include "registration/rigid_icp.hpp"
#include "registration/segment_refine.hpp"
#include "registration/subdivision_field.hpp"
#include "registration/subdivision_icp.hpp"
#include "registration/surface_refine.hpp"

namespace arris {

enum class RegistrationMethod { kRigid, kSubdivision, kProjection, kSurface };
/// What follows subdivision ICP.
enum class RefineMethod { kNone, kCeres };

/// Longest stretch of contour without data, when the recipe names none. A surface field carries such a
/// stretch by the rest of the contour and knows how well (max_sd_mm): on the finite element parts, gaps up to
/// its 200 mm stay inside the stated bound, and so does the rest of a contour of which half is seen.
inline constexpr double kUnseenMm = 100.0, kSurfaceUnseenMm = 200.0;
inline constexpr double kSeenRatio = 0.6, kSurfaceSeenRatio = 0.5;

/// Everything the recipe may choose about registration.
struct RegistrationOptions {
  RegistrationMethod method = RegistrationMethod::kSurface;
  CoarseAlignOptions coarse;
  RigidIcpOptions rigid;
  SubdivisionIcpOptions subdivision;
  SurfaceOptions surface;
  RefineMethod refine = RefineMethod::kNone;
  EdgeFitOptions edge;
  ProjectionOptions projection;
  ContourRole role = ContourRole::kEdge;
  double band_mm = 60.0;                      ///< where the field speaks
  double min_seen_ratio = kSurfaceSeenRatio;  ///< of each contour's length; below it: refused
  double max_unseen_mm = kSurfaceUnseenMm;    ///< longest stretch of contour without data; above it: refused
  double max_sd_mm = 1.0;     ///< method surface: a contour known worse than this across is refused
  double mid_depth_mm = 0.0;  ///< of the mid-surface below the scanned face, for the strain; 0: not known
  int threads = 0;
};

/// Where the part lies and how it is bent. The field is there unless `refusals` says why not to use it.
struct Registration {
  CoarseAlignment coarse;
  RigidIcpResult rigid;  ///< usable() tells whether there is a pose
  std::vector<std::string> free_directions;
  std::vector<LoopAssignment> loops;  ///< one a loop of the scan: the contour it runs along, or dropped
  std::shared_ptr<const DeformationField> field;  ///< null when no pose was found
  std::vector<ContourResult>
      contours;  ///< one an accepted contour; of methods rigid and projection, with one rigid segment
  std::vector<ContourProjection> projection;  ///< of method projection: one an accepted contour
  SegmentRefinement refinement;               ///< of the segments' motions; empty unless asked for
  std::vector<std::string> refusals;          ///< in plain words
  std::vector<std::pair<std::string, double>>
      stage_residual_mm;            ///< distance found edge - carried nominal, rms
  double mean_strain_ratio = 0.0;   ///< lengthening of the contours at mid_depth_mm, carried against nominal
  double face_strain_ratio = 0.0;   ///< the same on the scanned face, which bending alone lengthens
  double strain_limit_ratio = 0.0;  ///< what the edge limit makes of it: the scan shows no smaller strain
  double density_per_mm2 = 0.0;
  double seen_ratio = 0.0;  ///< share of the contours' length where scan points decided
  [[nodiscard]] bool usable() const { return field != nullptr; }
};

/// All stages in order: start pose, rigid ICP, subdivision ICP on the scan's edge points, the edge by
/// one-sided support, subdivision ICP again on that sharpened edge, and the edge once more. Angle-gap edge
/// points lie half a spacing to a whole one inside the material, so the first subdivision only finds the
/// neighbourhood. Throws nothing of its own; a scan that is mirrored or in another unit is reported in
/// `coarse`.
[[nodiscard]] Registration register_part(const CadModel& cad, ScanModel& scan,
                                         const RegistrationOptions& options);

/// Distance from the found edge to the nominal contour carried rigidly, at arc length s of contour c; mm.
[[nodiscard]] double rigid_gap_mm(const CadModel& cad, std::size_t contour, const Registration& registration,
                                  double arc_mm);

/// Height of the scan's surface over the nominal contour as the method carried it, at arc length s of contour
/// c; mm, along the normal.
[[nodiscard]] double height_gap_mm(std::size_t contour, const Registration& registration, double arc_mm);

}  // namespace arris
