#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fixtures/synthetic/scan.hpp"
#include "tests/support/bench_part.hpp"
#include "tests/support/coverage.hpp"

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
  kParabola,        ///< projection, a parabola about a fitted axis; refused or not
  kHeightSpline,    ///< projection, a spline along the contour; refused or not
  kPaper,           ///< subdivision ICP with the paper's choices
  kPaperNoSupport,  ///< the same without its stability points
  kPlain,           ///< our subdivision ICP on the edge points as extracted
  kSupported,       ///< our subdivision ICP on the edge by one-sided support; refused or not
  kRefined,         ///< the same, all segments fitted together afterwards; refused or not
  kWhole,           ///< the whole method: what `arris run` writes
  kMethodCount
};

/// What is asked of a case: mean and peak error over the edge limit E, or in mm.
enum class Goal {
  kUsual,   ///< a clean scan of noise 0.05 mm: so many E
  kTwice,   ///< as much again for what shops have
  kDense,   ///< 200,000 points: in mm
  kNothing  ///< everything at once: shown, nothing is asked
};

/// A way to scan.
struct BenchCase {
  std::string name, word;  ///< of the tables; of --only
  synthetic::ScanOptions scan;
  Goal goal = Goal::kTwice;
  bool every_method = false;  ///< the other methods and the peers as well
  int most_seeds = 1000;
};
[[nodiscard]] std::vector<BenchCase> bench_cases();

/// Errors of one scan; a method without a result has none.
struct Outcome {
  std::array<std::optional<PathError>, kMethodCount> error;
  std::optional<PathError> refused;  ///< of a refused correction: what it would have been
  std::vector<std::string> reasons;  ///< of the refusal
  std::vector<StatedError> stated;   ///< of an accepted path: its rows' errors beside what was stated of them
  double axis_p95_deg = 0.0;         ///< of an accepted path: 95th percentile of its axes' errors
  Method rigid_winner = kOursToPlane;
  double edge_limit_mm = 0.0;     ///< E
  double surface_limit_mm = 0.0;  ///< sigma / sqrt(points within 10 mm)
  std::size_t points = 0;
};

[[nodiscard]] Outcome measure(const BenchPart& part, const BenchCase& bench_case, std::uint64_t seed);

}  // namespace arris::bench
