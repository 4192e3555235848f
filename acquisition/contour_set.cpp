#include "acquisition/contour_set.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "acquisition/geometry/polyline.hpp"

namespace arris {
namespace {

constexpr double kCorner_rad = 1.1;     // 63 degrees: a circle of six chords has no corner, a square has
constexpr double kStraight_rad = 1e-4;  // a vertex that turns less lies on a straight run

/// Angle between the chords at each point; 0 at the ends of an open contour and beside a repeated point.
std::vector<double> turns_rad(const Contour& contour) {
  const auto& points_mm = contour.points_mm;
  const std::size_t count = points_mm.size();
  std::vector<double> turns(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    if (!contour.closed && (i == 0 || i + 1 == count)) continue;
    const Eigen::Vector3d before_mm = points_mm[i] - points_mm[(i + count - 1) % count];
    const Eigen::Vector3d after_mm = points_mm[(i + 1) % count] - points_mm[i];
    turns[i] = std::atan2(before_mm.cross(after_mm).norm(), before_mm.dot(after_mm));
  }
  return turns;
}

double median_chord_mm(const Contour& contour) {
  std::vector<double> chords_mm;
  for (std::size_t i = 1; i < contour.points_mm.size(); ++i)
    chords_mm.push_back((contour.points_mm[i] - contour.points_mm[i - 1]).norm());
  const auto middle = chords_mm.begin() + static_cast<std::ptrdiff_t>(chords_mm.size() / 2);
  std::nth_element(chords_mm.begin(), middle, chords_mm.end());
  return *middle;
}

double smallest_bend_mm(const Contour& contour, double length_mm, const BendWindow& bend) {
  const double mean_mm = length_mm / static_cast<double>(contour.points_mm.size());
  if (!bend.exact_corners) {
    const auto radii_mm = bend_radius_mm(contour, std::max(bend.chords * mean_mm, length_mm / 200.0));
    return *std::min_element(radii_mm.begin(), radii_mm.end());
  }
  const std::vector<double> turns = turns_rad(contour);
  if (*std::max_element(turns.begin(), turns.end()) > kCorner_rad) return 0.0;
  const double chord_mm = median_chord_mm(contour);
  const auto radii_mm = bend_radius_mm(contour, bend.chords * (chord_mm > 0.0 ? chord_mm : mean_mm));
  double smallest_mm = 1e9;
  for (std::size_t i = 0; i < turns.size(); ++i)
    if (turns[i] > kStraight_rad) smallest_mm = std::min(smallest_mm, radii_mm[i]);
  return smallest_mm;
}

void measure(FoundContour& found, const BendWindow& bend) {
  const Contour& contour = found.contour;
  found.length_mm = length_mm(contour);
  if (!contour.closed && !contour.points_mm.empty())
    found.closing_gap_mm = (contour.points_mm.front() - contour.points_mm.back()).norm();
  if (contour.points_mm.size() > 2 && found.length_mm > 0.0)
    found.min_bend_radius_mm = smallest_bend_mm(contour, found.length_mm, bend);
}

}  // namespace

ContourSet measured(std::vector<FoundContour> loops, double min_length_mm, const BendWindow& bend) {
  ContourSet set;
  for (FoundContour& loop : loops) {
    measure(loop, bend);
    if (loop.contour.points_mm.size() >= 3 && loop.length_mm >= min_length_mm) {
      set.found.push_back(std::move(loop));
      continue;
    }
    char text[80];
    std::snprintf(text, sizeof text, "dropped: %.1f mm long, at least %.1f mm needed", loop.length_mm,
                  min_length_mm);
    loop.note = text;
    set.dropped.push_back(std::move(loop));
  }
  std::stable_sort(set.found.begin(), set.found.end(),
                   [](const FoundContour& a, const FoundContour& b) { return a.length_mm > b.length_mm; });
  int id = 0;
  for (FoundContour& found : set.found) found.contour.id = ++id;
  return set;
}

}  // namespace arris
