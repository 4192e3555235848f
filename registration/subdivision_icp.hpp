#pragma once

#include <functional>
#include <string>
#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/scene.hpp"
#include "registration/subdivision.hpp"

namespace arris {

/// Which extra surface points keep a segment from turning about its own edge (paper, step d and section 3.2).
enum class StabilityPoints {
  kNone,
  kPaper,  ///< all of them in every segment, matched once after the rigid ICP, point to point
  kLocal,  ///< those near the segment, matched again each round, point to plane
};

/// How a segment is matched.
enum class SegmentMatch {
  kPaper,  ///< model point to nearest scan contour point, Horn's closed form
  kFoot,   ///< scan edge point to its foot on the contour, across and normal only; tied softly to the
           ///< neighbours
};

/// Options of subdivision ICP; the paper's parameters are recipe keys of [registration.subdivision].
struct SubdivisionIcpOptions {
  SubdivisionOptions subdivision;
  SegmentMatch match = SegmentMatch::kFoot;
  StabilityPoints stability = StabilityPoints::kLocal;
  double stability_distance_mm = 30.0;  ///< stability points lie within this of the contour
  int stability_points = 60;            ///< at most this many a segment
  int max_iterations = 30;              ///< k_max
  double stop_change_ratio = 1e-3;      ///< delta
  double neighbour_turn_rad = 0.03;     ///< expected turn of one segment against the next
  double neighbour_shift_mm = 1.0;      ///< and its shift; both only matter where data are missing
  int threads = 0;
  void check() const;
};

/// Outcome of one segment.
struct SegmentFit {
  RigidMotion scan_from_cad = RigidMotion::Identity();
  double rms_mm = 0.0;  ///< weighted, across the contour
  int pairs = 0;        ///< scan edge points (kFoot) or contour points (kPaper)
  int iterations = 0;
  bool from_data = true;  ///< false: too few pairs, the neighbours decided
  std::string stop;
};

/// Motion of the material along one contour: the segments' motions blended where they overlap (paper eq. 7).
class ContourMotion {
 public:
  ContourMotion(const Curve& nominal, Subdivision subdivision, std::vector<SegmentFit> fits);

  /// Blended motion at s: carries the contour point to the weighted mean of the segments' images (eq. 7) and
  /// turns by the log-mean of their rotations, so that tool axes blend as well.
  [[nodiscard]] RigidMotion at(double arc_mm) const;
  [[nodiscard]] const std::vector<SegmentFit>& fits() const { return fits_; }
  [[nodiscard]] const Subdivision& subdivision() const { return subdivision_; }
  [[nodiscard]] const Curve& nominal() const { return nominal_; }

 private:
  Curve nominal_;
  Subdivision subdivision_;
  std::vector<SegmentFit> fits_;
};

/// The motion of a smooth field along a contour, as one segment every step_mm or less; between their middles
/// the blend is off by its change of curvature times step^2 / 8.
[[nodiscard]] ContourMotion sampled_motion(const Curve& nominal, double step_mm,
                                           const std::function<RigidMotion(double arc_mm)>& motion_at);

/// Scan edge points that a segment is fitted to: those found by the angle gap, or a sharpened edge.
struct EdgeData {
  std::vector<Eigen::Vector3d> points_mm;  ///< scan frame
  double sigma_across_mm = 1.0;            ///< how far they scatter across the edge
  double correlated_ratio = 1.0;           ///< so many points share one error (samples of one spline)
  std::vector<std::size_t> contour;        ///< of each point, where known (a sharpened edge); else empty
  std::vector<double> arc_mm;              ///< and its place on that contour
};

/// Subdivision ICP of section 3 for every accepted contour, starting from one rigid motion.
///   data      scan edge points; scan gives the surface for the stability points
///   start     motions of an earlier pass to begin with (empty: the rigid motion); then only the last rounds
///   are run returns   one ContourMotion a contour cost      O(iterations * (edge points + stability
///   points)); deterministic
[[nodiscard]] std::vector<ContourMotion> subdivision_icp(const CadModel& cad, const ScanModel& scan,
                                                         const EdgeData& data,
                                                         const RigidMotion& rigid_scan_from_cad,
                                                         const SubdivisionIcpOptions& options,
                                                         const std::vector<ContourMotion>& start = {});

}  // namespace arris
