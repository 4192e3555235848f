#pragma once

#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/scene.hpp"

namespace arris {

/// A scan for scoring, as it is, with the other side up, or mirrored in x: a thinned copy, and the full scan
/// behind it, to which it keeps a reference.
class LightScan {
 public:
  LightScan(const ScanModel& scan, bool flip, bool mirror);
  ScanModel model;             ///< thinned; without a tree
  NearestPoints edges;         ///< over model.edge_mm
  double spacing_mm;           ///< of the thinned points
  std::vector<char> stood_on;  ///< one a loop: the foot of a clamp or a lump, no hole

  /// Whether a point of the full scan lies within reach_mm.
  [[nodiscard]] bool covers(const Eigen::Vector3d& p_mm, double reach_mm) const;
  /// The scan's points within reach_mm beside p and height_mm over or under it whose normals are within 60
  /// degrees.
  struct Patch {
    double covered_ratio = 0.0;  ///< of as many points as an even scan of a face has there
    double height_mm = 0.0;      ///< their median over p, along the normal
  };
  [[nodiscard]] Patch patch_at(const Eigen::Vector3d& p_mm, const Eigen::Vector3d& normal, double reach_mm,
                               double height_mm) const;

 private:
  [[nodiscard]] Eigen::Vector3d unmirrored(Eigen::Vector3d v) const {
    if (mirror_) v.x() = -v.x();
    return v;
  }
  [[nodiscard]] bool is_stood_on(const Contour& loop) const;
  const ScanModel& scan_;
  bool flip_, mirror_;
};

/// How badly a pose fits, three times: with a third of each contour left out of the judgement, which may be
/// hidden, with a quarter, and with a tenth. Capped trimmed rms; mm.
struct PoseMisfit {
  double patient_mm = 1e300, middle_mm = 1e300, strict_mm = 1e300;
  double shown_ratio = 0.0;    ///< of the contours' samples: an edge of the scan is near, not only the cap
  double against_ratio = 0.0;  ///< of them: the scan's face goes on where the drawing ends
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
  [[nodiscard]] double other_contours2(const LightScan& scan, const RigidMotion& scan_from_cad) const;
  [[nodiscard]] double stray_holes2(const LightScan& scan, const RigidMotion& cad_from_scan) const;
  [[nodiscard]] bool may_be_other_hole(const Contour& loop) const;

  const CadModel& cad_;
  double band_mm_, size_mm_ = 0.0, cap_mm_ = 0.0;
  std::vector<Sample> samples_;
  std::vector<std::vector<Eigen::Vector3d>> others_mm_;  ///< places along each contour that is not followed
  std::vector<double> hole_length_mm_;                   ///< of the others that run around no material
};

/// n of the values, evenly spread; all when there are no more.
template <class T>
[[nodiscard]] std::vector<T> every(const std::vector<T>& values, std::size_t count) {
  if (values.size() <= count) return values;
  std::vector<T> chosen(count);
  for (std::size_t i = 0; i < count; ++i) chosen[i] = values[i * values.size() / count];
  return chosen;
}

}  // namespace arris
