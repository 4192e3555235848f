#include "report/scene.hpp"

#include <algorithm>
#include <cmath>

namespace arris::report {
namespace {

std::array<Eigen::Vector3d, 3> corners_of(const TriangleMesh& mesh,
                                          const std::array<std::int32_t, 3>& triangle, const View& view) {
  std::array<Eigen::Vector3d, 3> corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = view.project(mesh.vertices_mm[static_cast<std::size_t>(triangle[i])]);
  return corners;
}

std::uint8_t dimmed(std::uint8_t part, double factor) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(part * factor), 0L, 255L));
}

}  // namespace

std::vector<Eigen::Vector3d> points_in_cad_mm(const RunRecord& record) {
  const RigidMotion cad_from_scan = record.alignment.scan_from_cad.inverse();
  std::vector<Eigen::Vector3d> points(record.cloud.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = cad_from_scan * record.cloud.file_mm(i);
  return points;
}

Eigen::Vector3d local_to_cad_mm(const RunRecord& record, const Eigen::Vector3d& p_local_mm) {
  return record.alignment.scan_from_cad.inverse() * Eigen::Vector3d(p_local_mm + record.cloud.offset_mm);
}

double drawn_spacing_mm(double stated_mm, std::size_t count, const Extent& extent) {
  if (stated_mm > 0.0) return stated_mm;
  const Eigen::Vector2d size = extent.size();
  return std::sqrt(std::max(1e-12, size.x() * size.y()) / std::max<double>(1.0, static_cast<double>(count)));
}

Raster render_points(std::span<const Eigen::Vector3d> points_mm, std::span<const Rgb> colours,
                     const View& view, double spacing_mm, int width_px, int height_px) {
  Raster raster(width_px, height_px, kPaper);
  const double spacing_px = std::clamp(spacing_mm * view.scale_px_mm, 0.8, 30.0);
  const double radius_px = 2.0 * spacing_px, rim_px = 1.2 * spacing_px;
  const double slope_mm_px = 2.5 / view.scale_px_mm;  // steeper than a surface seen under 68 degrees
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    const Rgb& colour = colours.size() == 1 ? colours[0] : colours[i];
    if (colour == ColourMap::no_data()) continue;
    raster.splat(view.project(points_mm[i]), radius_px, slope_mm_px, colour);
  }
  raster.erode(rim_px, kPaper);
  const bool is_plain = std::find(colours.begin(), colours.end(), kPlainPoint) != colours.end();
  const double blur_px = std::clamp(1.5 * radius_px, 4.0, 60.0);
  raster.shade(static_cast<int>(std::lround(blur_px)), 1.0 / view.scale_px_mm, is_plain ? 1.6 : 1.0);
  const double dot_px = std::clamp(0.4 * spacing_px, 1.0, 4.0);
  for (std::size_t i = 0; i < points_mm.size(); ++i)
    if (colours.size() != 1 && colours[i] == ColourMap::no_data())
      raster.splat(view.project(points_mm[i]), dot_px, slope_mm_px, {150, 150, 150});
  return raster;
}

void render_mesh(Raster& raster, const TriangleMesh& mesh, const View& view, const Rgb& colour) {
  const Eigen::Vector3d light = Eigen::Vector3d(-0.4, 0.5, 0.77).normalized();
  for (const auto& triangle : mesh.triangles) {
    const auto vertex = [&](std::size_t i) {
      return mesh.vertices_mm[static_cast<std::size_t>(triangle[i])];
    };
    const Eigen::Vector3d across = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
    if (across.norm() < 1e-12) continue;
    const Eigen::Vector3d normal = view.orientation * across.normalized();
    const double facing = normal.z() < 0.0 ? 0.82 : 1.0;
    const double factor = facing * (0.80 + 0.20 * std::abs(normal.dot(light)));
    raster.triangle(corners_of(mesh, triangle, view),
                    {dimmed(colour.red, factor), dimmed(colour.green, factor), dimmed(colour.blue, factor)});
  }
}

void hatch_unseen(Raster& raster, const TriangleMesh& cad, const View& view) {
  for (const auto& triangle : cad.triangles) {
    const auto corners = corners_of(cad, triangle, view);
    // Faces that look away (the inside of an opening) are no missing data; y points downwards on the page.
    const Eigen::Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    if (ab.x() * ac.y() - ab.y() * ac.x() < 0.0) raster.no_data_triangle(corners);
  }
}

}  // namespace arris::report
