#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "report/colour_map.hpp"

namespace arris::report {

class Raster;

/// How a line is drawn.
struct Stroke {
  Rgb colour;
  double width_px = 1.0;
  std::vector<double> dash_px;  ///< on, off, ...; empty: solid
  double opacity_ratio = 1.0;
};

enum class Anchor { kLeft, kCentre, kRight };

/// How a text is set; y is its base line.
struct TextStyle {
  double size_px = 24.0;
  bool bold = false;
  Rgb colour{34, 34, 34};
  Anchor anchor = Anchor::kLeft;
  bool halo = false;  ///< a white rim, for text over the drawing
};

struct Box {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
  [[nodiscard]] bool overlaps(const Box& other) const;
  [[nodiscard]] bool holds(const Eigen::Vector2d& p) const;
};

/// A picture in memory that needs no display; pixels from the top left. Same calls, same bytes (one set of
/// fonts).
class Canvas {
 public:
  Canvas(int width_px, int height_px, const Rgb& background);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void raster(const Raster& raster, double x, double y);
  void polyline(std::span<const Eigen::Vector2d> points, bool closed, const Stroke& stroke);
  void rectangle(const Box& box, const Rgb& fill);
  void frame(const Box& box, const Stroke& stroke);
  void hatched(const Box& box);  ///< the pattern of "no data"
  void rounded_box(const Box& box, double radius_px, const Rgb& fill, const Stroke& edge);
  void disc(const Eigen::Vector2d& centre, double radius_px, const Rgb& fill, const Stroke& edge);
  void text(double x, double y, const std::string& text, const TextStyle& style);
  [[nodiscard]] double text_width(const std::string& text, const TextStyle& style) const;
  /// Text cut to a width, with an ellipsis when it had to be.
  [[nodiscard]] std::string fitted(const std::string& text, const TextStyle& style, double width_px) const;
  void clip(const Box& box);  ///< until unclip()
  void unclip();
  [[nodiscard]] std::string png() const;  ///< the file's bytes

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Places for boxes of the given sizes (width, height) near their anchors: inside `bounds`, over no other
/// box, no obstacle and no anchor; as near as is possible without leaders that cross. A box that fits nowhere
/// has width 0.
[[nodiscard]] std::vector<Box> place_labels(std::span<const Eigen::Vector2d> anchors,
                                            std::span<const Eigen::Vector2d> sizes, const Box& bounds,
                                            std::vector<Box> obstacles);

/// Moves ascending positions apart until neighbours are at least `gap` apart, as little as that takes, within
/// [low, high] if they fit.
[[nodiscard]] std::vector<double> spread(std::vector<double> positions, double gap, double low, double high);

}  // namespace arris::report
