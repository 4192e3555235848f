#include "tests/bench/trust/study_part.hpp"

#include <array>
#include <numbers>

#include "fixtures/synthetic/analytic_part.hpp"
#include "fixtures/synthetic/fe_part.hpp"

namespace arris::bench {
namespace {

using synthetic::PlateShape;
using synthetic::Random;

double either_sign(Random& random, double low, double high) {
  const double size = random.uniform(low, high);
  return random.uniform() < 0.5 ? -size : size;
}

/// A circle, or a rectangle with rounded corners; a second hole on every other plate.
PlateShape drawn(Random& random) {
  PlateShape shape;
  shape.name = "plate";
  shape.thickness_mm = random.uniform(1.5, 4.0);
  shape.band_mm = 30.0;
  synthetic::PlateHole hole;
  hole.centre_mm = {random.uniform(-20.0, 20.0), random.uniform(-15.0, 15.0)};
  hole.half_x_mm = random.uniform(45.0, 75.0);
  const bool round = random.uniform() < 0.33;
  hole.half_y_mm = round ? hole.half_x_mm : random.uniform(35.0, 0.9 * hole.half_x_mm);
  hole.corner_radius_mm = round ? hole.half_x_mm : random.uniform(10.0, 30.0);
  hole.turn_rad = random.uniform(0.0, std::numbers::pi);
  shape.holes.push_back(hole);
  if (random.uniform() < 0.5) {
    const double radius_mm = random.uniform(8.0, 14.0);
    shape.holes.push_back({{165.0, random.uniform(-100.0, 100.0)}, radius_mm, radius_mm, radius_mm, 0.0});
  }
  return shape;
}

void bend_smoothly(Random& random, PlateShape& shape) {
  shape.bend_curvature_per_mm = either_sign(random, 1.0 / 6000.0, 1.0 / 1500.0);
  shape.bend_axis_rad = random.uniform(0.0, std::numbers::pi);
  shape.twist_rad_per_mm = either_sign(random, 0.0, 2e-4);
  shape.stretch_ratio = {3e-4 * random.normal(), 3e-4 * random.normal()};
}

void dent(Random& random, PlateShape& shape) {
  const synthetic::PlateHole& hole = shape.holes.front();
  const double angle_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Eigen::Vector2d out(synthetic::portable_cos(angle_rad), synthetic::portable_sin(angle_rad));
  synthetic::PlateDent mark;
  mark.centre_mm = hole.centre_mm + (hole.half_x_mm + random.uniform(0.0, 20.0)) * out;
  mark.radius_mm = random.uniform(35.0, 80.0);
  mark.height_mm = either_sign(random, 0.3, 1.5);
  shape.dents.push_back(mark);
}

void crease(Random& random, PlateShape& shape) {
  synthetic::PlateCrease line;
  line.line_rad = random.uniform(0.0, std::numbers::pi);
  line.offset_mm = random.uniform(-30.0, 30.0);
  line.angle_rad = either_sign(random, 0.005, 0.02);
  line.half_width_mm = random.uniform(10.0, 25.0);
  shape.creases.push_back(line);
}

}  // namespace

StudyPart study_part(std::uint64_t seed, const std::filesystem::path& fe_folder) {
  Random random(seed * 7919 + 17);
  StudyPart study;
  if (seed % 2 == 0) study.noise_length_mm = random.uniform(1.5, 5.0);
  const std::array<std::string, 4> outside = {"dent", "crease", seed % 24 < 12 ? "porthole" : "sheet",
                                              "dent"};
  study.kind = seed % 3 == 0 ? outside[(seed / 3) % outside.size()] : "smooth";
  if (study.kind == "porthole" || study.kind == "sheet") {
    study.part = std::make_unique<synthetic::FePart>(synthetic::load_fe_part(fe_folder / study.kind));
    return study;
  }
  PlateShape shape = drawn(random);
  bend_smoothly(random, shape);
  if (study.kind == "dent") dent(random, shape);
  if (study.kind == "crease") crease(random, shape);
  study.part = std::make_unique<synthetic::PlatePart>(shape);
  return study;
}

}  // namespace arris::bench
