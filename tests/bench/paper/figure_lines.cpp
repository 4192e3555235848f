#include "tests/bench/paper/figure_lines.hpp"

#include <algorithm>

namespace arris::bench {
namespace {

double value_of(const RowError& row, Along part) {
  if (part == Along::kDistance) return row.distance_mm;
  return part == Along::kNormal ? row.normal_mm : row.across_mm;
}

}  // namespace

std::vector<NamedPath> figure_paths(ScanTrial& trial) {
  std::vector<Method> methods = {rigid_icp()};
  for (Method& method : projections()) methods.push_back(std::move(method));
  if (methods.size() > 2) methods.resize(3);
  methods.push_back(paper_subdivision());
  methods.push_back(subdivision());
  for (Method& method : joint_fits()) methods.push_back(std::move(method));
  std::vector<NamedPath> paths;
  for (std::size_t m = 0; m < methods.size(); ++m)
    if (std::optional<CarriedPath> path = methods[m].carry(trial))
      paths.push_back({methods[m].name, line_colour(m), std::move(*path)});
  return paths;
}

PlotLine error_line(const Truth& truth, const NamedPath& path, Along part, bool deformed) {
  PlotLine line{path.name, path.colour, {}, false};
  for (const RowError& row : truth.rows(path.path.tips_mm, deformed))
    line.points_mm.emplace_back(row.arc_mm, value_of(row, part));
  std::stable_sort(line.points_mm.begin(), line.points_mm.end(),
                   [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() < b.x(); });
  return line;
}

PartLine exaggerated_line(const Truth& truth, const NamedPath& path, double factor, bool deformed) {
  PartLine line{{path.name, {path.colour, 3.0, {}, 1.0}, std::nullopt, false}, {}, true};
  const std::vector<RowError> rows = truth.rows(path.path.tips_mm, deformed);
  for (std::size_t i = 0; i < rows.size(); ++i)
    line.points_mm.emplace_back(rows[i].foot_mm + factor * (path.path.tips_mm[i] - rows[i].foot_mm));
  return line;
}

}  // namespace arris::bench
