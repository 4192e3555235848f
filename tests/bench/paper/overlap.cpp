#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/bench/paper/experiments.hpp"

namespace arris::bench {
namespace {

enum class Blend { kSin2, kPrinted, kPrintedScaled };
constexpr Blend kBlends[] = {Blend::kSin2, Blend::kPrinted, Blend::kPrintedScaled};
constexpr double kLeastMm = 1e-9;

/// One place of a contour as the printed eq. 7 and 8 carry it. In the overlap of zones z and z + 1 the
/// distances to v_z and v_{z+1} are those to its two ends; elsewhere one zone carries it.
Eigen::Vector3d by_printed_weights(const ContourMotion& motion, double arc_mm, const Eigen::Vector3d& p_mm,
                                   const RigidMotion& cad_from_local, bool scaled) {
  const std::vector<Segment>& segments = motion.subdivision().segments();
  const double length_mm = motion.nominal().length_mm();
  for (std::size_t z = 0; z < segments.size(); ++z) {
    const std::size_t next = (z + 1) % segments.size();
    const double half_mm = segments[z].reach_end_mm - segments[z].end_mm;
    const double beyond_cut_mm = std::remainder(arc_mm - segments[z].end_mm, length_mm);
    if (std::abs(beyond_cut_mm) >= half_mm) continue;
    const double to_own_mm = std::max(kLeastMm, half_mm + beyond_cut_mm);
    const double to_next_mm = std::max(kLeastMm, half_mm - beyond_cut_mm);
    const double own = printed_eq8(to_own_mm, to_next_mm), other = printed_eq8(to_next_mm, to_own_mm);
    const double sum = scaled ? own + other : 1.0;
    return (own / sum) * (cad_from_local * (motion.fits()[z].scan_from_cad * p_mm)) +
           (other / sum) * (cad_from_local * (motion.fits()[next].scan_from_cad * p_mm));
  }
  return cad_from_local * (motion.at(arc_mm) * p_mm);
}

CarriedPath blended(const ScanTrial& trial, const ContourMotion& motion, Blend blend) {
  CarriedPath path = trial.carried(motion);
  if (blend == Blend::kSin2) return path;
  for (std::size_t i = 0; i < path.tips_mm.size(); ++i) {
    const Eigen::Vector3d& p_mm = trial.part().path_mm[i];
    const double arc_mm = trial.part().cad.contours[0].nearest(p_mm).arc_mm;
    path.tips_mm[i] =
        by_printed_weights(motion, arc_mm, p_mm, trial.cad_from_local(), blend == Blend::kPrintedScaled);
  }
  return path;
}

/// Largest difference of the shifts of two neighbouring rows: a jump of the path; mm.
double largest_jump_mm(const BenchPart& part, const CarriedPath& path) {
  double largest_mm = 0.0;
  const std::size_t count = path.tips_mm.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    const Eigen::Vector3d step =
        (path.tips_mm[next] - part.path_mm[next]) - (path.tips_mm[i] - part.path_mm[i]);
    largest_mm = std::max(largest_mm, step.norm());
  }
  return largest_mm;
}

/// Means over the seeds, of one blend at one overlap.
struct Cell {
  double mean_mm = 0.0, max_mm = 0.0, jump_mm = 0.0;
};

std::array<Cell, 3> measure(const BenchPart& part, double overlap_ratio, int seeds) {
  std::array<Cell, 3> cells;
  for (int seed = 1; seed <= seeds; ++seed) {
    const synthetic::SyntheticScan scan = sample_scan(part.fe, {}, static_cast<std::uint64_t>(seed));
    const ScanTrial trial(part, scan);
    if (!trial.has_pose()) throw Error(Fault::kBug, "no pose on a whole scan");
    SubdivisionIcpOptions options = paper_options(trial);
    options.subdivision.overlap_ratio = overlap_ratio;
    const ContourMotion motion =
        subdivision_icp(part.cad, trial.model(), trial.raw_edge(), trial.paper_rigid(), options).front();
    for (std::size_t b = 0; b < cells.size(); ++b) {
      const CarriedPath path = blended(trial, motion, kBlends[b]);
      const PathError error = part.truth.error(part.path_mm, path.tips_mm);
      cells[b].mean_mm += error.mean_mm / seeds;
      cells[b].max_mm += error.max_mm / seeds;
      cells[b].jump_mm += largest_jump_mm(part, path) / seeds;
    }
  }
  return cells;
}

}  // namespace

std::string overlap_section(const BenchPart& part, int seeds) {
  std::string text = fmt::format(
      "#### {}, overlap and blend\n\nScan: {} points, noise 0.05 mm, nothing missing; seeds 1 to {}; the "
      "paper's "
      "choices.\nMean / largest error / largest jump between two rows, mm:\n\n"
      "| overlap | sin^2 | eq. 8 as printed | eq. 8 over its sum |\n|---|---|---|---|\n",
      part.fe.name(), part.fe.scan_points(), seeds);
  for (int percent = 0; percent <= 50; percent += 10) {
    text += fmt::format("| {} % |", percent);
    for (const Cell& cell : measure(part, percent / 100.0, seeds))
      text += fmt::format(" {:.2f} / {:.2f} / {:.2f} |", cell.mean_mm, cell.max_mm, cell.jump_mm);
    text += "\n";
  }
  return text + "\n";
}

}  // namespace arris::bench
