#pragma once

#include "registration/pose_score.hpp"

namespace arris {

/// Keeps what the whole scan said of a pose as the search found it, all contours of the drawing and the face
/// with them, and tells whether a later fit, which sees the accepted contours' edges alone, was led astray.
class PoseWatch {
 public:
  /// Keeps the references; the scan with all its edges, and with the side that was chosen.
  ///   found_mm   score of the pose as found
  PoseWatch(const CadModel& cad, const ScanModel& scan, double band_mm, double found_mm)
      : score_(cad, band_mm), scan_(scan, false, false), found_mm_(found_mm) {}

  /// Score of a pose over that of the one found; scores below the point spacing are alike. Cost: some 400
  /// nearest points.
  [[nodiscard]] double times_worse(const RigidMotion& scan_from_cad) const;

 private:
  PoseScore score_;
  LightScan scan_;
  double found_mm_;
};

/// A later fit that makes the score so much worse was led astray: the square of what it leaves has doubled.
/// Bending, a view that ends beside the part and the grain of a scan change the score by less than a third.
inline constexpr double kAstrayRatio = 1.4;

}  // namespace arris
