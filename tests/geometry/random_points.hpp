#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

namespace arris::testing {

/// Numbers that are the same on every machine: the generator's bits, scaled (std distributions may differ).
class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  /// Sum of twelve uniforms: mean 0, standard deviation 1.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform(0.0, 1.0);
    return sum;
  }
  Eigen::Vector3d in_cube_mm(double half_mm) {
    const double x = uniform(-half_mm, half_mm);
    const double y = uniform(-half_mm, half_mm);
    return {x, y, uniform(-half_mm, half_mm)};
  }
  Eigen::Vector3d direction() {
    Eigen::Vector3d v = in_cube_mm(1.0);
    while (v.norm() < 0.1 || v.norm() > 1.0) v = in_cube_mm(1.0);
    return v.normalized();
  }

 private:
  std::mt19937_64 bits_;
};

inline std::vector<Eigen::Vector3d> random_cube_mm(int count, double half_mm, unsigned seed) {
  Random random(seed);
  std::vector<Eigen::Vector3d> points_mm;
  for (int i = 0; i < count; ++i) points_mm.push_back(random.in_cube_mm(half_mm));
  return points_mm;
}

}  // namespace arris::testing
