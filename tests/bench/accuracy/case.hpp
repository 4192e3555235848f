#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/drawing.hpp"
#include "cli/prepare.hpp"
#include "cli/recipe.hpp"
#include "fixtures/synthetic/fe_part.hpp"
#include "fixtures/synthetic/scan.hpp"
#include "registration/registration.hpp"
#include "tests/bench/accuracy/truth.hpp"
#include "toolpath/correct.hpp"

namespace arris::bench {

/// The rows of the tables.
enum Method : std::size_t {
  kNominal,         ///< the nominal path at the true pose
  kBestRigid,       ///< the best rigid motion there is: true material points known
  kRigidIcp,        ///< the best of the four that follow, by its true mean error
  kOursToPoint,     ///< rigid ICP, contour points
  kOursToPlane,     ///< rigid ICP, surface and edge
  kPclToPoint,      ///< PCL, contour points
  kPclToPlane,      ///< PCL, points of the band
  kPaper,           ///< subdivision ICP with the paper's choices
  kPaperNoSupport,  ///< the same without its stability points
  kPlain,           ///< our subdivision ICP on the edge points as extracted
  kWhole,           ///< the whole method: what `arris run` writes
  kWholeRefined,    ///< the same with refine = "ceres"
  kMethodCount
};

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

/// A way to scan.
struct BenchCase {
  std::string name;
  synthetic::ScanOptions scan;
};
[[nodiscard]] std::vector<BenchCase> bench_cases();

/// Errors of one scan; a method without a result has none.
struct Outcome {
  std::array<std::optional<PathError>, kMethodCount> error;
  std::optional<PathError> refused;  ///< of a refused correction: what it would have been
  std::vector<std::string> reasons;  ///< of the refusal
  Method rigid_winner = kOursToPlane;
  double edge_limit_mm = 0.0;     ///< E
  double surface_limit_mm = 0.0;  ///< sigma / sqrt(points within 10 mm)
  std::size_t points = 0;
};

/// The stages of `arris run`, from points in memory to the corrected path.
[[nodiscard]] PreparedScan prepare(const BenchPart& part, const PointCloud& cloud);
[[nodiscard]] Correction correct_path(const BenchPart& part, const Registration& registration);

[[nodiscard]] Outcome measure(const BenchPart& part, const BenchCase& bench_case, std::uint64_t seed);

}  // namespace arris::bench
