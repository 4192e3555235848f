// The picture of docs/faces.md: sections through a plate with a hole, one for each thing a drawing can be,
// and where the path runs.
#include <array>
#include <cstdio>
#include <fstream>
#include <string>

#include "report/canvas.hpp"

namespace {

using namespace arris::report;  // NOLINT: one small program
using Eigen::Vector2d;

constexpr int kPanelWidthPx = 460, kPanelHeightPx = 300, kColumns = 2, kRows = 3;
constexpr double kTopPx = 130.0, kBottomPx = 210.0, kHoleLeftPx = 175.0, kHoleRightPx = 285.0;
constexpr double kLeftPx = 30.0, kRightPx = 430.0;
const Rgb kMaterial{214, 219, 226}, kInk{34, 34, 34}, kDrawn{0, 90, 181}, kScan{120, 120, 120},
    kPath{200, 60, 20}, kWhite{255, 255, 255};

class Panel {
 public:
  Panel(Canvas& canvas, int index)
      : canvas_(canvas), x_(kPanelWidthPx * (index % kColumns)), y_(kPanelHeightPx * (index / kColumns)) {}

  void part(const std::string& title, const std::string& below) {
    canvas_.text(x_ + kLeftPx, y_ + 36, title, {.size_px = 22, .bold = true, .colour = kInk});
    canvas_.text(x_ + kLeftPx, y_ + 270, below, {.size_px = 17, .colour = kInk});
    for (const auto& [from, to] : sides_)
      canvas_.rectangle({x_ + from, y_ + kTopPx, to - from, kBottomPx - kTopPx}, kMaterial);
    for (double at = kLeftPx; at <= kRightPx; at += 10)
      if (at <= kHoleLeftPx - 3 || at >= kHoleRightPx + 3) dot(at, kTopPx - 5, 2.2, kScan);
    canvas_.text(x_ + kRightPx, y_ + 78, "scanner",
                 {.size_px = 16, .colour = kScan, .anchor = Anchor::kRight});
    arrow({kRightPx - 30, 86}, {kRightPx - 30, 116}, kScan);
  }

  /// The drawing's line at a height, with its normal.
  void drawn(double height_px, double normal_px) {
    for (const auto& [from, to] : sides_) line({from, height_px}, {to, height_px}, kDrawn, 4);
    arrow({kLeftPx + 40, height_px}, {kLeftPx + 40, height_px + normal_px}, kDrawn);
  }

  void drawn_solid() {
    for (const auto& [from, to] : sides_)
      canvas_.frame({x_ + from, y_ + kTopPx, to - from, kBottomPx - kTopPx},
                    {.colour = kDrawn, .width_px = 4});
    arrow({kLeftPx + 40, kTopPx}, {kLeftPx + 40, kTopPx - 40}, kDrawn);
    arrow({kLeftPx + 40, kBottomPx}, {kLeftPx + 40, kBottomPx + 32}, kDrawn);
  }

  void moved(double from_px, double to_px) {
    arrow({kLeftPx + 90, from_px}, {kLeftPx + 90, to_px + (to_px < from_px ? 4 : -4)}, kInk);
  }

  void rim(double at_px, double height_px, const std::string& name, double text_px) {
    dot(at_px, height_px, 6, kPath);
    canvas_.text(x_ + 230, y_ + text_px, name, {.size_px = 17, .colour = kPath, .anchor = Anchor::kCentre});
  }

  /// The tool at the rim of a face, with its axis out of that face.
  void tool(double height_px, double axis_px) {
    for (const double at : {kHoleLeftPx, kHoleRightPx}) {
      dot(at, height_px, 6, kPath);
      arrow({at, height_px}, {at, height_px + axis_px}, kPath);
    }
  }

  void fibre() {
    for (const double at : {kHoleLeftPx, kHoleRightPx})
      canvas_.polyline(std::array{place({at, kTopPx}), place({at, kBottomPx})}, false,
                       {.colour = kPath, .width_px = 2, .dash_px = {6, 5}});
  }

 private:
  static constexpr std::array<std::array<double, 2>, 2> sides_ = {
      {{kLeftPx, kHoleLeftPx}, {kHoleRightPx, kRightPx}}};

  [[nodiscard]] Vector2d place(const Vector2d& p) const { return {x_ + p.x(), y_ + p.y()}; }
  void dot(double at_px, double height_px, double radius_px, const Rgb& fill) {
    canvas_.disc(place({at_px, height_px}), radius_px, fill, {.colour = fill});
  }
  void line(const Vector2d& a, const Vector2d& b, const Rgb& colour, double width_px) {
    canvas_.polyline(std::array{place(a), place(b)}, false, {.colour = colour, .width_px = width_px});
  }
  void arrow(const Vector2d& from, const Vector2d& to, const Rgb& colour) {
    line(from, to, colour, 2.5);
    const Vector2d back = 9.0 * (from - to).normalized(), side(0.6 * back.y(), 0.6 * back.x());
    line(to, to + back + side, colour, 2.5);
    line(to, to + back - side, colour, 2.5);
  }

  Canvas& canvas_;
  double x_, y_;
};

std::string picture() {
  Canvas canvas(kColumns * kPanelWidthPx, kRows * kPanelHeightPx, kWhite);
  const double middle_px = 0.5 * (kTopPx + kBottomPx);
  Panel scanned(canvas, 0), other(canvas, 1), mid(canvas, 2), solid(canvas, 3), near(canvas, 4),
      far(canvas, 5);
  scanned.part("cad_is = \"scanned_face\"", "taken as it is; normals towards the scanner");
  scanned.drawn(kTopPx, -40);
  other.part("cad_is = \"other_face\"", "moved by thickness_mm; normals turned round");
  other.drawn(kBottomPx, 32);
  other.moved(kBottomPx, kTopPx);
  mid.part("cad_is = \"mid\"", "moved by half of thickness_mm");
  mid.drawn(middle_px, -80);
  mid.moved(middle_px, kTopPx);
  solid.part("cad_is = \"solid\"", "the face of the accepted rim is taken");
  solid.drawn_solid();
  solid.rim(kHoleLeftPx, kTopPx, "contour 2", kTopPx - 14);
  solid.rim(kHoleLeftPx, kBottomPx, "contour 3", kBottomPx + 24);
  near.part("face = \"scanned\"", "axes leave the scanned face");
  near.tool(kTopPx, -48);
  far.part("face = \"other\"", "axes leave the far face");
  far.tool(kBottomPx, 36);
  far.fibre();
  return canvas.png();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("draw_faces OUT.png: the picture of docs/faces.md\n", stderr);
    return 2;
  }
  std::ofstream out(argv[1], std::ios::binary);
  out << picture();
  return out.flush() ? 0 : 3;
}
