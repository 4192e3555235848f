#include <algorithm>
#include <cmath>

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

bool crosses(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::vector<Box>& taken) {
  for (int i = 1; i <= 24; ++i) {
    const Eigen::Vector2d p = from + (to - from) * (i / 24.0);
    if (std::any_of(taken.begin(), taken.end(), [&](const Box& box) { return box.holds(p); })) return true;
  }
  return false;
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
  constexpr int kAngles = 32, kRings = 30;
  constexpr double kMarker = 9.0;  // around each anchor: the dot stays visible
  for (const Eigen::Vector2d& p : anchors)
    obstacles.push_back({p.x() - kMarker, p.y() - kMarker, 2.0 * kMarker, 2.0 * kMarker});
  std::vector<Box> placed(anchors.size()), labels;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const double width = sizes[i].x(), height = sizes[i].y();
    for (int step = 0; step < kAngles * kRings && placed[i].width == 0.0; ++step) {
      const double reach = 22.0 + 10.0 * (step / kAngles);
      const double angle = 3.14159265358979323846 * (2.0 * (step % kAngles) / kAngles - 0.25);
      const double cos = std::cos(angle), sin = std::sin(angle);
      const Box box{anchors[i].x() + cos * (reach + 0.5 * width) - 0.5 * width,
                    anchors[i].y() + sin * (reach + 0.5 * height) - 0.5 * height, width, height};
      if (!inside(box, bounds) || !is_free(box, obstacles)) continue;
      const Eigen::Vector2d middle(box.x + 0.5 * width, box.y + 0.5 * height);
      if (step < kAngles * (kRings - 8) && crosses(anchors[i], middle, labels))
        continue;  // rather a crossing than no label
      placed[i] = box;
      obstacles.push_back({box.x - 4.0, box.y - 4.0, width + 8.0, height + 8.0});
      labels.push_back(box);
    }
  }
  return placed;
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
