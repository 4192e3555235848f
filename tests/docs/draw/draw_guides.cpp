// The pictures of docs/operator.md and docs/process-engineer.md: roles, sides, the three results, the frames.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "tests/docs/draw/sketch.hpp"

namespace {

using namespace arris::draw;  // NOLINT: one small program
using arris::report::Anchor;
using arris::report::Box;
using arris::report::Canvas;
using arris::report::TextStyle;

constexpr int kWidthPx = 920;
constexpr double kHalfPx = 460.0;
const TextStyle kTitle{.size_px = 22, .bold = true, .colour = kInk}, kWords{.size_px = 17, .colour = kInk};

TextStyle coloured(const Rgb& colour, Anchor anchor = Anchor::kLeft) {
  return {.size_px = 17, .colour = colour, .anchor = anchor};
}

Curve at(double height_px) {
  return [height_px](double) { return height_px; };
}

// ---------------------------------------------------------------------------------------------- roles.png

/// Where the drawing's material is now: the nominal contour, placed and bent with the part.
double nominal_px(double x) {
  return 150.0 + 12.0 * std::sin(x / 62.0);
}
/// The edge that was made, not quite where the drawing has it.
double found_px(double x) {
  return nominal_px(x) + 18.0 + 12.0 * std::sin(x / 90.0 - 0.7);
}
double rough_px(double x) {
  return nominal_px(x) - 34.0 - 5.0 * std::sin(x / 17.0) - 3.0 * std::sin(x / 7.0);
}

constexpr double kPlanLeftPx = 30.0, kPlanRightPx = 430.0, kPlanBottomPx = 290.0;

/// Scan points from an edge down to the picture's border, in rows that no eye takes for the edge.
void scan_points(Sketch& sketch, const Curve& edge_px, const Vector2d& hole_px, double hole_radius_px) {
  const Box label{hole_px.x() - 140.0, hole_px.y() - 14.0, 140.0, 28.0};
  for (int row = 0; row < 14; ++row)
    for (int column = 0; column < 25; ++column) {
      const Vector2d p(kPlanLeftPx + 8.0 + 16.0 * column + 5.0 * (row % 3),
                       90.0 + 16.0 * row + 3.0 * (column % 4));
      if (p.x() > kPlanRightPx - 4.0 || p.y() > kPlanBottomPx - 4.0 || p.y() < edge_px(p.x()) + 4.0) continue;
      if ((p - hole_px).norm() < hole_radius_px + 4.0 || label.holds(p)) continue;
      sketch.dot(p, 1.8, kScan);
    }
}

void path_along(Sketch& sketch, const Curve& height_px) {
  sketch.curve(kPlanLeftPx, kPlanRightPx, height_px, {.colour = kPath, .width_px = 4, .dash_px = {}});
  for (const double x : {110.0, 350.0})
    sketch.arrow({x - 8.0, height_px(x - 8.0)}, {x + 8.0, height_px(x + 8.0)}, kPath, 4.0);
}

void nominal_line(Sketch& sketch) {
  sketch.curve(kPlanLeftPx, kPlanRightPx, nominal_px, {.colour = kDrawn, .width_px = 3, .dash_px = {9, 6}});
}

void role_edge(Sketch sketch) {
  sketch.text({kPlanLeftPx, 36}, "role = \"edge\"", kTitle);
  sketch.fill(kPlanLeftPx, kPlanRightPx, found_px, at(kPlanBottomPx), kMaterial);
  scan_points(sketch, found_px, {-200.0, -200.0}, 0.0);
  path_along(sketch, found_px);
  nominal_line(sketch);
  const double x = 205.0;
  sketch.line({x, 96}, {x, nominal_px(x) - 2.0}, kInk, 1.5);
  sketch.span({x, nominal_px(x) + 1.0}, {x, found_px(x) - 1.0}, kInk);
  sketch.text({x, 88}, "gap: reported and judged", coloured(kInk, Anchor::kCentre));
  sketch.text({kPlanLeftPx, 324}, "path: follows the edge that was found", coloured(kPath));
  sketch.text({kPlanLeftPx, 352}, "drawing, placed and bent with the part", coloured(kDrawn));
  sketch.text({kPlanLeftPx, 380}, "scan points: they end at the edge", coloured(kScan));
}

void role_cut(Sketch sketch) {
  const Vector2d hole_px(330.0, 232.0);
  sketch.text({kPlanLeftPx, 36}, "role = \"cut\"", kTitle);
  sketch.fill(kPlanLeftPx, kPlanRightPx, rough_px, at(kPlanBottomPx), kMaterial);
  scan_points(sketch, rough_px, hole_px, 26.0);
  sketch.ring(hole_px, 26.0, kDrawn, kWhite, 4.0);
  sketch.text({hole_px.x() - 36.0, hole_px.y() + 6.0}, "datum hole", coloured(kDrawn, Anchor::kRight));
  path_along(sketch, nominal_px);
  const double x = 205.0;
  sketch.span({x, rough_px(x) + 1.0}, {x, nominal_px(x) - 3.0}, kInk);
  sketch.line({x, 96}, {x, rough_px(x) - 2.0}, kInk, 1.5);
  sketch.text({x, 88}, "stock_mm: what is still to come off", coloured(kInk, Anchor::kCentre));
  sketch.text({kPlanLeftPx, 324}, "path: where the drawing's material is now", coloured(kPath));
  sketch.text({kPlanLeftPx, 352}, "outline and datum holes hold the place", coloured(kDrawn));
  sketch.text({kPlanLeftPx, 380}, "a rough edge is no data; none at all will do", coloured(kScan));
}

void roles(Canvas& canvas) {
  role_edge({canvas, 0, 0});
  role_cut({canvas, kHalfPx, 0});
}

// ---------------------------------------------------------------------------------------------- sides.png

constexpr double kFacePx = 120.0, kPlatePx = 22.0;

/// A flat plate with a hole, cut through. Either way its drawn face lies in the scan; turned over, the
/// material is above it.
void flat_plate(Sketch& sketch, double left_px, double right_px, bool face_up) {
  const double hole_px = left_px + 0.62 * (right_px - left_px), half_px = 24.0;
  const std::array<std::array<double, 2>, 2> sides = {
      {{left_px, hole_px - half_px}, {hole_px + half_px, right_px}}};
  const double material_px = face_up ? kFacePx : kFacePx - kPlatePx;
  for (const auto& [from, to] : sides) {
    sketch.box({from, material_px, to - from, kPlatePx}, kMaterial);
    sketch.line({from, kFacePx}, {to, kFacePx}, kDrawn, 4);
    for (double x = from + 6.0; x <= to - 4.0; x += 10.0) sketch.dot({x, kFacePx - 6.0}, 2.2, kScan);
  }
  const double normal_px = face_up ? -38.0 : 38.0;
  sketch.arrow({left_px + 36.0, kFacePx}, {left_px + 36.0, kFacePx + normal_px}, kDrawn);
}

void side(Sketch sketch, bool face_up, const std::string& title, const std::string& below) {
  sketch.text({30, 36}, title, kTitle);
  flat_plate(sketch, 30.0, 430.0, face_up);
  sketch.text({430, 76}, "scan", coloured(kScan, Anchor::kRight));
  sketch.text({30, 206}, below, kWords);
}

void witness(Sketch& sketch, const std::string& title, const std::string& below) {
  sketch.text({30, 36}, title, {.size_px = 19, .bold = true, .colour = kInk});
  flat_plate(sketch, 30.0, 280.0, true);
  sketch.text({30, 182}, below, kWords);
}

void normals_in_file(Sketch sketch) {
  witness(sketch, "1  normals in the file", "they point to the scanner");
  for (const double x : {96.0, 126.0, 156.0, 226.0, 256.0}) sketch.arrow({x, 114}, {x, 84}, kScan, 2.0);
}

void seen_from(Sketch sketch) {
  witness(sketch, "2  scan.seen_from", "a point in the air above the part");
  const Vector2d eye_px(190, 66);
  for (const double x : {100.0, 140.0, 238.0, 270.0}) sketch.dashed(eye_px, {x, 112}, kScan, 1.5);
  sketch.dot(eye_px, 7.0, kPath);
}

void initial_pose(Sketch sketch) {
  witness(sketch, "3  scan.initial", "where the part is held");
  sketch.box({20, kFacePx + kPlatePx + 2.0, 270, 10}, kScan);
  for (const double x : {22.0, 284.0}) sketch.box({x - 4.0, kFacePx - 8.0, 8, kPlatePx + 10.0}, kInk);
  const Vector2d at_px(150, 112);
  sketch.arrow(at_px, at_px + Vector2d(46, 0), kPath);
  sketch.arrow(at_px, at_px + Vector2d(0, -46), kPath);
}

void sides(Canvas& canvas) {
  side({canvas, 0, 0}, true, "as it lies", "The points fit the face that was drawn ...");
  side({canvas, kHalfPx, 0}, false, "turned over", "... and upside down, with the material above.");
  Sketch rule(canvas, 0, 0);
  rule.line({30, 236}, {890, 236}, kMaterial, 2.0);
  rule.text(
      {30, 272},
      "One of these must decide; with none of them, and a part that fits both ways, the run is refused.",
      kWords);
  normals_in_file({canvas, 0, 282});
  seen_from({canvas, 307, 282});
  initial_pose({canvas, 614, 282});
}

// -------------------------------------------------------------------------------------------- results.png

constexpr double kRowPx = 232.0, kDrawnPx = 84.0, kSheetPx = 16.0, kSheetLeftPx = 40.0, kSheetRightPx = 480.0;

/// The scanned face as the clamps hold it: it sags towards the free end.
double bent_px(double x) {
  const double u = (x - kSheetLeftPx) / (kSheetRightPx - kSheetLeftPx);
  return kDrawnPx + 62.0 * u * u;
}

void sheet(Sketch& sketch, double right_px, const Curve& top_px) {
  sketch.fill(
      kSheetLeftPx, right_px, top_px, [&](double x) { return top_px(x) + kSheetPx; }, kMaterial);
}

void scan_on(Sketch& sketch, double right_px, const Curve& top_px) {
  for (double x = kSheetLeftPx + 6.0; x < right_px; x += 11.0) sketch.dot({x, top_px(x) - 3.0}, 2.2, kScan);
}

void clamps(Sketch& sketch, const Curve& top_px) {
  for (const double x : {70.0, 300.0}) {
    sketch.box({x - 7.0, top_px(x) - 26.0, 14, 24}, kInk);
    sketch.box({x - 12.0, std::floor(top_px(x) + kSheetPx + 1.0), 24, 8}, kInk);
  }
}

void drawing(Sketch& sketch) {
  sketch.dashed({kSheetLeftPx, kDrawnPx}, {kSheetRightPx, kDrawnPx}, kDrawn, 3.0);
}

void beside(Sketch& sketch, const std::string& title, const std::array<std::string, 4>& lines) {
  sketch.text({540, 50}, title, kTitle);
  for (std::size_t i = 0; i < lines.size(); ++i)
    sketch.text({540, 84 + 28.0 * static_cast<double>(i)}, lines[i], kWords);
}

void correction(Sketch sketch) {
  sheet(sketch, kSheetRightPx, bent_px);
  scan_on(sketch, kSheetRightPx, bent_px);
  clamps(sketch, bent_px);
  drawing(sketch);
  const Vector2d from_px(kSheetRightPx, kDrawnPx), to_px(kSheetRightPx, bent_px(kSheetRightPx));
  sketch.ring(from_px, 7.0, kDrawn, kWhite);
  sketch.arrow(from_px + Vector2d(0, 10), to_px - Vector2d(0, 9), kPath, 4.0);
  sketch.dot(to_px, 7.0, kPath);
  sketch.text({kSheetRightPx - 14, kDrawnPx - 16}, "path as planned", coloured(kDrawn, Anchor::kRight));
  sketch.text({kSheetRightPx, to_px.y() + 42}, "FORWARD: to where the material is now",
              coloured(kPath, Anchor::kRight));
  beside(sketch, "(i)  Correction",
         {"May the corrected path be used?", "ACCEPTED or REFUSED.", "Cut there, and after release",
          "the edge is where it was drawn."});
}

void shape(Sketch sketch) {
  sheet(sketch, kSheetRightPx, bent_px);
  scan_on(sketch, kSheetRightPx, bent_px);
  clamps(sketch, bent_px);
  drawing(sketch);
  for (const double x : {345.0, 378.0, 411.0, 444.0, 474.0})
    sketch.arrow({x, kDrawnPx + 2.0}, {x, bent_px(x) - 6.0}, kInk, 2.0);
  sketch.text({kSheetLeftPx, 190}, "deviation: from the drawing to the scan points", coloured(kInk));
  beside(sketch, "(ii)  Shape as scanned",
         {"How far is each point off", "the drawing, as it lies now?", "state = \"free\": judged.",
          "clamped: shown, not judged."});
}

void pulled_back(Sketch sketch) {
  constexpr double kEdgePx = kSheetRightPx - 24.0;
  sketch.curve(kSheetLeftPx, kEdgePx, bent_px, {.colour = kScan, .width_px = 2, .dash_px = {6, 5}});
  sheet(sketch, kEdgePx, at(kDrawnPx));
  drawing(sketch);
  const Vector2d found_px(kEdgePx, bent_px(kEdgePx)), back_px(kEdgePx, kDrawnPx);
  sketch.dot(found_px, 7.0, kScan);
  sketch.arrow(found_px - Vector2d(0, 10), back_px + Vector2d(0, 10), kInk, 3.0);
  sketch.dot(back_px, 7.0, kInk);
  sketch.ring({kSheetRightPx, kDrawnPx}, 7.0, kDrawn, kWhite);
  sketch.line({kEdgePx, 54}, {kEdgePx, kDrawnPx - 9.0}, kInk, 1.5);
  sketch.line({kSheetRightPx, 54}, {kSheetRightPx, kDrawnPx - 9.0}, kInk, 1.5);
  sketch.text({kSheetRightPx, 42}, "the edge's own error", coloured(kInk, Anchor::kRight));
  sketch.text({kEdgePx - 14, found_px.y() + 27}, "edge found in the scan", coloured(kScan, Anchor::kRight));
  sketch.text({kSheetLeftPx, 206}, "bending taken out, as if the clamps were open", coloured(kInk));
  beside(sketch, "(iii)  Contour pulled back",
         {"Is the edge right once the", "bending is taken out?", "state = \"clamped\": judged.",
          "free: shown, not judged."});
}

void results(Canvas& canvas) {
  correction({canvas, 0, 0});
  shape({canvas, 0, kRowPx});
  pulled_back({canvas, 0, 2 * kRowPx});
  Sketch rules(canvas, 0, 0);
  for (const double y : {kRowPx, 2 * kRowPx}) rules.line({30, y}, {890, y}, kMaterial, 2.0);
}

// ----------------------------------------------------------------------------------------------- cell.png

void axes(Sketch& sketch, const Vector2d& at_px, const Rgb& colour, double turn_rad) {
  const Vector2d x_px = 34.0 * Vector2d(std::cos(turn_rad), -std::sin(turn_rad));
  sketch.arrow(at_px, at_px + x_px, colour, 3.0);
  sketch.arrow(at_px, at_px + Vector2d(x_px.y(), -x_px.x()), colour, 3.0);
  sketch.dot(at_px, 5.0, colour);
}

const Vector2d kBasePx(62, 330), kScannerPx(206, 96), kPartPx(268, 292);

void robot(Sketch& sketch) {
  sketch.box({40, 338, 44, 30}, kScan);
  sketch.line({62, 330}, {46, 246}, kScan, 12);
  sketch.line({46, 246}, {104, 196}, kScan, 9);
  sketch.line({104, 196}, {112, 222}, kScan, 6);
  axes(sketch, kBasePx, kInk, 0.0);
  sketch.text({34, 394}, "robot's base", kWords);
}

void part_on_fixture(Sketch& sketch) {
  sketch.box({204, 330, 236, 16}, kScan);
  for (const double x : {250.0, 398.0}) sketch.box({x - 6.0, 312, 12, 18}, kScan);
  const Curve top_px = [](double x) {
    return 304.0 - 16.0 * std::sin(std::numbers::pi * (x - 244.0) / 160.0);
  };
  sketch.fill(
      244, 404, top_px, [&](double x) { return top_px(x) + 12.0; }, kMaterial);
  sketch.curve(244, 404, top_px, {.colour = kDrawn, .width_px = 3, .dash_px = {}});
  axes(sketch, kPartPx, kDrawn, 0.1);
  sketch.text({324, 394}, "part on its fixture", coloured(kInk, Anchor::kCentre));
}

void scanner(Sketch& sketch, double turn_rad) {
  sketch.box({kScannerPx.x() - 30.0, kScannerPx.y() - 26.0, 62, 40}, kMaterial);
  axes(sketch, kScannerPx, kPath, turn_rad);
}

/// The two motions that bring the drawing to the robot.
void chain(Sketch& sketch, const std::string& how) {
  sketch.arrow(kBasePx + Vector2d(8, -14), kScannerPx + Vector2d(-7, 12), kPath, 3.0);
  sketch.text({22, 108}, "robot_from_scan", coloured(kPath));
  sketch.text({22, 131}, how, coloured(kPath));
  sketch.arrow(kScannerPx + Vector2d(4, 14), kPartPx + Vector2d(-8, -14), kDrawn, 3.0);
  sketch.text({290, 108}, "scan_from_cad", coloured(kDrawn));
  sketch.text({290, 131}, "found each time", coloured(kDrawn));
}

void fixed_scanner(Sketch sketch) {
  sketch.text({30, 36}, "scan_reference = \"fixed\"", kTitle);
  robot(sketch);
  part_on_fixture(sketch);
  sketch.line({kScannerPx.x(), 56}, {kScannerPx.x(), 72}, kScan, 8);
  sketch.line({150, 56}, {262, 56}, kScan, 6);
  scanner(sketch, 0.0);
  chain(sketch, "measured once");
}

void hand_scanner(Sketch sketch) {
  const std::array<Vector2d, 3> spheres_px = {Vector2d(220, 300), Vector2d(330, 248), Vector2d(424, 284)};
  sketch.text({30, 36}, "scan_reference = \"targets\"", kTitle);
  robot(sketch);
  for (const Vector2d& at_px : spheres_px) sketch.line(at_px, {at_px.x(), 332}, kScan, 5);
  part_on_fixture(sketch);
  scanner(sketch, -0.35);
  for (const Vector2d& at_px : spheres_px) {
    sketch.dashed(kScannerPx + Vector2d(10, 16), at_px, kScan, 1.5);
    sketch.ring(at_px, 10.0, kInk, kWhite);
  }
  chain(sketch, "solved each time");
  sketch.arrow(kBasePx + Vector2d(14, -4), spheres_px[0] + Vector2d(-13, 3), kInk);
  sketch.text({89, 353}, "known places", {.size_px = 16, .colour = kInk});
}

void cell(Canvas& canvas) {
  fixed_scanner({canvas, 0, 0});
  hand_scanner({canvas, kHalfPx, 0});
  Sketch below(canvas, 0, 0);
  below.line({30, 418}, {890, 418}, kMaterial, 2.0);
  below.text({30, 450}, "robot_from_scan * scan_from_cad takes a point of the drawing to the robot.", kWords);
}

// ----------------------------------------------------------------------------------------------- scan.png

const Box kPlateBox{30, 60, 400, 230}, kOpeningBox{100, 112, 190, 126};
const Vector2d kLargeHolePx(360, 236), kSmallHolePx(376, 118);
constexpr double kLargeHoleRadiusPx = 27.0, kSmallHoleRadiusPx = 16.0, kCornerPx = 36.0;

/// Distance from the rim of the opening: positive on the material.
double from_opening_px(const Vector2d& p) {
  const Vector2d middle(kOpeningBox.x + 0.5 * kOpeningBox.width, kOpeningBox.y + 0.5 * kOpeningBox.height);
  const Vector2d half(0.5 * kOpeningBox.width - kCornerPx, 0.5 * kOpeningBox.height - kCornerPx);
  const Vector2d out = (p - middle).cwiseAbs() - half;
  return out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0) - kCornerPx;
}

void plate(Sketch& sketch) {
  sketch.box(kPlateBox, kMaterial);
  sketch.rounded(kOpeningBox, kCornerPx, kWhite, kScan, 1.0);
  sketch.ring(kLargeHolePx, kLargeHoleRadiusPx, kScan, kWhite, 1.0);
  sketch.ring(kSmallHolePx, kSmallHoleRadiusPx, kScan, kWhite, 1.0);
}

bool on_plate(const Vector2d& p) {
  return from_opening_px(p) > 3.0 && (p - kLargeHolePx).norm() > kLargeHoleRadiusPx + 3.0 &&
         (p - kSmallHolePx).norm() > kSmallHoleRadiusPx + 3.0;
}

void scan_where(Sketch& sketch, const std::function<bool(const Vector2d&)>& is_seen) {
  for (int row = 0; row < 23; ++row)
    for (int column = 0; column < 40; ++column) {
      const Vector2d p(35.0 + 10.0 * column + 3.0 * (row % 3 - 1),
                       65.0 + 10.0 * row + 2.0 * (column % 3 - 1));
      if (kPlateBox.holds(p) && on_plate(p) && is_seen(p)) sketch.dot(p, 1.6, kScan);
    }
}

void flag(Sketch& sketch, const Vector2d& at_px, const std::string& number, const Rgb& colour) {
  sketch.ring(at_px, 12.0, colour, kWhite, 2.5);
  sketch.text(at_px + Vector2d(0, 6), number,
              {.size_px = 17, .bold = true, .colour = colour, .anchor = Anchor::kCentre});
}

void below_scan(Sketch& sketch, const std::array<std::string, 3>& lines, const Rgb& colour) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double y = 324.0 + 34.0 * static_cast<double>(i);
    flag(sketch, {42, y - 6.0}, std::to_string(i + 1), colour);
    sketch.text({66, y}, lines[i], kWords);
  }
}

void good_scan(Sketch sketch) {
  sketch.text({30, 36}, "scan it so", kTitle);
  plate(sketch);
  scan_where(sketch, [](const Vector2d&) { return true; });
  sketch.rounded(kOpeningBox, kCornerPx, kWhite, kDrawn, 4.0);
  flag(sketch, {195, 112}, "1", kDrawn);
  flag(sketch, {334, 190}, "2", kDrawn);
  flag(sketch, {66, 262}, "3", kDrawn);
  below_scan(sketch,
             {"the whole edge, all round", "holes or a corner: they tell which way round",
              "the face beside the edge, 60 mm or more"},
             kDrawn);
}

void bad_scan(Sketch sketch) {
  sketch.text({30, 36}, "not so", kTitle);
  plate(sketch);
  const Vector2d gap_px(272, 226);
  scan_where(sketch,
             [&](const Vector2d& p) { return from_opening_px(p) < 32.0 && (p - gap_px).norm() > 62.0; });
  sketch.box({130, 92, 52, 34}, kInk);
  flag(sketch, {262, 206}, "1", kPath);
  flag(sketch, {372, 178}, "2", kPath);
  flag(sketch, {156, 109}, "3", kPath);
  below_scan(sketch,
             {"a stretch of the edge without points", "no hole, no corner: two ways to lay it",
              "a clamp, chips or dust over the edge"},
             kPath);
}

void scan(Canvas& canvas) {
  good_scan({canvas, 0, 0});
  bad_scan({canvas, kHalfPx, 0});
}

struct Picture {
  const char* name;
  int height_px;
  void (*draw)(Canvas&);
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("draw_guides FOLDER: the pictures of the operator's and the process engineer's guide\n",
               stderr);
    return 2;
  }
  for (const Picture& picture : {Picture{"roles.png", 400, roles}, Picture{"sides.png", 490, sides},
                                 Picture{"results.png", 690, results}, Picture{"cell.png", 480, cell},
                                 Picture{"scan.png", 420, scan}}) {
    Canvas canvas(kWidthPx, picture.height_px, kWhite);
    picture.draw(canvas);
    if (!write_png(canvas, std::string(argv[1]) + "/" + picture.name)) return 3;
  }
  return 0;
}
