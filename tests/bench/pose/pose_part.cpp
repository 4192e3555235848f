#include "tests/bench/pose/pose_part.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "cli/prepare.hpp"
#include "fixtures/synthetic/analytic_part.hpp"
#include "fixtures/synthetic/fe_part.hpp"

namespace arris::bench {
namespace {

using synthetic::PlateShape;

constexpr double kDrawnEdgeMm = 20.0, kContourStepMm = 1.0;

PosePart part_of(std::unique_ptr<const synthetic::Part> shape, std::vector<int> followed, bool whole_face) {
  std::vector<Contour> accepted, others;
  for (int c = 0; c < shape->contour_count(); ++c) {
    const bool follow = std::find(followed.begin(), followed.end(), c) != followed.end();
    (follow ? accepted : others).push_back(shape->nominal_contour(c, kContourStepMm));
  }
  CadModel cad = prepare_cad(shape->cad_mesh(kDrawnEdgeMm), accepted, others);
  std::string name = shape->name();
  return {std::move(name), std::move(shape), std::move(followed), whole_face, std::move(cad)};
}

PosePart plate(const char* name, PlateShape shape, std::vector<int> followed, bool whole_face) {
  shape.name = name;
  return part_of(std::make_unique<synthetic::PlatePart>(std::move(shape)), std::move(followed), whole_face);
}

/// An opening with corners; a half turn lays it on itself.
PlateShape rectangle() {
  PlateShape shape;
  shape.holes.push_back({{10.0, -5.0}, 80.0, 50.0, 3.0, 0.4});
  shape.bend_curvature_per_mm = 1.0 / 2500.0;
  return shape;
}

/// A quarter turn lays the opening 4 mm beside itself on each side.
PlateShape nearly_square() {
  PlateShape shape;
  shape.holes.push_back({{0.0, 0.0}, 70.0, 66.0, 12.0, 0.2});
  shape.bend_curvature_per_mm = 1.0 / 3000.0;
  return shape;
}

/// A half turn lays all holes on themselves but the second: 10 mm beside.
PlateShape nearly_symmetric_holes() {
  PlateShape shape;
  shape.holes.push_back({{0.0, 0.0}, 60.0, 40.0, 15.0, 0.0});
  shape.holes.push_back({{110.0, 60.0}, 15.0, 15.0, 15.0, 0.0});
  shape.holes.push_back({{-120.0, -60.0}, 15.0, 15.0, 15.0, 0.0});
  shape.scan_points = 8000;
  return shape;
}

}  // namespace

double PosePart::size_mm() const {
  double size_mm = 0.0;
  for (const Curve& curve : cad.contours) size_mm = std::max(size_mm, curve.length_mm() / 6.28);
  return size_mm;
}

std::vector<PosePart> pose_parts(const std::filesystem::path& fixtures) {
  std::set<std::filesystem::path> folders;
  for (const auto& entry : std::filesystem::directory_iterator(fixtures))
    if (std::filesystem::exists(entry.path() / "surface.fem")) folders.insert(entry.path());
  std::vector<PosePart> parts;
  for (const std::filesystem::path& folder : folders) {
    auto part = std::make_unique<synthetic::FePart>(synthetic::load_fe_part(folder));
    std::vector<int> followed(static_cast<std::size_t>(part->followed_count()));
    std::iota(followed.begin(), followed.end(), 0);
    parts.push_back(part_of(std::move(part), std::move(followed), false));
  }
  parts.push_back(plate("rectangle", rectangle(), {0}, false));
  parts.push_back(plate("nearly square", nearly_square(), {0}, false));
  parts.push_back(plate("nearly symmetric holes", nearly_symmetric_holes(), {0}, true));
  parts.push_back(plate("six holes", synthetic::plate_with_six_holes(), {0}, true));
  return parts;
}

}  // namespace arris::bench
