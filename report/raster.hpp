#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "report/colour_map.hpp"

namespace arris::report {

/// Diagonal light-grey stripes: what has no data looks like at pixel (col, row). Never mistaken for a step of
/// a scale.
[[nodiscard]] Rgb no_data_pattern(int col, int row);

/// An image with a depth a pixel (mm, larger is nearer to the eye): hidden surfaces without a graphics card.
class Raster {
 public:
  Raster(int width_px, int height_px, const Rgb& background);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const Rgb& colour(int col, int row) const { return colours_[at(col, row)]; }
  void set(int col, int row, const Rgb& colour) { colours_[at(col, row)] = colour; }
  [[nodiscard]] bool is_covered(int col, int row) const;
  [[nodiscard]] float depth_mm(int col, int row) const { return depths_[at(col, row)]; }
  /// Nothing is nearer at this place than `depth_mm` (by more than slack_mm); outside the image: true.
  [[nodiscard]] bool sees(const Eigen::Vector3d& p, double slack_mm) const;

  /// A cone with its tip at p = (x px, y px, depth mm): neighbouring points meet halfway, so that a cloud
  /// looks solid.
  ///   slope_mm_px   how fast the cone falls back; steeper than the surface, else near points eat far ones
  void splat(const Eigen::Vector3d& p, double radius_px, double slope_mm_px, const Rgb& colour);
  /// A triangle with corners (x px, y px, depth mm).
  void triangle(const std::array<Eigen::Vector3d, 3>& corners, const Rgb& colour);
  /// The same without depth: covers only what is still background, in the pattern of no data.
  void no_data_triangle(const std::array<Eigen::Vector3d, 3>& corners);

  /// Uncovers what lies within `rim_px` of nothing: after splats that are too large by that much, gaps
  /// between points stay closed and outlines come back to where the points end. The image's own border is no
  /// rim.
  void erode(double rim_px, const Rgb& background);

  /// Light from the upper left on the depths (less their mean plane, averaged over +-blur_px): shows the
  /// shape, keeps the colours readable.
  void shade(int blur_px, double mm_per_px, double strength_ratio);

 private:
  [[nodiscard]] std::size_t at(int col, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(col);
  }
  template <class Paint>
  void scan_triangle(const std::array<Eigen::Vector3d, 3>& corners, const Paint& paint);
  [[nodiscard]] std::vector<float> depths_off_mean_plane() const;
  [[nodiscard]] std::vector<float> blurred_depths(int blur_px) const;

  int width_ = 0, height_ = 0;
  std::vector<Rgb> colours_;
  std::vector<float> depths_;  // of the cone while splatting
  std::vector<float> tips_;    // of the point itself
};

}  // namespace arris::report
