#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/canvas.hpp"

namespace arris::draw {

using Eigen::Vector2d;
using report::Rgb;

// One colour a meaning in all pictures of the pages; blue and red are told apart by colour-blind readers.
inline constexpr Rgb kMaterial{214, 219, 226}, kInk{34, 34, 34}, kDrawn{0, 90, 181}, kScan{120, 120, 120},
    kPath{200, 60, 20}, kWhite{255, 255, 255};

/// A height over x, both in pixels.
using Curve = std::function<double(double)>;

/// A part of a picture with its own origin: what the pages' sketches are made of. Pixels from the top left.
class Sketch {
 public:
  Sketch(report::Canvas& canvas, double left_px, double top_px)
      : canvas_(canvas), origin_px_(left_px, top_px) {}

  void dot(const Vector2d& at_px, double radius_px, const Rgb& fill);
  void ring(const Vector2d& at_px, double radius_px, const Rgb& edge, const Rgb& fill, double width_px = 3.0);
  void box(const report::Box& at_px, const Rgb& fill);
  void frame(const report::Box& at_px, const Rgb& colour, double width_px);
  void rounded(const report::Box& at_px, double radius_px, const Rgb& fill, const Rgb& edge, double width_px);
  void line(const Vector2d& a_px, const Vector2d& b_px, const Rgb& colour, double width_px);
  void dashed(const Vector2d& a_px, const Vector2d& b_px, const Rgb& colour, double width_px = 2.0);
  void arrow(const Vector2d& from_px, const Vector2d& to_px, const Rgb& colour, double width_px = 2.5);
  void span(const Vector2d& a_px, const Vector2d& b_px, const Rgb& colour);  ///< an arrow at both ends
  void polyline(std::vector<Vector2d> points_px, const report::Stroke& stroke);
  void curve(double from_px, double to_px, const Curve& height_px, const report::Stroke& stroke);
  void fill(double from_px, double to_px, const Curve& top_px, const Curve& bottom_px, const Rgb& colour);
  void text(const Vector2d& at_px, const std::string& words, const report::TextStyle& style);

 private:
  [[nodiscard]] Vector2d place(const Vector2d& p_px) const { return origin_px_ + p_px; }
  void head(const Vector2d& from_px, const Vector2d& to_px, const Rgb& colour, double width_px);

  report::Canvas& canvas_;
  Vector2d origin_px_;
};

/// False when the file cannot be written.
[[nodiscard]] bool write_png(const report::Canvas& canvas, const std::string& file);

}  // namespace arris::draw
