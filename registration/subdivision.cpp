#include "registration/subdivision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr double kCornerWindowMm = 8.0;      // arc over which a bend radius is fitted
constexpr double kShortestPieceRatio = 0.1;  // of epsilon: shorter pieces join their neighbour

/// Arc positions where a run of corner points begins or ends.
std::vector<double> corner_cuts(const Curve& curve, double corner_radius_max_mm) {
  if (corner_radius_max_mm == 0.0) return {};
  const double window_mm = std::min(kCornerWindowMm, curve.length_mm() / 12.0);
  const std::vector<double> radius_mm = bend_radius_mm(curve.contour(), window_mm);
  std::vector<double> cuts;
  const std::size_t n = radius_mm.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (i == 0 && !curve.closed()) continue;
    const std::size_t before = (i + n - 1) % n;
    const bool corner_here = radius_mm[i] < corner_radius_max_mm;
    const bool corner_before = radius_mm[before] < corner_radius_max_mm;
    if (corner_here != corner_before) cuts.push_back(curve.arc_of_point_mm(static_cast<int>(i)));
  }
  return cuts;
}

/// Leaves out cuts that would make a piece shorter than the shortest.
std::vector<double> without_slivers(const std::vector<double>& cuts, double shortest_mm, double length_mm,
                                    bool closed) {
  std::vector<double> kept;
  for (const double cut : cuts)
    if (kept.empty() || cut - kept.back() >= shortest_mm) kept.push_back(cut);
  if (closed && kept.size() > 1 && kept.front() + length_mm - kept.back() < shortest_mm) kept.pop_back();
  return kept;
}

}  // namespace

void SubdivisionOptions::check() const {
  const auto need = [](bool holds, const char* what, double found, const char* needed) {
    if (!holds)
      throw Error(Fault::kRecipe,
                  {.what = std::string("registration.subdivision.") + what + " is out of range",
                   .found = std::to_string(found),
                   .needed = needed});
  };
  need(corner_radius_max_mm >= 0.0, "corner_radius_max_mm", corner_radius_max_mm, "0 or more");
  need(segment_length_max_mm > 1.0, "segment_length_max_mm", segment_length_max_mm, "more than 1");
  need(overlap_ratio >= 0.0 && overlap_ratio <= 0.5, "overlap", overlap_ratio, "0 to 0.5");
}

Subdivision::Subdivision(const Curve& curve, const SubdivisionOptions& options)
    : length_mm_(curve.length_mm()), closed_(curve.closed()) {
  options.check();
  const double epsilon = options.segment_length_max_mm;
  std::vector<double> cuts = without_slivers(corner_cuts(curve, options.corner_radius_max_mm),
                                             kShortestPieceRatio * epsilon, length_mm_, closed_);
  if (!closed_) {
    cuts.erase(std::remove_if(cuts.begin(), cuts.end(),
                              [&](double c) {
                                return c < kShortestPieceRatio * epsilon ||
                                       c > length_mm_ - kShortestPieceRatio * epsilon;
                              }),
               cuts.end());
    cuts.insert(cuts.begin(), 0.0);
    cuts.push_back(length_mm_);
  } else {
    if (cuts.empty()) cuts.push_back(0.0);
    cuts.push_back(cuts.front() + length_mm_);
  }
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double piece_mm = cuts[i + 1] - cuts[i];
    int parts = std::max(1, static_cast<int>(std::ceil(piece_mm / epsilon - 1e-9)));
    if (closed_ && cuts.size() == 2)
      parts = std::max(parts, 3);  // a loop of fewer pieces would overlap itself
    for (int p = 0; p < parts; ++p)
      segments_.push_back({cuts[i] + piece_mm * p / parts, cuts[i] + piece_mm * (p + 1) / parts, 0.0, 0.0});
  }
  // beta of the shorter neighbour, so that at most two segments overlap anywhere
  const std::size_t n = segments_.size();
  for (std::size_t i = 0; i < n; ++i) {
    Segment& own = segments_[i];
    const Segment& before = segments_[(i + n - 1) % n];
    const Segment& after = segments_[(i + 1) % n];
    const auto half = [&](const Segment& other) {
      return 0.5 * options.overlap_ratio * std::min(own.end_mm - own.begin_mm, other.end_mm - other.begin_mm);
    };
    own.reach_begin_mm = own.begin_mm - (closed_ || i > 0 ? half(before) : 0.0);
    own.reach_end_mm = own.end_mm + (closed_ || i + 1 < n ? half(after) : 0.0);
  }
}

double Subdivision::relative(const Segment& segment, double arc_mm) const {
  if (!closed_) return arc_mm;
  const double middle = 0.5 * (segment.reach_begin_mm + segment.reach_end_mm);
  double apart = arc_mm - middle;
  while (apart > 0.5 * length_mm_) apart -= length_mm_;
  while (apart < -0.5 * length_mm_) apart += length_mm_;
  return middle + apart;
}

std::vector<int> Subdivision::reaching(double arc_mm) const {
  std::vector<int> found;
  for (std::size_t z = 0; z < segments_.size(); ++z) {
    const double s = relative(segments_[z], arc_mm);
    if (s >= segments_[z].reach_begin_mm && s <= segments_[z].reach_end_mm)
      found.push_back(static_cast<int>(z));
  }
  return found;
}

std::vector<BlendWeight> Subdivision::weights(double arc_mm) const {
  std::vector<BlendWeight> blend;
  double sum = 0.0;
  for (const int z : reaching(arc_mm)) {
    const Segment& segment = segments_[static_cast<std::size_t>(z)];
    const double s = relative(segment, arc_mm);
    // Overlap with a neighbour spans the same length on both sides of the cut: 0 at the reach, 1 where it
    // ends.
    const double rise_mm = 2.0 * (segment.begin_mm - segment.reach_begin_mm);
    const double fall_mm = 2.0 * (segment.reach_end_mm - segment.end_mm);
    const auto ramp = [](double from_edge_mm, double width_mm) {
      if (width_mm <= 0.0 || from_edge_mm >= width_mm) return 1.0;
      const double sine = std::sin(0.5 * std::numbers::pi * std::max(0.0, from_edge_mm) / width_mm);
      return sine * sine;
    };
    const double weight = ramp(s - segment.reach_begin_mm, rise_mm) * ramp(segment.reach_end_mm - s, fall_mm);
    if (weight <= 0.0 && !blend.empty()) continue;
    blend.push_back({z, weight});
    sum += weight;
  }
  if (sum <= 0.0) return {{blend.empty() ? 0 : blend.front().segment, 1.0}};
  for (BlendWeight& entry : blend) entry.weight /= sum;
  return blend;
}

double printed_eq8(double distance_own_mm, double distance_next_mm) {
  return std::sin(0.5 * std::numbers::pi * distance_next_mm / distance_own_mm);
}

}  // namespace arris
