#pragma once

#include <vector>

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

/// Loops have their material on the left: whether that is what they run around.
[[nodiscard]] bool runs_around_material(const Contour& loop);

/// n of the values, evenly spread; all when there are no more.
template <class T>
[[nodiscard]] std::vector<T> every(const std::vector<T>& values, std::size_t count) {
  if (values.size() <= count) return values;
  std::vector<T> chosen(count);
  for (std::size_t i = 0; i < count; ++i) chosen[i] = values[i * values.size() / count];
  return chosen;
}

}  // namespace arris
