#include "registration/surface_ground.hpp"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

constexpr double kFineCellRatio = 0.4, kCellRatio = 0.6;  // of the spacing: to place nodes; of the priors
constexpr double kFarStep = 1.5;                          // wider, as long as nodes are too many
constexpr double kStationStepMm = 5.0;

double area_mm2_of(const std::vector<SurfaceCell>& cells) {
  double area_mm2 = 0.0;
  for (const SurfaceCell& cell : cells) area_mm2 += cell.area_mm2;
  return area_mm2;
}

SurfaceNodes nodes_on(const CadModel& cad, double band_mm, const std::vector<SurfaceCell>& cells,
                      const NodeSpacing& spacing) {
  std::vector<const Curve*> curves;
  for (const Curve& curve : cad.contours) curves.push_back(&curve);
  if (band_mm < 0.0)
    for (const Curve& curve : cad.others) curves.push_back(&curve);
  return place_nodes(curves, cells, spacing);
}

SurfaceGround ground_of(const CadModel& cad, const std::vector<SurfaceCell>& cells, const SurfaceNodes& nodes,
                        const NodeSpacing& spacing) {
  SurfaceGround ground;
  ground.area_mm2 = area_mm2_of(cells);
  ground.basis = std::make_shared<SurfaceBasis>(nodes);
  for (const SurfaceCell& cell : thinned(cells, spacing, kCellRatio)) {
    SheetCell sheet(cell, *ground.basis);
    if (sheet.usable()) ground.sheet.push_back(std::move(sheet));
  }
  for (const Curve& curve : cad.contours)
    ground.contours.push_back(contour_stations(curve, *ground.basis, kStationStepMm));
  return ground;
}

}  // namespace

SurfaceGround even_ground(const CadModel& cad, double band_mm, double spacing_mm) {
  const std::vector<SurfaceCell> cells = band_cells(cad, band_mm, kFineCellRatio * spacing_mm);
  const double least_mm = std::sqrt(area_mm2_of(cells) / static_cast<double>(SurfaceGround::kMostNodes));
  const NodeSpacing spacing(std::max(spacing_mm, least_mm));
  return ground_of(cad, cells, nodes_on(cad, band_mm, cells, spacing), spacing);
}

SurfaceGround graded_ground(const CadModel& cad, double band_mm, double beside_mm, double far_mm) {
  const std::vector<SurfaceCell> cells = band_cells(cad, band_mm, kFineCellRatio * beside_mm);
  NodeSpacing spacing(beside_mm);
  SurfaceNodes nodes = nodes_on(cad, band_mm, cells, spacing);
  while (nodes.points_mm.size() > SurfaceGround::kMostNodes && spacing.far_mm < far_mm) {
    spacing.far_mm = std::min(far_mm, kFarStep * spacing.far_mm);
    nodes = nodes_on(cad, band_mm, cells, spacing);
  }
  return ground_of(cad, cells, nodes, spacing);
}

}  // namespace arris
