#include <algorithm>
#include <cmath>
#include <numeric>

#include "report/canvas.hpp"

namespace arris::report {
namespace {

bool inside(const Box& box, const Box& bounds) {
  return box.x >= bounds.x && box.y >= bounds.y && box.x + box.width <= bounds.x + bounds.width &&
         box.y + box.height <= bounds.y + bounds.height;
}

bool is_free(const Box& box, const std::vector<Box>& taken) {
  return std::none_of(taken.begin(), taken.end(), [&](const Box& other) { return box.overlaps(other); });
}

struct Leader {
  Eigen::Vector2d from, to;
};

bool touches(const Leader& leader, const Box& box) {
  for (int i = 1; i <= 24; ++i)
    if (box.holds(leader.from + (leader.to - leader.from) * (i / 24.0))) return true;
  return false;
}

int touched(const Leader& leader, const std::vector<Box>& boxes,
            std::size_t but = static_cast<std::size_t>(-1)) {
  int count = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) count += i != but && touches(leader, boxes[i]) ? 1 : 0;
  return count;
}

// Ring by ring around an anchor, from the upper right on.
struct Place {
  Box box;
  double reach;
};
Place place_at(const Eigen::Vector2d& anchor, const Eigen::Vector2d& size, int step) {
  constexpr int kAngles = 32;
  const double reach = 22.0 + 10.0 * (step / kAngles);
  const double angle = 3.14159265358979323846 * (2.0 * (step % kAngles) / kAngles - 0.25);
  const double x = anchor.x() + std::cos(angle) * (reach + 0.5 * size.x());
  const double y = anchor.y() + std::sin(angle) * (reach + 0.5 * size.y());
  return {{x - 0.5 * size.x(), y - 0.5 * size.y(), size.x(), size.y()}, reach};
}

struct Layout {
  std::vector<Box> boxes;
  double cost = 0.0;
};

// One label after the other in the given order, each where it costs least.
Layout place_in_order(std::span<const Eigen::Vector2d> anchors, std::span<const Eigen::Vector2d> sizes,
                      const Box& bounds, std::vector<Box> obstacles, const std::vector<Box>& markers,
                      const std::vector<std::size_t>& order) {
  constexpr int kSteps = 32 * 30;
  constexpr double kOverLabel = 200.0,
                   kOverMarker = 60.0;  // how much farther a label goes rather than cross one
  constexpr double kNoPlace = 2000.0;
  Layout layout{std::vector<Box>(anchors.size()), 0.0};
  std::vector<Box> labels;
  std::vector<Leader> leaders;
  for (const std::size_t i : order) {
    double best = kNoPlace;
    Leader chosen{anchors[i], anchors[i]};
    for (int step = 0; step < kSteps; ++step) {
      const auto [box, reach] = place_at(anchors[i], sizes[i], step);
      if (reach >= best) break;
      if (!inside(box, bounds) || !is_free(box, obstacles)) continue;
      const Leader leader{anchors[i], {box.x + 0.5 * box.width, box.y + 0.5 * box.height}};
      const auto covered = std::count_if(leaders.begin(), leaders.end(),
                                         [&, b = box](const Leader& l) { return touches(l, b); });
      const double cost = reach + kOverMarker * touched(leader, markers, i) +
                          kOverLabel * (touched(leader, labels) + static_cast<double>(covered));
      if (cost >= best) continue;
      best = cost;
      layout.boxes[i] = box;
      chosen = leader;
    }
    layout.cost += best;
    if (layout.boxes[i].width == 0.0) continue;
    const Box& box = layout.boxes[i];
    obstacles.push_back({box.x - 4.0, box.y - 4.0, box.width + 8.0, box.height + 8.0});
    labels.push_back(box);
    leaders.push_back(chosen);
  }
  return layout;
}

}  // namespace

bool Box::overlaps(const Box& other) const {
  return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
         other.y < y + height;
}

bool Box::holds(const Eigen::Vector2d& p) const {
  return p.x() >= x && p.y() >= y && p.x() <= x + width && p.y() <= y + height;
}

std::vector<Box> place_labels(std::span<const Eigen::Vector2d> anchors,
                              std::span<const Eigen::Vector2d> sizes, const Box& bounds,
                              std::vector<Box> obstacles) {
  constexpr double kMarker = 9.0;  // around each anchor: the dot stays visible
  std::vector<Box> markers;
  for (const Eigen::Vector2d& p : anchors)
    markers.push_back({p.x() - kMarker, p.y() - kMarker, 2.0 * kMarker, 2.0 * kMarker});
  obstacles.insert(obstacles.end(), markers.begin(), markers.end());
  std::vector<std::size_t> order(anchors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Layout best = place_in_order(anchors, sizes, bounds, obstacles, markers, order);
  // Who comes first matters: some orders by direction beside the given one.
  for (const double angle : {0.0, 0.8, 1.6, 2.4, 3.2, 4.0, 4.8, 5.6}) {
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return anchors[a].dot(along) < anchors[b].dot(along);
    });
    Layout other = place_in_order(anchors, sizes, bounds, obstacles, markers, order);
    if (other.cost < best.cost - 1e-9) best = std::move(other);
  }
  return best.boxes;
}

std::vector<double> spread(std::vector<double> positions, double gap, double low, double high) {
  const auto count = static_cast<double>(positions.size());
  if (positions.empty()) return positions;
  if (gap * (count - 1.0) > high - low) gap = (high - low) / std::max(1.0, count - 1.0);
  for (int round = 0; round < 200; ++round) {
    bool moved = false;
    for (std::size_t i = 1; i < positions.size(); ++i) {
      const double lack = gap - (positions[i] - positions[i - 1]);
      if (lack <= 1e-6) continue;
      positions[i - 1] -= 0.5 * lack;
      positions[i] += 0.5 * lack;
      moved = true;
    }
    if (!moved) break;
  }
  // The ends win: push inwards from each side.
  positions.front() = std::max(positions.front(), low);
  for (std::size_t i = 1; i < positions.size(); ++i)
    positions[i] = std::max(positions[i], positions[i - 1] + gap);
  positions.back() = std::min(positions.back(), high);
  for (std::size_t i = positions.size() - 1; i > 0; --i)
    positions[i - 1] = std::min(positions[i - 1], positions[i] - gap);
  return positions;
}

}  // namespace arris::report
