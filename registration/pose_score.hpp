#pragma once

#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/light_scan.hpp"
#include "registration/scene.hpp"

namespace arris {

/// How badly a pose fits, three times: with a third of each contour left out of the judgement, which may be
/// hidden, with a quarter, and with a tenth. Capped trimmed rms; mm.
struct PoseMisfit {
  double patient_mm = 1e300, middle_mm = 1e300, strict_mm = 1e300;
  double seen_mm = 1e300;      ///< patient, of the places alone at which the scan tells anything
  double shown_ratio = 0.0;    ///< of the contours' samples: an edge of the scan is near, not only the cap
  double against_ratio = 0.0;  ///< of them: the scan's face goes on where the drawing ends
  double others_mm = 0.0;      ///< off the drawing's other contours that the scan covers, beyond a spacing
  int others = 0;              ///< how many those are
};

/// Scores poses of one drawing. What counts: the followed contours on the scan's edge; scan points near them
/// on the drawing's face; the drawing's other contours where the scan covers them; holes of the scan on the
/// drawing's contours. What the scanner sees past an edge of the part, and far behind it, counts nothing.
class PoseScore {
 public:
  PoseScore(const CadModel& cad, double band_mm);

  /// Of a pose that was fitted: an edge counts only with material on its one side and none on the other.
  /// Cost: some 400 nearest points and half as many nearest triangles.
  [[nodiscard]] PoseMisfit of(const LightScan& scan, const RigidMotion& scan_from_cad) const;
  /// Of a rough start: any edge nearby counts.
  [[nodiscard]] PoseMisfit of_start(const LightScan& scan, const RigidMotion& scan_from_cad) const;
  /// What the edges alone leave of a rough start, mm: of_start() finds no less, at ten times the cost.
  [[nodiscard]] double least_of_start_mm(const LightScan& scan, const RigidMotion& scan_from_cad) const;
  /// Of the largest followed contour: length / (2 pi); mm.
  [[nodiscard]] double size_mm() const { return size_mm_; }
  /// No single distance counts more; mm.
  [[nodiscard]] double cap_mm() const { return cap_mm_; }
  /// A place on a followed contour, CAD frame.
  struct Sample {
    Eigen::Vector3d place_mm, inward, normal;
    double size_mm;  ///< of its contour
  };
  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }

 private:
  /// What the scan says where a sample comes to lie.
  enum class Seen { kEdge, kNothing, kFaceGoesOn };
  struct Place {
    double off2_mm2 = 0.0;  ///< squared distance to the nearest edge, or what stands for it
    Seen seen = Seen::kEdge;
  };
  [[nodiscard]] PoseMisfit misfit(const LightScan& scan, const RigidMotion& scan_from_cad,
                                  const std::vector<Place>& places) const;
  void judge_support(const LightScan& scan, const RigidMotion& scan_from_cad,
                     std::vector<Place>& places) const;
  [[nodiscard]] std::vector<Place> edges(const LightScan& scan, const RigidMotion& scan_from_cad) const;
  [[nodiscard]] std::vector<double> surface2(const LightScan& scan, const RigidMotion& cad_from_scan) const;
  [[nodiscard]] double hidden2(const LightScan& scan) const;
  /// Mean square over the drawing's other contours that the scan covers, and how many.
  struct Others {
    double off2_mm2 = 0.0;
    int counted = 0;
  };
  [[nodiscard]] Others other_contours(const LightScan& scan, const RigidMotion& scan_from_cad) const;
  [[nodiscard]] double stray_holes2(const LightScan& scan, const RigidMotion& cad_from_scan) const;
  [[nodiscard]] bool may_be_other_hole(const Contour& loop) const;

  const CadModel& cad_;
  double band_mm_, size_mm_ = 0.0, cap_mm_ = 0.0;
  std::vector<Sample> samples_;
  std::vector<std::vector<Eigen::Vector3d>> others_mm_;  ///< places along each contour that is not followed
  std::vector<double> hole_length_mm_;                   ///< of the others that run around no material
};

}  // namespace arris
