#include "report/canvas.hpp"

#include <cairo.h>

#include <cmath>
#include <cstring>

#include "acquisition/types/error.hpp"
#include "report/raster.hpp"

namespace arris::report {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct SurfaceCloser {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceCloser>;

Surface surface_of(int width_px, int height_px) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS)
    throw Error(Fault::kBug, "a picture of " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                                 " pixels cannot be made");
  return surface;
}

cairo_status_t append_bytes(void* text, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

struct Canvas::Impl {
  Surface surface;
  cairo_t* cairo = nullptr;

  void source(const Rgb& c, double opacity_ratio = 1.0) const {
    cairo_set_source_rgba(cairo, c.red / 255.0, c.green / 255.0, c.blue / 255.0, opacity_ratio);
  }
  void stroke(const Stroke& s) const {
    source(s.colour, s.opacity_ratio);
    cairo_set_line_width(cairo, s.width_px);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cairo, s.dash_px.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(cairo, s.dash_px.data(), static_cast<int>(s.dash_px.size()), 0.0);
    cairo_stroke(cairo);
  }
  void font(const TextStyle& style) const {
    cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, style.size_px);
  }
};

Canvas::Canvas(int width_px, int height_px, const Rgb& background) : impl_(std::make_unique<Impl>()) {
  impl_->surface = surface_of(width_px, height_px);
  impl_->cairo = cairo_create(impl_->surface.get());
  // Fixed rendering of text, whatever the desktop prefers.
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(impl_->cairo, options);
  cairo_font_options_destroy(options);
  rectangle({0, 0, static_cast<double>(width_px), static_cast<double>(height_px)}, background);
}

Canvas::~Canvas() {
  cairo_destroy(impl_->cairo);
}

void Canvas::raster(const Raster& raster, double x, double y) {
  const Surface image = surface_of(raster.width(), raster.height());
  cairo_surface_flush(image.get());
  unsigned char* bytes = cairo_image_surface_get_data(image.get());
  const int stride = cairo_image_surface_get_stride(image.get());
  for (int row = 0; row < raster.height(); ++row)
    for (int col = 0; col < raster.width(); ++col) {
      const Rgb c = raster.colour(col, row);
      const std::uint32_t word = (std::uint32_t{c.red} << 16U) | (std::uint32_t{c.green} << 8U) | c.blue;
      std::memcpy(bytes + static_cast<std::ptrdiff_t>(row) * stride + 4 * static_cast<std::ptrdiff_t>(col),
                  &word, 4);
    }
  cairo_surface_mark_dirty(image.get());
  cairo_set_source_surface(impl_->cairo, image.get(), x, y);
  cairo_rectangle(impl_->cairo, x, y, raster.width(), raster.height());
  cairo_fill(impl_->cairo);
}

void Canvas::polyline(std::span<const Eigen::Vector2d> points, bool closed, const Stroke& stroke) {
  if (points.size() < 2) return;
  cairo_new_path(impl_->cairo);
  for (const Eigen::Vector2d& p : points) cairo_line_to(impl_->cairo, p.x(), p.y());
  if (closed) cairo_close_path(impl_->cairo);
  impl_->stroke(stroke);
}

void Canvas::rectangle(const Box& box, const Rgb& fill) {
  impl_->source(fill);
  cairo_rectangle(impl_->cairo, box.x, box.y, box.width, box.height);
  cairo_fill(impl_->cairo);
}

void Canvas::frame(const Box& box, const Stroke& stroke) {
  cairo_rectangle(impl_->cairo, box.x, box.y, box.width, box.height);
  impl_->stroke(stroke);
}

void Canvas::hatched(const Box& box) {
  Raster pattern(static_cast<int>(box.width), static_cast<int>(box.height), {255, 255, 255});
  for (int row = 0; row < pattern.height(); ++row)
    for (int col = 0; col < pattern.width(); ++col) pattern.set(col, row, no_data_pattern(col, row));
  raster(pattern, box.x, box.y);
}

void Canvas::rounded_box(const Box& box, double radius_px, const Rgb& fill, const Stroke& edge) {
  const double r = radius_px, right = box.x + box.width, bottom = box.y + box.height;
  cairo_new_path(impl_->cairo);
  cairo_arc(impl_->cairo, right - r, box.y + r, r, -0.5 * kPi, 0.0);
  cairo_arc(impl_->cairo, right - r, bottom - r, r, 0.0, 0.5 * kPi);
  cairo_arc(impl_->cairo, box.x + r, bottom - r, r, 0.5 * kPi, kPi);
  cairo_arc(impl_->cairo, box.x + r, box.y + r, r, kPi, 1.5 * kPi);
  cairo_close_path(impl_->cairo);
  impl_->source(fill);
  cairo_fill_preserve(impl_->cairo);
  impl_->stroke(edge);
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius_px, const Rgb& fill, const Stroke& edge) {
  cairo_new_path(impl_->cairo);
  cairo_arc(impl_->cairo, centre.x(), centre.y(), radius_px, 0.0, 2.0 * kPi);
  impl_->source(fill);
  cairo_fill_preserve(impl_->cairo);
  impl_->stroke(edge);
}

void Canvas::text(double x, double y, const std::string& text, const TextStyle& style) {
  impl_->font(style);
  const double width = style.anchor == Anchor::kLeft ? 0.0 : text_width(text, style);
  const double shift =
      style.anchor == Anchor::kCentre ? 0.5 * width : (style.anchor == Anchor::kRight ? width : 0.0);
  if (style.halo) {
    cairo_move_to(impl_->cairo, x - shift, y);
    cairo_text_path(impl_->cairo, text.c_str());
    impl_->stroke({{255, 255, 255}, 6.0, {}, 1.0});
  }
  impl_->source(style.colour);
  cairo_move_to(impl_->cairo, x - shift, y);
  cairo_show_text(impl_->cairo, text.c_str());
}

double Canvas::text_width(const std::string& text, const TextStyle& style) const {
  impl_->font(style);
  cairo_text_extents_t extents;
  cairo_text_extents(impl_->cairo, text.c_str(), &extents);
  return extents.x_advance;
}

std::string Canvas::fitted(const std::string& text, const TextStyle& style, double width_px) const {
  if (text_width(text, style) <= width_px) return text;
  std::string cut = text;
  while (!cut.empty() && text_width(cut + "...", style) > width_px) {
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0x80U)
      cut.pop_back();  // UTF-8 tail
    if (!cut.empty()) cut.pop_back();
  }
  return cut + "...";
}

void Canvas::clip(const Box& box) {
  cairo_save(impl_->cairo);
  cairo_rectangle(impl_->cairo, box.x, box.y, box.width, box.height);
  cairo_clip(impl_->cairo);
}

void Canvas::unclip() {
  cairo_restore(impl_->cairo);
}

std::string Canvas::png() const {
  std::string bytes;
  cairo_surface_flush(impl_->surface.get());
  const cairo_status_t status = cairo_surface_write_to_png_stream(impl_->surface.get(), append_bytes, &bytes);
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(Fault::kBug, std::string("a picture cannot be written: ") + cairo_status_to_string(status));
  return bytes;
}

}  // namespace arris::report
