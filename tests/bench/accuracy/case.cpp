#include "tests/bench/accuracy/case.hpp"

namespace arris::bench {
namespace {

constexpr std::int64_t kDensePoints = 200000;
constexpr int kDenseSeeds = 3;

BenchCase named(const std::string& name, const std::string& word) {
  BenchCase one;
  one.name = name;
  one.word = word;
  return one;
}

BenchCase with_noise(const std::string& name, const std::string& word, double sigma_mm) {
  BenchCase one = named(name, word);
  one.scan.noise_sigma_mm = sigma_mm;
  return one;
}

BenchCase usual() {
  BenchCase one = named("clean, noise 0.05 mm", "clean");
  one.goal = Goal::kUsual;
  one.every_method = true;
  return one;
}

BenchCase in_rows() {
  BenchCase one = named("line-profiler rows", "rows");
  one.scan.rows = true;
  one.every_method = true;
  return one;
}

BenchCase with_walls() {
  BenchCase one = named("3 % wall points", "walls");
  one.scan.wall_ratio = 0.03;
  return one;
}

BenchCase with_gaps() {
  BenchCase one = named("15 % missing", "missing");
  one.scan.missing_ratio = 0.15;
  return one;
}

BenchCase with_clutter() {
  BenchCase one = named("clutter: table and clamps", "clutter");
  one.scan.clutter = true;
  return one;
}

BenchCase hard() {
  BenchCase one = named("hard: 15 % missing, 5 % strays, 3 % wall points, density 2 : 1", "hard");
  one.scan.missing_ratio = 0.15;
  one.scan.stray_ratio = 0.05;
  one.scan.wall_ratio = 0.03;
  one.scan.density_variation_ratio = 2.0;
  one.goal = Goal::kNothing;
  one.every_method = true;
  return one;
}

BenchCase dense() {
  BenchCase one = named("200,000 points", "dense");
  one.scan.points = kDensePoints;
  one.goal = Goal::kDense;
  one.most_seeds = kDenseSeeds;
  return one;
}

}  // namespace

std::vector<BenchCase> bench_cases() {
  return {usual(),
          with_noise("clean, noise 0.02 mm", "fine", 0.02),
          with_noise("clean, noise 0.1 mm", "coarse", 0.1),
          in_rows(),
          with_walls(),
          with_gaps(),
          with_clutter(),
          hard(),
          dense()};
}

}  // namespace arris::bench
