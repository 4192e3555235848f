#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/prepare.hpp"
#include "fixtures/synthetic/analytic_part.hpp"
#include "fixtures/synthetic/fe_part.hpp"
#include "fixtures/synthetic/scan.hpp"
#include "registration/registration.hpp"
#include "registration/scene.hpp"

namespace arris::scenes {

/// A part's drawing with the contours asked for (0: the opening).
CadModel cad_of(const synthetic::Part& part, const std::vector<int>& contours = {0}, double edge_mm = 20.0);

/// A plate with a round hole, bent over its width and twisted: no segment of the hole moves rigidly.
synthetic::PlateShape bent_plate_with_circle();

synthetic::FePart fe(const std::string& name);

/// A scan as the pipeline prepares it, with its truth in the frame of the prepared scan.
struct Trial {
  ScanModel scan;
  RigidMotion scan_from_cad;                   ///< true, of the part as nominal
  std::vector<Eigen::Vector3d> true_curve_mm;  ///< deformed opening, closed, about every 1 mm
  double edge_limit_mm = 0.0;
};
Trial trial_of(const synthetic::Part& part, const synthetic::ScanOptions& options, std::uint64_t seed);

/// The scan before it is prepared: cleaned, with `change` applied to every point and normal (mirror, unit,
/// turn).
Trial changed_trial(const synthetic::Part& part, const synthetic::ScanOptions& options, std::uint64_t seed,
                    const std::function<void(Eigen::Vector3f& point, Eigen::Vector3f& normal)>& change);

/// A scan of the opening without the contour search: points with given spacing and noise, identity pose; the
/// edge points are the true edge with noise in all directions.
struct IdealOptions {
  std::size_t points = 3000;
  double noise_sigma_mm = 0.05;
  double band_mm = 40.0;
  double edge_step_mm = 2.0;
};
Trial ideal_trial(const synthetic::Part& part, const IdealOptions& options, std::uint64_t seed);

/// Everything of a scan carried by one motion.
ScanModel moved(const ScanModel& scan, const RigidMotion& motion);

/// The same segment motion all along a contour.
ContourMotion rigid_along(const Curve& curve, const RigidMotion& scan_from_cad);

struct Distance {
  double mean_mm = 0.0, max_mm = 0.0;
};
/// From each point to a closed polyline, chord by chord.
double distance_mm(const Eigen::Vector3d& p_mm, const std::vector<Eigen::Vector3d>& loop_mm);
Distance distance_between(const std::vector<Eigen::Vector3d>& points_mm,
                          const std::vector<Eigen::Vector3d>& loop_mm);

/// Points of contour c of the drawing, step_mm apart, carried by `carry(arc, point)`.
std::vector<Eigen::Vector3d> carried(
    const Curve& curve, double step_mm,
    const std::function<Eigen::Vector3d(double, const Eigen::Vector3d&)>& carry);

/// A turn of angle_rad about a random axis through `about_mm`, then a random shift of length shift_mm.
RigidMotion disturbance(synthetic::Random& random, const Eigen::Vector3d& about_mm, double angle_rad,
                        double shift_mm);

}  // namespace arris::scenes
