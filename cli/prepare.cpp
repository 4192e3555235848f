#include "cli/prepare.hpp"

#include <Eigen/Geometry>

#include "acquisition/geometry/mesh_normals.hpp"
#include "acquisition/geometry/orient.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr int kPlaneNeighbours = 12;
constexpr std::size_t kFewestPoints = 30;

/// Sum of the normals of the triangles around each point, area-weighted.
std::vector<Eigen::Vector3d> triangle_normals(const Scan& scan) {
  std::vector<Eigen::Vector3d> normals(scan.cloud.size(), Eigen::Vector3d::Zero());
  for (const auto& t : scan.triangles) {
    const Eigen::Vector3d a = scan.cloud.local_mm(static_cast<std::size_t>(t[0]));
    const Eigen::Vector3d b = scan.cloud.local_mm(static_cast<std::size_t>(t[1]));
    const Eigen::Vector3d c = scan.cloud.local_mm(static_cast<std::size_t>(t[2]));
    for (const std::int32_t corner : t) normals[static_cast<std::size_t>(corner)] += (b - a).cross(c - a);
  }
  return normals;
}

/// Gives each fitted normal the sign of a measured one.
void take_side(const std::vector<Eigen::Vector3d>& measured, std::vector<Eigen::Vector3d>& fitted) {
  for (std::size_t i = 0; i < fitted.size(); ++i)
    if (fitted[i].dot(measured[i]) < 0.0) fitted[i] = -fitted[i];
}

std::string decide_side(const Scan& scan, const PrepareOptions& options, const ScanModel& model,
                        std::vector<Eigen::Vector3d>& normals) {
  if (scan.cloud.has_normals()) {
    std::vector<Eigen::Vector3d> measured(scan.cloud.size());
    for (std::size_t i = 0; i < measured.size(); ++i) measured[i] = scan.cloud.normals[i].cast<double>();
    take_side(measured, normals);
    return "normals in the file";
  }
  if (scan.is_mesh()) {
    take_side(triangle_normals(scan), normals);
    return "triangles in the file";
  }
  if (options.seen_from_mm) {
    orient_towards(model.points_mm, *options.seen_from_mm - scan.cloud.offset_mm, normals);
    return "seen_from";
  }
  orient_consistently(model.points_mm, model.tree, kPlaneNeighbours, normals);
  return "";
}

}  // namespace

PreparedScan prepare_scan(const Scan& scan, const PrepareOptions& options) {
  if (scan.cloud.size() < kFewestPoints)
    throw Error(Fault::kInput, {.what = "the scan has too few points",
                                .found = std::to_string(scan.cloud.size()),
                                .needed = "at least " + std::to_string(kFewestPoints),
                                .next = "scan the part again"});
  std::vector<Eigen::Vector3d> points_mm = local_points_mm(scan.cloud);
  NearestPoints tree(points_mm);
  PreparedScan prepared{
      {std::move(points_mm), {}, std::move(tree), {}, {}, {}, 0.0, 0.0, SideKnown::kNo}, {}, ""};
  ScanModel& model = prepared.model;
  LocalPlanes planes = fit_local_planes(model.points_mm, model.tree, kPlaneNeighbours, options.threads);
  prepared.side_decided_by = decide_side(scan, options, model, planes.normals);
  model.side = prepared.side_decided_by.empty() ? SideKnown::kNo : SideKnown::kYes;
  model.spacing_mm = planes.spacing_median_mm;
  model.noise_sigma_mm = planes.noise_sigma_mm;
  prepared.contours = scan.is_mesh() ? scan_mesh_contours(scan, options.contour)
                                     : cloud_contours(model.points_mm, model.tree, planes, options.contour);
  for (const FoundContour& found : prepared.contours.found) {
    model.loops.push_back(found.contour);
    const Contour& loop = found.contour;
    model.edge_mm.insert(model.edge_mm.end(), loop.points_mm.begin(), loop.points_mm.end());
    model.edge_normals.insert(model.edge_normals.end(), loop.normals.begin(), loop.normals.end());
  }
  model.normals = std::move(planes.normals);
  return prepared;
}

CadModel prepare_cad(const TriangleMesh& mesh, const std::vector<Contour>& accepted,
                     const std::vector<Contour>& others, int threads) {
  CadModel cad{SurfaceQuery(mesh, threads), {}};
  cad.mesh = mesh;
  cad.vertex_normals = mesh_normals(mesh, threads).vertex;
  for (const Contour& contour : accepted) cad.contours.emplace_back(contour);
  for (const Contour& contour : others) cad.others.emplace_back(contour);
  return cad;
}

}  // namespace arris
