#include "tests/docs/draw/sketch.hpp"

#include <array>
#include <fstream>

namespace arris::draw {

using report::Box;
using report::Stroke;

void Sketch::dot(const Vector2d& at_px, double radius_px, const Rgb& fill) {
  canvas_.disc(place(at_px), radius_px, fill, {.colour = fill});
}

void Sketch::ring(const Vector2d& at_px, double radius_px, const Rgb& edge, const Rgb& fill,
                  double width_px) {
  canvas_.disc(place(at_px), radius_px, fill, {.colour = edge, .width_px = width_px});
}

void Sketch::box(const Box& at_px, const Rgb& fill) {
  canvas_.rectangle({origin_px_.x() + at_px.x, origin_px_.y() + at_px.y, at_px.width, at_px.height}, fill);
}

void Sketch::frame(const Box& at_px, const Rgb& colour, double width_px) {
  canvas_.frame({origin_px_.x() + at_px.x, origin_px_.y() + at_px.y, at_px.width, at_px.height},
                {.colour = colour, .width_px = width_px});
}

void Sketch::rounded(const Box& at_px, double radius_px, const Rgb& fill, const Rgb& edge, double width_px) {
  canvas_.rounded_box({origin_px_.x() + at_px.x, origin_px_.y() + at_px.y, at_px.width, at_px.height},
                      radius_px, fill, {.colour = edge, .width_px = width_px});
}

void Sketch::line(const Vector2d& a_px, const Vector2d& b_px, const Rgb& colour, double width_px) {
  canvas_.polyline(std::array{place(a_px), place(b_px)}, false, {.colour = colour, .width_px = width_px});
}

void Sketch::dashed(const Vector2d& a_px, const Vector2d& b_px, const Rgb& colour, double width_px) {
  canvas_.polyline(std::array{place(a_px), place(b_px)}, false,
                   {.colour = colour, .width_px = width_px, .dash_px = {6, 5}});
}

void Sketch::head(const Vector2d& from_px, const Vector2d& to_px, const Rgb& colour, double width_px) {
  const Vector2d back_px = 9.0 * (from_px - to_px).normalized();
  const Vector2d side_px(0.6 * back_px.y(), -0.6 * back_px.x());
  line(to_px, to_px + back_px + side_px, colour, width_px);
  line(to_px, to_px + back_px - side_px, colour, width_px);
}

void Sketch::arrow(const Vector2d& from_px, const Vector2d& to_px, const Rgb& colour, double width_px) {
  line(from_px, to_px, colour, width_px);
  head(from_px, to_px, colour, width_px);
}

void Sketch::span(const Vector2d& a_px, const Vector2d& b_px, const Rgb& colour) {
  arrow(a_px, b_px, colour, 2.0);
  head(b_px, a_px, colour, 2.0);
}

void Sketch::polyline(std::vector<Vector2d> points_px, const Stroke& stroke) {
  for (Vector2d& p : points_px) p = place(p);
  canvas_.polyline(points_px, false, stroke);
}

void Sketch::curve(double from_px, double to_px, const Curve& height_px, const Stroke& stroke) {
  std::vector<Vector2d> points_px;
  for (double x = from_px; x <= to_px; x += 1.0) points_px.emplace_back(x, height_px(x));
  polyline(std::move(points_px), stroke);
}

/// Columns of whole pixels, so that no seam shows between two of them.
void Sketch::fill(double from_px, double to_px, const Curve& top_px, const Curve& bottom_px,
                  const Rgb& colour) {
  for (double x = from_px; x < to_px; x += 1.0) {
    const double top = top_px(x + 0.5);
    box({x, top, 1.0, bottom_px(x + 0.5) - top}, colour);
  }
}

void Sketch::text(const Vector2d& at_px, const std::string& words, const report::TextStyle& style) {
  canvas_.text(origin_px_.x() + at_px.x(), origin_px_.y() + at_px.y(), words, style);
}

bool write_png(const report::Canvas& canvas, const std::string& file) {
  std::ofstream out(file, std::ios::binary);
  out << canvas.png();
  return static_cast<bool>(out.flush());
}

}  // namespace arris::draw
