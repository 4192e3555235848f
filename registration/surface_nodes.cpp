#include "registration/surface_nodes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr double kCosSameSheet = 0.2;    // a node serves cells whose normal turns less than this
constexpr double kCoverRatio = 0.75;     // of the spacing: how far a cell may be from its node
constexpr double kInvertedShare = 0.05;  // of a cube's area: less faces the other way by mistake
constexpr double kCubeRatio = 1.5;       // most that a cube of the priors is wider than asked
constexpr std::size_t kMostCells = 1000000;

double to_contours_mm(const CadModel& cad, const Eigen::Vector3d& p_mm) {
  double nearest_mm = 1e300;
  for (const Curve& curve : cad.contours) nearest_mm = std::min(nearest_mm, curve.nearest(p_mm).distance_mm);
  return nearest_mm;
}

class CellMaker {
 public:
  CellMaker(const CadModel& cad, double band_mm, double cell_mm)
      : cad_(cad), band_mm_(band_mm), cell_mm_(cell_mm) {}

  void add(std::size_t triangle) {
    const auto& t = cad_.mesh.triangles[triangle];
    const Eigen::Vector3d& a = vertex(t[0]);
    const Eigen::Vector3d& b = vertex(t[1]);
    const Eigen::Vector3d& c = vertex(t[2]);
    const double longest_mm = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (band_mm_ >= 0.0 && to_contours_mm(cad_, (a + b + c) / 3.0) > band_mm_ + longest_mm) return;
    const int cuts = std::max(1, static_cast<int>(std::ceil(longest_mm / cell_mm_)));
    const double area_mm2 = 0.5 * (b - a).cross(c - a).norm() / (static_cast<double>(cuts) * cuts);
    if (area_mm2 <= 0.0) return;
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; j < 2 * (cuts - i) - 1; ++j) add_part(triangle, cuts, i, j, area_mm2);
    if (cells.size() > kMostCells)
      throw Error(Fault::kInput, {.what = "the CAD's band is too large for the surface field",
                                  .found = "more than a million cells of " + std::to_string(cell_mm_) + " mm",
                                  .needed = "a narrower band (registration.subdivision.band_mm) or a coarser "
                                            "registration.surface.node_spacing_mm"});
  }

  std::vector<SurfaceCell> cells;

 private:
  const Eigen::Vector3d& vertex(std::int32_t i) const {
    return cad_.mesh.vertices_mm[static_cast<std::size_t>(i)];
  }

  /// Part j of strip i when every edge is cut into `cuts`: upright parts are even, hanging ones odd.
  void add_part(std::size_t triangle, int cuts, int i, int j, double area_mm2) {
    const auto& t = cad_.mesh.triangles[triangle];
    const double third = j % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
    const double b = (j / 2 + third) / cuts, c = (i + third) / cuts, a = 1.0 - b - c;
    SurfaceCell cell;
    cell.centre_mm = a * vertex(t[0]) + b * vertex(t[1]) + c * vertex(t[2]);
    cell.to_contours_mm = to_contours_mm(cad_, cell.centre_mm);
    if (band_mm_ >= 0.0 && cell.to_contours_mm > band_mm_) return;
    SurfacePoint place;
    place.triangle = static_cast<std::int32_t>(triangle);
    place.barycentric = {a, b, c};
    cell.normal = cad_.smooth_normal(place);
    cell.area_mm2 = area_mm2;
    cells.push_back(cell);
  }

  const CadModel& cad_;
  double band_mm_, cell_mm_;
};

void add_contour_nodes(const Curve& curve, double spacing_mm, SurfaceNodes& nodes) {
  const int count = std::max(6, static_cast<int>(std::ceil(curve.length_mm() / spacing_mm)));
  for (int i = 0; i < count; ++i) {
    const double s_mm = curve.length_mm() * i / count;
    nodes.points_mm.push_back(curve.point_mm(s_mm));
    nodes.normals.push_back(curve.normal(s_mm));
    nodes.spacing_mm.push_back(spacing_mm);
  }
}

std::array<int, 3> cube_of(const Eigen::Vector3d& p_mm, double cell_mm) {
  const Eigen::Array3i at = (p_mm / cell_mm).array().floor().cast<int>();
  return {at.x(), at.y(), at.z()};
}

/// Meshers leave slivers that face the wrong way at corners; a small part of a cube's area that is turned
/// from the rest is one. (Two faces of a thin solid share a cube too, but evenly.)
void drop_inverted_slivers(double cell_mm, std::vector<SurfaceCell>& cells) {
  std::map<std::array<int, 3>, Eigen::Vector3d> facing;
  std::map<std::array<int, 3>, double> against_mm2, area_mm2;
  for (const SurfaceCell& cell : cells)
    facing.try_emplace(cube_of(cell.centre_mm, cell_mm), Eigen::Vector3d::Zero()).first->second +=
        cell.area_mm2 * cell.normal;
  const auto turned = [&](const SurfaceCell& cell) {
    return cell.normal.dot(facing[cube_of(cell.centre_mm, cell_mm)]) <= 0.0;
  };
  for (const SurfaceCell& cell : cells) {
    area_mm2[cube_of(cell.centre_mm, cell_mm)] += cell.area_mm2;
    if (turned(cell)) against_mm2[cube_of(cell.centre_mm, cell_mm)] += cell.area_mm2;
  }
  std::erase_if(cells, [&](const SurfaceCell& cell) {
    const std::array<int, 3> cube = cube_of(cell.centre_mm, cell_mm);
    return turned(cell) && against_mm2[cube] < kInvertedShare * area_mm2[cube];
  });
}

}  // namespace

std::vector<SurfaceCell> band_cells(const CadModel& cad, double band_mm, double cell_mm) {
  CellMaker maker(cad, band_mm, cell_mm);
  for (std::size_t t = 0; t < cad.mesh.triangles.size(); ++t) maker.add(t);
  drop_inverted_slivers(2.0 * cell_mm, maker.cells);
  return std::move(maker.cells);
}

std::vector<SurfaceCell> thinned(const std::vector<SurfaceCell>& cells, const NodeSpacing& spacing,
                                 double cell_ratio) {
  // Cubes of a few sizes: each half of the next.
  std::map<std::tuple<double, std::array<int, 3>, std::array<int, 3>>, std::vector<std::size_t>> cubes;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double cell_mm = cell_ratio * spacing.far_mm;
    while (cell_mm > kCubeRatio * cell_ratio * spacing.at(cells[i].to_contours_mm)) cell_mm *= 0.5;
    const Eigen::Array3i side = (cells[i].normal * 1.5).array().round().cast<int>();
    cubes[{cell_mm, cube_of(cells[i].centre_mm, cell_mm), {side.x(), side.y(), side.z()}}].push_back(i);
  }
  std::vector<SurfaceCell> fewer;
  for (const auto& [cube, members] : cubes) {
    Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();
    double area_mm2 = 0.0;
    for (const std::size_t i : members) {
      middle_mm += cells[i].area_mm2 * cells[i].centre_mm;
      area_mm2 += cells[i].area_mm2;
    }
    middle_mm /= area_mm2;
    const std::size_t best =
        *std::min_element(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
          return (cells[a].centre_mm - middle_mm).squaredNorm() <
                 (cells[b].centre_mm - middle_mm).squaredNorm();
        });
    fewer.push_back(cells[best]);
    fewer.back().area_mm2 = area_mm2;
  }
  return fewer;
}

SurfaceNodes place_nodes(const std::vector<const Curve*>& contours, const std::vector<SurfaceCell>& cells,
                         const NodeSpacing& spacing) {
  SurfaceNodes nodes;
  for (const Curve* curve : contours) add_contour_nodes(*curve, spacing.beside_mm, nodes);
  std::vector<double> spacing_mm, apart(cells.size(), 1e300);  // in spacings, from the nearest node
  for (const SurfaceCell& cell : cells) spacing_mm.push_back(spacing.at(cell.to_contours_mm));
  const auto serve = [&](const Eigen::Vector3d& p_mm, const Eigen::Vector3d& normal) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i].normal.dot(normal) > kCosSameSheet)
        apart[i] = std::min(apart[i], (cells[i].centre_mm - p_mm).norm() / spacing_mm[i]);
  };
  for (std::size_t i = 0; i < nodes.points_mm.size(); ++i) serve(nodes.points_mm[i], nodes.normals[i]);
  while (!cells.empty()) {
    const auto farthest = std::max_element(apart.begin(), apart.end());
    if (*farthest <= kCoverRatio) break;
    const auto i = static_cast<std::size_t>(farthest - apart.begin());
    nodes.points_mm.push_back(cells[i].centre_mm);
    nodes.normals.push_back(cells[i].normal);
    nodes.spacing_mm.push_back(spacing_mm[i]);
    serve(cells[i].centre_mm, cells[i].normal);
  }
  return nodes;
}

}  // namespace arris
