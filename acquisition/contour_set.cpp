#include "acquisition/contour_set.hpp"

#include <algorithm>
#include <cstdio>

#include "acquisition/geometry/polyline.hpp"

namespace arris {
namespace {

void measure(FoundContour& found, double bend_chords) {
  const Contour& contour = found.contour;
  found.length_mm = length_mm(contour);
  if (!contour.closed && !contour.points_mm.empty())
    found.closing_gap_mm = (contour.points_mm.front() - contour.points_mm.back()).norm();
  if (contour.points_mm.size() < 4) return;
  const double chord_mm = found.length_mm / static_cast<double>(contour.points_mm.size());
  if (!(chord_mm > 0.0)) return;
  const double window_mm = std::max(bend_chords * chord_mm, found.length_mm / 200.0);
  const std::vector<double> radius_mm = bend_radius_mm(contour, window_mm);
  found.min_bend_radius_mm = *std::min_element(radius_mm.begin(), radius_mm.end());
}

}  // namespace

ContourSet measured(std::vector<FoundContour> loops, double min_length_mm, double bend_chords) {
  ContourSet set;
  for (FoundContour& loop : loops) {
    measure(loop, bend_chords);
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
