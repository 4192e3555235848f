#pragma once

#include <Eigen/Core>
#include <string>

namespace arris {

/// What a fixture target is: a sphere, whose centre is found in the scan itself, or a point, which the
/// scanner's own software gives beside the scan (a coded marker, the tip of a cone).
enum class TargetKind { kSphere, kPoint };

/// A target that stays where it is while parts come and go.
struct FixtureTarget {
  std::string id;  ///< as the fixture is labelled: "A", "T3"
  TargetKind kind = TargetKind::kSphere;
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();  ///< robot's base frame; of a sphere its centre
  double diameter_mm = 0.0;                            ///< of a sphere; 0 for a point
  double sd_mm = 0.0;                                  ///< standard deviation of the place, each axis
};

/// A point target as the scanner's software saw it.
struct ScanTarget {
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();  ///< scan frame, file coordinates
  double sd_mm = -1.0;                                 ///< each axis; negative: the file states none
};

}  // namespace arris
