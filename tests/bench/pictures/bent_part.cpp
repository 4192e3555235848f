#include "tests/bench/pictures/bent_part.hpp"

#include "acquisition/geometry/rigid_fit.hpp"

namespace arris::bench {
namespace {

constexpr report::Rgb kEdge{34, 34, 34};

/// Displacement along the normal beyond the best rigid motion of the edge, one value a triangle.
std::vector<float> bending_mm(const Truth& truth, const TriangleMesh& nominal, const TriangleMesh& bent) {
  std::vector<Eigen::Vector3d> from, to;
  for (const synthetic::EdgePoint& e : truth.edge()) {
    from.push_back(e.nominal_mm);
    to.push_back(e.true_mm);
  }
  const RigidMotion motion = fit_rigid(from, to).to_from;
  std::vector<float> values;
  for (const auto& t : nominal.triangles) {
    std::array<Eigen::Vector3d, 3> carried;
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(t[k]);
      carried[k] = motion * nominal.vertices_mm[v];
      shift += (bent.vertices_mm[v] - carried[k]) / 3.0;
    }
    const Eigen::Vector3d normal = (carried[1] - carried[0]).cross(carried[2] - carried[0]).normalized();
    values.push_back(static_cast<float>(shift.dot(normal)));
  }
  return values;
}

}  // namespace

void add_edge(PartPicture& picture, const Truth& truth, bool deformed, const std::string& name,
              bool is_dashed) {
  for (const synthetic::EdgeRange& range : synthetic::contour_ranges(truth.edge())) {
    PartLine line{{range.begin == 0 ? name : "", {kEdge, 3.0, {}, 1.0}, std::nullopt, false}, {}, true};
    if (is_dashed) line.item.stroke.dash_px = {12.0, 7.0};
    for (std::size_t i = range.begin; i < range.end; ++i)
      line.points_mm.push_back(deformed ? truth.edge()[i].true_mm : truth.edge()[i].nominal_mm);
    picture.lines.push_back(std::move(line));
  }
}

Eigen::Vector3d mean_edge_normal(const Truth& truth) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const synthetic::EdgePoint& e : truth.edge()) sum += e.nominal_normal;
  return sum.normalized();
}

PartPicture bent_part_picture(const BenchPart& part, const std::string& title, double mesh_mm) {
  PartPicture picture;
  picture.title = title;
  picture.subtitle = "colour: displacement along the normal beyond the best rigid motion of the edge";
  picture.normal = mean_edge_normal(part.truth);
  picture.mesh = part.fe.mesh(mesh_mm, true);
  picture.value_mm = bending_mm(part.truth, part.fe.mesh(mesh_mm, false), picture.mesh);
  picture.shows_whole_mesh = true;
  add_edge(picture, part.truth, false, "contour of the drawing, true pose", true);
  add_edge(picture, part.truth, true, "edge of the clamped part");
  return picture;
}

}  // namespace arris::bench
