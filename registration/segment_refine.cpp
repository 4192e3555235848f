#include "registration/segment_refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"
#include "registration/carried_curve.hpp"
#include "registration/segment_pairs.hpp"

namespace arris {
namespace {

constexpr double kAnneal = 0.7;        // scale of the loss, this round over the last
constexpr double kScaleSigmas = 3.0;   // where it stops
constexpr double kStartMedians = 3.0;  // where it begins, in medians of the residuals
constexpr double kSettledMm = 1e-4;
constexpr double kSlideMm = 5.0;  // along the contour, where only its shape holds a segment
constexpr double kFreeMm = 50.0,
                 kFreeTurnRad = 0.3;   // in other directions: for where there are no data at all
constexpr double kLeastSeamMm = 0.02;  // short segments bend little, but are no surer than this

double median_norm(const std::vector<CarriedCost>& costs) {
  std::vector<double> sizes;
  for (const CarriedCost& cost : costs) sizes.push_back((cost.directions * cost.gap_mm).norm());
  return median_of(std::move(sizes));
}

/// Segments of all contours in one row.
struct Layout {
  explicit Layout(const std::vector<ContourMotion>& motions) {
    for (const ContourMotion& motion : motions) {
      first.push_back(count);
      count += motion.fits().size();
    }
  }
  std::vector<std::size_t> first;
  std::size_t count = 0;
};

class JointFit {
 public:
  JointFit(const CadModel& cad, const ScanModel& scan, const EdgeData& data,
           const std::vector<ContourMotion>& motions, const SubdivisionIcpOptions& matching,
           const SegmentRefineOptions& options)
      : pairs_(cad, scan, data, motions, matching),
        options_(options),
        given_(motions),
        layout_(motions),
        band_mm_(matching.stability_distance_mm) {
    result_.asked = true;
    result_.motions = motions;
  }

  SegmentRefinement run() {
    match(given_);
    const double start_edge = kStartMedians * median_norm(problem_.edges);
    const double start_surface = kStartMedians * median_norm(problem_.surface);
    result_.stop = "round limit";
    double anneal = 1.0;
    for (int k = 0; k < options_.max_rounds; ++k, anneal *= kAnneal) {
      problem_.edge_scale_sigmas = std::max(kScaleSigmas, anneal * start_edge);
      problem_.surface_scale_sigmas = std::max(kScaleSigmas, anneal * start_surface);
      const SegmentSolution solution = solve_segments(problem_, options_.steps_a_round);
      result_.rounds.push_back({problem_.edge_scale_sigmas, solution.statement, 0.0});
      if (!solution.statement.solved) return failed(solution.statement.termination);
      result_.rounds.back().move_mm = move(solution.steps);
      match(result_.motions);
      const bool annealed = anneal * std::max(start_edge, start_surface) <= kScaleSigmas;
      if (!annealed || result_.rounds.back().move_mm > kSettledMm) continue;
      result_.stop = "converged";
      break;
    }
    tell();
    return std::move(result_);
  }

 private:
  SegmentRefinement failed(const std::string& words) {
    result_.motions = given_;
    result_.stop = words;
    result_.reason = "the joint fit of the segments failed in round " +
                     std::to_string(result_.rounds.size()) + " (" + words +
                     "): the motions of subdivision ICP are kept";
    return std::move(result_);
  }

  void match(const std::vector<ContourMotion>& motions) {
    problem_.segments = layout_.count;
    problem_.edges = pairs_.edges(motions, layout_.first);
    problem_.surface = pairs_.surface(motions, layout_.first);
    problem_.seams.clear();
    problem_.anchors.clear();
    for (std::size_t c = 0; c < motions.size(); ++c) {
      for (const Seam& seam : seams_of(motions[c])) add_seam(motions[c], layout_.first[c], seam);
      for (std::size_t z = 0; z < motions[c].fits().size(); ++z) add_anchor(motions[c], c, z);
    }
  }

  void add_anchor(const ContourMotion& motion, std::size_t c, std::size_t z) {
    const RigidMotion& began = given_[c].fits()[z].scan_from_cad;
    const Eigen::Vector3d pivot_mm = segment_pivot_mm(motion, z);
    const Eigen::Matrix3d axes =
        began.linear() * contour_axes(motion.nominal(), segment_middle_mm(motion, z));
    AnchorCost cost;
    cost.segment = static_cast<int>(layout_.first[c] + z);
    cost.offset_mm = motion.fits()[z].scan_from_cad * pivot_mm - began * pivot_mm;
    cost.shift_rows =
        Eigen::Vector3d(1.0 / kSlideMm, 1.0 / kFreeMm, 1.0 / kFreeMm).asDiagonal() * axes.transpose();
    cost.turn_sd_rad = kFreeTurnRad;
    problem_.anchors.push_back(cost);
  }

  /// Expected steps at a cut between rigid pieces of a thin part, their middles d apart. Out of the surface
  /// it bends: they turn by bend * d, and the chords of two arcs meet within bend * d^2 / 12. In the surface
  /// it hardly stretches: they slide by strain * d, and turn by strain * d / band, for a turn in the surface
  /// needs a strain that differs over the width of the band.
  void add_seam(const ContourMotion& motion, std::size_t first, const Seam& seam) {
    const Curve& curve = motion.nominal();
    const std::vector<Segment>& segments = motion.subdivision().segments();
    const double apart_mm = 0.5 * (segments[seam.before].end_mm - segments[seam.before].begin_mm +
                                   segments[seam.after].end_mm - segments[seam.after].begin_mm);
    const double turn_rad = options_.bend_per_mm * apart_mm;
    const double swing_rad = std::min(turn_rad, options_.strain_ratio * apart_mm / band_mm_);
    const auto at_least = [](double sd_mm) { return std::max(kLeastSeamMm, sd_mm); };
    const Eigen::Vector3d place_sd_mm(at_least(options_.strain_ratio * apart_mm),
                                      at_least(swing_rad * apart_mm / 12.0),
                                      at_least(turn_rad * apart_mm / 12.0));
    const Eigen::Vector3d turn_sd_rad(turn_rad, turn_rad, swing_rad);
    SeamCost cost;
    cost.sides = {pairs_.carrier(motion, first, seam.before, curve.point_mm(seam.arc_mm), 1.0),
                  pairs_.carrier(motion, first, seam.after, curve.point_mm(seam.arc_mm), 1.0)};
    const RigidMotion& before = motion.fits()[seam.before].scan_from_cad;
    const RigidMotion& after = motion.fits()[seam.after].scan_from_cad;
    cost.rotations_scan_from_cad = {before.linear(), after.linear()};
    cost.gap_mm = before * curve.point_mm(seam.arc_mm) - after * curve.point_mm(seam.arc_mm);
    const Eigen::Matrix3d axes = contour_axes(curve, seam.arc_mm);
    const Eigen::Matrix3d axes_scan = motion.at(seam.arc_mm).linear() * axes;
    cost.place_rows = place_sd_mm.cwiseInverse().asDiagonal() * axes_scan.transpose();
    cost.turn_rows = turn_sd_rad.cwiseInverse().asDiagonal() * axes.transpose();
    problem_.seams.push_back(cost);
  }

  /// Takes the steps; returns the largest move of a segment's middle across its contour.
  double move(const std::vector<SegmentStep>& steps) {
    double most_mm = 0.0;
    for (std::size_t c = 0; c < result_.motions.size(); ++c) {
      const ContourMotion& old = result_.motions[c];
      std::vector<SegmentFit> fits = old.fits();
      for (std::size_t z = 0; z < fits.size(); ++z) {
        const SegmentStep& step = steps[layout_.first[c] + z];
        const Eigen::Vector3d pivot_mm = segment_pivot_mm(old, z);
        const Eigen::Vector3d image_mm = fits[z].scan_from_cad * pivot_mm;
        const Eigen::Vector3d tangent =
            fits[z].scan_from_cad.linear() * old.nominal().tangent(segment_middle_mm(old, z));
        const Eigen::Vector3d shift_mm = step.tail<3>();
        most_mm = std::max(most_mm, (shift_mm - shift_mm.dot(tangent) * tangent).norm());
        RigidMotion moved;
        moved.linear() = rotation_of(step.head<3>()) * fits[z].scan_from_cad.linear();
        moved.translation() = image_mm + shift_mm - moved.linear() * pivot_mm;
        moved.makeAffine();
        fits[z].scan_from_cad = moved;
      }
      result_.motions[c] = ContourMotion(old.nominal(), old.subdivision(), std::move(fits));
    }
    return most_mm;
  }

  /// Residuals of the edge points under the given motions, one mean a segment, by the final loss.
  std::vector<RefinedSegment> residuals(const std::vector<ContourMotion>& motions) const {
    std::vector<RefinedSegment> segments(layout_.count);
    std::vector<double> sum2(layout_.count, 0.0), sum(layout_.count, 0.0);
    for (const CarriedCost& cost : pairs_.edges(motions, layout_.first)) {
      const double squared = (cost.directions * cost.gap_mm).squaredNorm();
      const double robust = geman_mcclure(squared, kScaleSigmas)[1];
      const Eigen::Vector2d apart_mm = cost.directions.rowwise().normalized() * cost.gap_mm;
      for (std::size_t i = 0; i < static_cast<std::size_t>(cost.carrier_count); ++i) {
        const std::size_t z = static_cast<std::size_t>(cost.carriers[i].segment);
        sum2[z] += robust * cost.carriers[i].weight * apart_mm.squaredNorm();
        sum[z] += robust * cost.carriers[i].weight;
        ++segments[z].pairs;
      }
    }
    for (std::size_t z = 0; z < segments.size(); ++z)
      segments[z].rms_after_mm = sum[z] > 0.0 ? std::sqrt(sum2[z] / sum[z]) : 0.0;
    return segments;
  }

  void tell() {
    const std::vector<RefinedSegment> before = residuals(given_);
    result_.segments = residuals(result_.motions);
    for (std::size_t c = 0; c < given_.size(); ++c) {
      for (std::size_t z = 0; z < given_[c].fits().size(); ++z) {
        RefinedSegment& segment = result_.segments[layout_.first[c] + z];
        segment.contour = c;
        segment.segment = z;
        segment.rms_before_mm = before[layout_.first[c] + z].rms_after_mm;
      }
      const std::vector<Seam> was = seams_of(given_[c]), is = seams_of(result_.motions[c]);
      for (std::size_t i = 0; i < was.size(); ++i) result_.seams.push_back({c, was[i], is[i]});
    }
  }

  SegmentPairs pairs_;
  const SegmentRefineOptions& options_;
  const std::vector<ContourMotion>& given_;
  Layout layout_;
  double band_mm_;
  SegmentProblem problem_;
  SegmentRefinement result_;
};

}  // namespace

std::string SegmentRefinement::statement() const {
  if (!usable()) return reason;
  double before2 = 0.0, after2 = 0.0;
  for (const RefinedSeam& seam : seams) {
    before2 += seam.before.jump_mm * seam.before.jump_mm;
    after2 += seam.after.jump_mm * seam.after.jump_mm;
  }
  const double count = std::max<double>(1.0, static_cast<double>(seams.size()));
  return fmt::format("{} after {} rounds; seams jump by {:.3f} mm rms, before {:.3f} mm", stop, rounds.size(),
                     std::sqrt(after2 / count), std::sqrt(before2 / count));
}

SegmentRefinement refine_segments(const CadModel& cad, const ScanModel& scan, const EdgeData& data,
                                  const std::vector<ContourMotion>& motions,
                                  const SubdivisionIcpOptions& matching,
                                  const SegmentRefineOptions& options) {
  return JointFit(cad, scan, data, motions, matching, options).run();
}

}  // namespace arris
