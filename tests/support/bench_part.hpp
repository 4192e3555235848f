#pragma once

#include <filesystem>
#include <vector>

#include "cli/drawing.hpp"
#include "cli/prepare.hpp"
#include "cli/recipe.hpp"
#include "fixtures/synthetic/fe_part.hpp"
#include "registration/registration.hpp"
#include "tests/support/truth.hpp"
#include "toolpath/correct.hpp"

namespace arris::bench {

/// One part with its drawing and the options of its own recipe.
struct BenchPart {
  BenchPart(const std::filesystem::path& folder, int threads);
  synthetic::FePart fe;
  Truth truth;
  Recipe recipe;
  Drawing drawing;
  CadModel cad;
  std::vector<Eigen::Vector3d> path_mm;  ///< tips of the nominal path, CAD frame
  std::vector<Eigen::Vector3d>
      surface_mm;  ///< the nominal face in the usual band, as many points as the usual scan
  int threads = 0;
};

/// Points of all accepted contours, at most step_mm apart.
[[nodiscard]] std::vector<Eigen::Vector3d> contour_points(const CadModel& cad, double step_mm);

/// The stages of `arris run`, from points in memory to the corrected path.
[[nodiscard]] PreparedScan prepare(const Recipe& recipe, int threads, const PointCloud& cloud);
[[nodiscard]] PreparedScan prepare(const BenchPart& part, const PointCloud& cloud);
[[nodiscard]] Correction correct_path(const BenchPart& part, const Registration& registration);

}  // namespace arris::bench
