#include "tests/bench/pictures/figure.hpp"

#include <cairo.h>

#include <cstring>
#include <fstream>
#include <memory>

#include "acquisition/types/error.hpp"

namespace arris::bench {
namespace {

constexpr double kShrunkRatio = 0.5;

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Drawing = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

struct Unread {
  const std::string& bytes;
  std::size_t next = 0;
};

cairo_status_t read_bytes(void* source, unsigned char* to, unsigned int count) {
  auto& unread = *static_cast<Unread*>(source);
  if (unread.bytes.size() - unread.next < count) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(to, unread.bytes.data() + unread.next, count);
  unread.next += count;
  return CAIRO_STATUS_SUCCESS;
}

cairo_status_t append_bytes(void* to, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::string shrunk(const std::string& png) {
  Unread unread{png};
  const Surface large(cairo_image_surface_create_from_png_stream(read_bytes, &unread), cairo_surface_destroy);
  const auto part = [](int size_px) { return static_cast<int>(kShrunkRatio * size_px); };
  const Surface small(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, part(cairo_image_surface_get_width(large.get())),
                                 part(cairo_image_surface_get_height(large.get()))),
      cairo_surface_destroy);
  const Drawing drawing(cairo_create(small.get()), cairo_destroy);
  cairo_scale(drawing.get(), kShrunkRatio, kShrunkRatio);
  cairo_set_source_surface(drawing.get(), large.get(), 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(drawing.get()), CAIRO_FILTER_GOOD);
  cairo_paint(drawing.get());
  std::string bytes;
  if (cairo_surface_write_to_png_stream(small.get(), append_bytes, &bytes) != CAIRO_STATUS_SUCCESS)
    throw Error(Fault::kBug, "a picture could not be shrunk");
  return bytes;
}

void write_figures(const std::vector<Figure>& figures, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const Figure& figure : figures) {
    std::ofstream out(folder / figure.file, std::ios::binary | std::ios::trunc);
    out << figure.png;
    out.close();
    if (!out) throw Error(Fault::kInput, "cannot write " + (folder / figure.file).string());
  }
}

}  // namespace arris::bench
