#include "toolpath/from_contour.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/geometry/polyline.hpp"
#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr double kFanStepRad = 0.26;  // 15 degrees: the mitre of a flatter turn is at most 1 % too long
constexpr double kPi = 3.14159265358979323846;

// A place on the contour, in the order of travel; `side` points to the void, a mitre longer than 1.
struct Place {
  Vector3d point_mm, normal, side, travel;
};

std::string name_of(const Contour& contour) {
  return "contour " + std::to_string(contour.id);
}

double distance_to_chord_mm(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d chord = b - a;
  const double length2 = chord.squaredNorm();
  const double ratio = length2 > 0.0 ? std::clamp((p - a).dot(chord) / length2, 0.0, 1.0) : 0.0;
  return (p - (a + ratio * chord)).norm();
}

// Douglas and Peucker: the vertices that keep the polyline within `within_mm` of its chords.
std::vector<std::size_t> key_vertices(const std::vector<Vector3d>& points, double within_mm) {
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double worst_mm = within_mm;
    std::size_t worst = last;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double off_mm = distance_to_chord_mm(points[i], points[first], points[last]);
      if (off_mm > worst_mm) {
        worst_mm = off_mm;
        worst = i;
      }
    }
    if (worst == last) continue;
    kept[worst] = true;
    open.emplace_back(first, worst);
    open.emplace_back(worst, last);
  }
  std::vector<std::size_t> keys;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (kept[i]) keys.push_back(i);
  return keys;
}

// Arc lengths of the rows from the seam once along the contour: its key vertices, and equal parts between
// them. The end is included; of a closed contour it is the seam again.
std::vector<double> row_arcs_mm(const Curve& curve, const FromContourOptions& options) {
  const double begin_mm = curve.closed() ? curve.wrap_mm(options.seam_mm) : 0.0;
  std::vector<double> arcs_mm = {0.0};
  const int n = static_cast<int>(curve.contour().points_mm.size());
  for (int i = 0; i < n; ++i) {
    double arc_mm = curve.arc_of_point_mm(i) - begin_mm;
    if (arc_mm <= 0.0 && curve.closed()) arc_mm += curve.length_mm();
    arcs_mm.push_back(arc_mm);
  }
  arcs_mm.push_back(curve.length_mm());
  std::sort(arcs_mm.begin(), arcs_mm.end());
  arcs_mm.erase(std::unique(arcs_mm.begin(), arcs_mm.end(), [](double a, double b) { return b - a < 1e-9; }),
                arcs_mm.end());
  std::vector<Vector3d> points;
  for (double arc_mm : arcs_mm) points.push_back(curve.point_mm(begin_mm + arc_mm));

  const std::vector<std::size_t> keys = key_vertices(points, options.chord_error_mm);
  std::vector<double> rows_mm = {begin_mm};
  for (std::size_t k = 1; k < keys.size(); ++k) {
    const double from_mm = arcs_mm[keys[k - 1]], to_mm = arcs_mm[keys[k]];
    const int parts = std::max(1, static_cast<int>(std::ceil((to_mm - from_mm) / options.step_mm - 1e-9)));
    for (int part = 1; part <= parts; ++part)
      rows_mm.push_back(begin_mm + from_mm + (to_mm - from_mm) * part / parts);
  }
  return rows_mm;
}

// Not a number when the direction runs along the normal; add_contour refuses such rows.
Vector3d in_surface(const Vector3d& direction, const Vector3d& normal) {
  const Vector3d flat = direction - direction.dot(normal) * normal;
  if (flat.norm() < 1e-6 * direction.norm())
    return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return flat.normalized();
}

// The places of one corner or of one point between: seen against the normal the contour turns by `turn_rad`
// to the left.
void add_places(const Vector3d& point_mm, const Vector3d& normal, const Vector3d& into,
                const Vector3d& out_of, double offset_mm, std::vector<Place>& places) {
  const double turn_rad = std::atan2(normal.dot(into.cross(out_of)), into.dot(out_of));
  const Vector3d first = into.cross(normal);
  const bool outer = turn_rad * offset_mm > 0.0 && std::abs(turn_rad) > kFanStepRad;
  const int parts = outer ? static_cast<int>(std::ceil(std::abs(turn_rad) / kFanStepRad)) : 1;
  for (int part = 0; part <= parts; ++part) {
    const double angle_rad = outer ? turn_rad * part / parts : 0.5 * turn_rad;
    const double mitre = outer ? 1.0 : 1.0 / std::max(0.1, std::cos(0.5 * turn_rad));
    const Vector3d side = Eigen::AngleAxisd(angle_rad, normal) * first;
    places.push_back({point_mm, normal, mitre * side, normal.cross(side)});
    if (!outer) break;
  }
}

std::vector<Place> places_along(const Curve& curve, const FromContourOptions& options) {
  const std::vector<double> arcs_mm = row_arcs_mm(curve, options);
  std::vector<Vector3d> points;
  for (double arc_mm : arcs_mm) points.push_back(curve.point_mm(arc_mm));
  const std::size_t count = curve.closed() ? points.size() - 1 : points.size();
  std::vector<Place> places;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d normal = curve.normal(arcs_mm[i]);
    const std::size_t before = i > 0 ? i - 1 : (curve.closed() ? count - 1 : 0);
    const std::size_t after = i + 1 < points.size() ? i + 1 : i;
    Vector3d into = points[i] - points[before], out_of = points[after] - points[i];
    if (before == i) into = out_of;
    if (after == i) out_of = into;
    add_places(points[i], normal, in_surface(into, normal), in_surface(out_of, normal), options.offset_mm,
               places);
  }
  return places;
}

// Rows whose tip would come nearer to the contour than the offset lie in an inner corner that is too tight
// for them.
std::vector<Place> with_room(const std::vector<Place>& places, const Curve& curve,
                             const FromContourOptions& options, const std::string& name) {
  const double needed_mm = std::abs(options.offset_mm) * 0.98 - 0.005;
  if (needed_mm <= 0.0) return places;
  std::vector<Place> kept;
  for (const Place& place : places)
    if (curve.nearest(place.point_mm + options.offset_mm * place.side).distance_mm >= needed_mm)
      kept.push_back(place);
  double widest_mm = 0.0;
  const auto tip = [&](std::size_t i) {
    return Vector3d(kept[i].point_mm + options.offset_mm * kept[i].side);
  };
  for (std::size_t i = 0; i + 1 < kept.size(); ++i)
    widest_mm = std::max(widest_mm, (tip(i + 1) - tip(i)).norm());
  if (curve.closed() && kept.size() > 1)
    widest_mm = std::max(widest_mm, (tip(0) - tip(kept.size() - 1)).norm());
  if (kept.size() < 2 || widest_mm > 3.0 * options.step_mm + 0.5 + std::abs(options.offset_mm) * kFanStepRad)
    throw Error(Fault::kRecipe,
                ErrorText{"the contour has no room for the offset", name,
                          "offset_mm = " + fixed_text(options.offset_mm, 3) + ", " +
                              std::to_string(kept.size()) + " of " + std::to_string(places.size()) +
                              " rows left, the widest gap " + fixed_text(widest_mm, 1) + " mm",
                          "an offset that the contour's bends and width leave room for",
                          "change toolpath.from_contour.offset_mm"});
  return kept;
}

PathPoint row_at(const Place& place, int path, bool closed, const FromContourOptions& options) {
  PathPoint row;
  const Vector3d travel = options.reversed ? Vector3d(-place.travel) : place.travel;
  row.tip_mm = place.point_mm + options.offset_mm * place.side - options.depth_mm * place.normal;
  row.axis = (place.normal + std::tan(options.lateral_rad) * place.side.normalized() +
              std::tan(options.lead_rad) * travel)
                 .normalized();
  row.path = path;
  row.feed_mm_s = options.feed_mm_s;
  row.closed = closed;
  return row;
}

void add_contour(const Contour& contour, int number, const FromContourOptions& options, ToolPath& path) {
  if (contour.normals.size() != contour.points_mm.size() || contour.points_mm.empty())
    throw Error(Fault::kInput, ErrorText{"a tool path needs the contour's normals", name_of(contour),
                                         std::to_string(contour.normals.size()) + " normals for " +
                                             std::to_string(contour.points_mm.size()) + " points",
                                         "one a point", ""});
  if (!(length_mm(contour) > 1e-6))
    throw Error(Fault::kInput,
                ErrorText{"a contour without length", name_of(contour), "", "two distinct points", ""});
  if (!contour.closed && options.seam_mm != 0.0)
    throw Error(Fault::kRecipe, "from_contour.seam_mm = " + fixed_text(options.seam_mm, 3) + ", need 0 for " +
                                    name_of(contour) + ", which is open");
  const Curve curve(contour);
  std::vector<Place> places = places_along(curve, options);
  for (const Place& place : places)
    if (!place.side.allFinite() || place.normal.norm() < 0.5)
      throw Error(Fault::kInput, ErrorText{"a contour that runs along its own normal", name_of(contour), "",
                                           "unit normals of the surface", ""});
  places = with_room(places, curve, options, name_of(contour));
  if (options.reversed) {  // a closed path still begins at the seam
    std::reverse(places.begin(), places.end());
    if (contour.closed) std::rotate(places.begin(), places.end() - 1, places.end());
  }
  const bool lifted = options.approach_mm > 0.0 || options.retract_mm > 0.0;
  if (contour.closed && lifted) places.push_back(places.front());
  const bool closed = contour.closed && !lifted;
  std::vector<PathPoint> rows;
  for (const Place& place : places) rows.push_back(row_at(place, number, closed, options));
  const auto above = [](PathPoint row, double by_mm) {
    row.tip_mm += by_mm * row.axis;
    return row;
  };
  if (options.approach_mm > 0.0) rows.insert(rows.begin(), above(rows.front(), options.approach_mm));
  if (options.retract_mm > 0.0) rows.push_back(above(rows.back(), options.retract_mm));
  path.points.insert(path.points.end(), rows.begin(), rows.end());
}

}  // namespace

void FromContourOptions::check() const {
  const auto need = [](bool holds, const char* field, double value, const char* bound) {
    if (!holds || !std::isfinite(value))
      throw Error(Fault::kRecipe,
                  "from_contour." + std::string(field) + " = " + std::to_string(value) + ", need " + bound);
  };
  need(std::abs(offset_mm) <= 1000.0, "offset_mm", offset_mm, "-1000 to 1000");
  need(std::abs(depth_mm) <= 1000.0, "depth_mm", depth_mm, "-1000 to 1000");
  need(std::abs(lateral_rad) < 0.49 * kPi, "lateral_rad", lateral_rad, "less than a right angle");
  need(std::abs(lead_rad) < 0.49 * kPi, "lead_rad", lead_rad, "less than a right angle");
  need(step_mm >= 0.01, "step_mm", step_mm, ">= 0.01");
  need(chord_error_mm >= 1e-4, "chord_error_mm", chord_error_mm, ">= 0.0001");
  need(seam_mm >= 0.0, "seam_mm", seam_mm, ">= 0");
  need(approach_mm >= 0.0, "approach_mm", approach_mm, ">= 0");
  need(retract_mm >= 0.0, "retract_mm", retract_mm, ">= 0");
  need(feed_mm_s >= 0.0, "feed_mm_s", feed_mm_s, ">= 0");
}

ToolPath path_from_contours(std::span<const Contour> contours, const FromContourOptions& options) {
  options.check();
  if (contours.empty())
    throw Error(Fault::kInput,
                ErrorText{"no contour to make a tool path from", "", "0 contours", "at least 1", ""});
  ToolPath path;
  path.has_path_column = contours.size() > 1;
  path.has_feed_column = options.feed_mm_s > 0.0;
  path.has_closed_column = true;
  path.source = contours.size() > 1 ? "from contours" : "from contour";
  for (const Contour& contour : contours) {
    add_contour(contour, static_cast<int>(&contour - contours.data()) + 1, options, path);
    path.source += (&contour == contours.data() ? " " : ", ") + std::to_string(contour.id);
  }
  return path;
}

}  // namespace arris
