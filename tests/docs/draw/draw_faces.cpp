// The picture of docs/faces.md: sections through a plate with a hole, one for each thing a drawing can be,
// and where the path runs.
#include <array>
#include <cstdio>
#include <string>

#include "tests/docs/draw/sketch.hpp"

namespace {

using namespace arris::draw;  // NOLINT: one small program
using arris::report::Anchor;
using arris::report::Canvas;

constexpr int kPanelWidthPx = 460, kPanelHeightPx = 300, kColumns = 2, kRows = 3;
constexpr double kTopPx = 130.0, kBottomPx = 210.0, kHoleLeftPx = 175.0, kHoleRightPx = 285.0;
constexpr double kLeftPx = 30.0, kRightPx = 430.0;

class Panel {
 public:
  Panel(Canvas& canvas, int index)
      : sketch_(canvas, kPanelWidthPx * (index % kColumns), kPanelHeightPx * (index / kColumns)) {}

  void part(const std::string& title, const std::string& below) {
    sketch_.text({kLeftPx, 36}, title, {.size_px = 22, .bold = true, .colour = kInk});
    sketch_.text({kLeftPx, 270}, below, {.size_px = 17, .colour = kInk});
    for (const auto& [from, to] : kSides)
      sketch_.box({from, kTopPx, to - from, kBottomPx - kTopPx}, kMaterial);
    for (double at = kLeftPx; at <= kRightPx; at += 10)
      if (at <= kHoleLeftPx - 3 || at >= kHoleRightPx + 3) sketch_.dot({at, kTopPx - 5}, 2.2, kScan);
    sketch_.text({kRightPx, 78}, "scanner", {.size_px = 16, .colour = kScan, .anchor = Anchor::kRight});
    sketch_.arrow({kRightPx - 30, 86}, {kRightPx - 30, 116}, kScan);
  }

  /// The drawing's line at a height, with its normal.
  void drawn(double height_px, double normal_px) {
    for (const auto& [from, to] : kSides) sketch_.line({from, height_px}, {to, height_px}, kDrawn, 4);
    sketch_.arrow({kLeftPx + 40, height_px}, {kLeftPx + 40, height_px + normal_px}, kDrawn);
  }

  void drawn_solid() {
    for (const auto& [from, to] : kSides)
      sketch_.frame({from, kTopPx, to - from, kBottomPx - kTopPx}, kDrawn, 4);
    sketch_.arrow({kLeftPx + 40, kTopPx}, {kLeftPx + 40, kTopPx - 40}, kDrawn);
    sketch_.arrow({kLeftPx + 40, kBottomPx}, {kLeftPx + 40, kBottomPx + 32}, kDrawn);
  }

  void moved(double from_px, double to_px) {
    sketch_.arrow({kLeftPx + 90, from_px}, {kLeftPx + 90, to_px + (to_px < from_px ? 4 : -4)}, kInk);
  }

  void rim(double at_px, double height_px, const std::string& name, double text_px) {
    sketch_.dot({at_px, height_px}, 6, kPath);
    sketch_.text({230, text_px}, name, {.size_px = 17, .colour = kPath, .anchor = Anchor::kCentre});
  }

  /// The tool at the rim of a face, with its axis out of that face.
  void tool(double height_px, double axis_px) {
    for (const double at : {kHoleLeftPx, kHoleRightPx}) {
      sketch_.dot({at, height_px}, 6, kPath);
      sketch_.arrow({at, height_px}, {at, height_px + axis_px}, kPath);
    }
  }

  void fibre() {
    for (const double at : {kHoleLeftPx, kHoleRightPx}) sketch_.dashed({at, kTopPx}, {at, kBottomPx}, kPath);
  }

 private:
  static constexpr std::array<std::array<double, 2>, 2> kSides = {
      {{kLeftPx, kHoleLeftPx}, {kHoleRightPx, kRightPx}}};

  Sketch sketch_;
};

void draw(Canvas& canvas) {
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
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("draw_faces OUT.png: the picture of docs/faces.md\n", stderr);
    return 2;
  }
  Canvas canvas(kColumns * kPanelWidthPx, kRows * kPanelHeightPx, kWhite);
  draw(canvas);
  return write_png(canvas, argv[1]) ? 0 : 3;
}
