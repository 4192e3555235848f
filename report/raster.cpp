#include "report/raster.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace arris::report {
namespace {

constexpr float kFar = -std::numeric_limits<float>::infinity();

std::uint8_t scaled(std::uint8_t part, double factor) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(part * factor), 0L, 255L));
}

// Mean of what is covered within +-radius along one line of pixels, by running sums.
void blur_line(const float* values, float* out, int count, std::ptrdiff_t stride, int radius) {
  double sum = 0.0;
  int covered = 0;
  const auto value = [&](int i) { return values[i * stride]; };
  const auto enter = [&](int i, int sign) {
    if (i < 0 || i >= count || value(i) == kFar) return;
    sum += sign * static_cast<double>(value(i));
    covered += sign;
  };
  for (int i = 0; i < radius; ++i) enter(i, 1);
  for (int i = 0; i < count; ++i) {
    enter(i + radius, 1);
    enter(i - radius - 1, -1);
    out[i * stride] = value(i) == kFar || covered == 0 ? kFar : static_cast<float>(sum / covered);
  }
}

}  // namespace

Rgb no_data_pattern(int col, int row) {
  return (col + row) % 12 < 5 ? Rgb{208, 208, 208} : Rgb{238, 238, 238};
}

Raster::Raster(int width_px, int height_px, const Rgb& background) : width_(width_px), height_(height_px) {
  const std::size_t count = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  colours_.assign(count, background);
  depths_.assign(count, kFar);
  tips_.assign(count, kFar);
}

bool Raster::is_covered(int col, int row) const {
  return depths_[at(col, row)] != kFar;
}

bool Raster::sees(const Eigen::Vector3d& p, double slack_mm) const {
  const int col = static_cast<int>(std::floor(p.x())), row = static_cast<int>(std::floor(p.y()));
  if (col < 0 || row < 0 || col >= width_ || row >= height_) return true;
  return static_cast<double>(tips_[at(col, row)]) <= p.z() + slack_mm;
}

void Raster::splat(const Eigen::Vector3d& p, double radius_px, double slope_mm_px, const Rgb& colour) {
  const int left = std::max(0, static_cast<int>(std::ceil(p.x() - radius_px - 0.5)));
  const int right = std::min(width_ - 1, static_cast<int>(std::floor(p.x() + radius_px - 0.5)));
  const int top = std::max(0, static_cast<int>(std::ceil(p.y() - radius_px - 0.5)));
  const int bottom = std::min(height_ - 1, static_cast<int>(std::floor(p.y() + radius_px - 0.5)));
  for (int row = top; row <= bottom; ++row)
    for (int col = left; col <= right; ++col) {
      const double dx = col + 0.5 - p.x(), dy = row + 0.5 - p.y(), distance2 = dx * dx + dy * dy;
      if (distance2 > radius_px * radius_px) continue;
      const auto depth = static_cast<float>(p.z() - slope_mm_px * std::sqrt(distance2));
      float& there = depths_[at(col, row)];
      if (depth <= there) continue;
      there = depth;
      tips_[at(col, row)] = static_cast<float>(p.z());
      colours_[at(col, row)] = colour;
    }
}

template <class Paint>
void Raster::scan_triangle(const std::array<Eigen::Vector3d, 3>& corners, const Paint& paint) {
  const Eigen::Vector3d &a = corners[0], &b = corners[1], &c = corners[2];
  const double area2 = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (std::abs(area2) < 1e-12) return;
  const int left = std::max(0, static_cast<int>(std::floor(std::min({a.x(), b.x(), c.x()}) - 0.5)));
  const int right = std::min(width_ - 1, static_cast<int>(std::ceil(std::max({a.x(), b.x(), c.x()}))));
  const int top = std::max(0, static_cast<int>(std::floor(std::min({a.y(), b.y(), c.y()}) - 0.5)));
  const int bottom = std::min(height_ - 1, static_cast<int>(std::ceil(std::max({a.y(), b.y(), c.y()}))));
  const auto edge = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q, double x, double y) {
    return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
  };
  for (int row = top; row <= bottom; ++row)
    for (int col = left; col <= right; ++col) {
      const double x = col + 0.5, y = row + 0.5;
      const double wa = edge(b, c, x, y) / area2, wb = edge(c, a, x, y) / area2, wc = 1.0 - wa - wb;
      if (wa < -1e-9 || wb < -1e-9 || wc < -1e-9) continue;
      paint(col, row, static_cast<float>(wa * a.z() + wb * b.z() + wc * c.z()));
    }
}

void Raster::triangle(const std::array<Eigen::Vector3d, 3>& corners, const Rgb& colour) {
  scan_triangle(corners, [&](int col, int row, float depth) {
    if (depth <= depths_[at(col, row)]) return;
    depths_[at(col, row)] = tips_[at(col, row)] = depth;
    colours_[at(col, row)] = colour;
  });
}

void Raster::no_data_triangle(const std::array<Eigen::Vector3d, 3>& corners) {
  scan_triangle(corners, [&](int col, int row, float) {
    if (!is_covered(col, row)) colours_[at(col, row)] = no_data_pattern(col, row);
  });
}

std::vector<float> Raster::depths_off_mean_plane() const {
  Eigen::Matrix3d normal_matrix = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (int row = 0; row < height_; row += 2)
    for (int col = 0; col < width_; col += 2) {
      if (!is_covered(col, row)) continue;
      const Eigen::Vector3d a(col / 100.0, row / 100.0, 1.0);
      normal_matrix += a * a.transpose();
      right_side += a * static_cast<double>(tips_[at(col, row)]);
    }
  const Eigen::Vector3d plane = normal_matrix.ldlt().solve(right_side);
  std::vector<float> depths = tips_;
  for (int row = 0; row < height_; ++row)
    for (int col = 0; col < width_; ++col)
      if (is_covered(col, row))
        depths[at(col, row)] -= static_cast<float>(plane.dot(Eigen::Vector3d(col / 100.0, row / 100.0, 1.0)));
  return depths;
}

std::vector<float> Raster::blurred_depths(int blur_px) const {
  std::vector<float> depths = depths_off_mean_plane(), other(tips_.size());
  for (int pass = 0; pass < 2; ++pass) {  // two boxes: smooth enough for a slope
    for (int row = 0; row < height_; ++row)
      blur_line(&depths[at(0, row)], &other[at(0, row)], width_, 1, blur_px);
    for (int col = 0; col < width_; ++col)
      blur_line(&other[at(col, 0)], &depths[at(col, 0)], height_, width_, blur_px);
  }
  return depths;
}

void Raster::erode(double rim_px, const Rgb& background) {
  // Distance to nothing, exact: along columns first, then the lower envelope of parabolas along rows would
  // do; a rim of a few ten pixels is as quickly found by looking.
  const int reach = static_cast<int>(std::ceil(rim_px));
  const int far = reach + 1;
  std::vector<int> up_down(colours_.size());
  for (int col = 0; col < width_; ++col) {
    int since = far;
    for (int row = 0; row < height_; ++row)
      up_down[at(col, row)] = since = is_covered(col, row) ? std::min(far, since + 1) : 0;
    since = far;
    for (int row = height_ - 1; row >= 0; --row) {
      since = is_covered(col, row) ? std::min(far, since + 1) : 0;
      up_down[at(col, row)] = std::min(up_down[at(col, row)], since);
    }
  }
  const double rim2 = rim_px * rim_px;
  for (int row = 0; row < height_; ++row)
    for (int col = 0; col < width_; ++col) {
      if (up_down[at(col, row)] == 0) continue;
      for (int c = std::max(0, col - reach); c <= std::min(width_ - 1, col + reach); ++c) {
        const double down = up_down[at(c, row)], across = c - col;
        if (down * down + across * across > rim2) continue;
        depths_[at(col, row)] = tips_[at(col, row)] = kFar;
        colours_[at(col, row)] = background;
        break;
      }
    }
}

void Raster::shade(int blur_px, double mm_per_px, double strength_ratio) {
  const std::vector<float> depths = blurred_depths(std::max(1, blur_px));
  const int reach = std::max(1, blur_px / 2);
  for (int row = 0; row < height_; ++row)
    for (int col = 0; col < width_; ++col) {
      if (!is_covered(col, row)) continue;
      const auto slope = [&](int dx, int dy) {  // one-sided beside a rim
        int c0 = std::max(0, col - dx), c1 = std::min(width_ - 1, col + dx);
        int r0 = std::max(0, row - dy), r1 = std::min(height_ - 1, row + dy);
        if (depths[at(c0, r0)] == kFar) c0 = col, r0 = row;
        if (depths[at(c1, r1)] == kFar) c1 = col, r1 = row;
        const double way_px = (c1 - c0) + (r1 - r0);
        if (way_px <= 0.0) return 0.0;
        return static_cast<double>(depths[at(c1, r1)] - depths[at(c0, r0)]) / (mm_per_px * way_px);
      };
      // Rises to the right or downwards face the light from the upper left.
      const double light = std::clamp(0.6 * slope(reach, 0) + 0.8 * slope(0, reach), -1.0, 1.0);
      // Shadows darken up to a fifth, light hardly brightens: flat parts keep the very colours of the scale.
      const double range = light < 0.0 ? 0.2 : 0.04;
      const double factor = 1.0 + strength_ratio * range * std::round(100.0 * std::tanh(1.5 * light)) / 100.0;
      Rgb& c = colours_[at(col, row)];
      c = {scaled(c.red, factor), scaled(c.green, factor), scaled(c.blue, factor)};
    }
}

}  // namespace arris::report
