#include "registration/subdivision_icp.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/geometry/rigid_fit.hpp"
#include "acquisition/types/error.hpp"
#include "registration/edge_pairs.hpp"
#include "registration/normal_equations.hpp"

namespace arris {
namespace {

constexpr double kCosNormalsAgree = 0.5;  // correspondences need normals within 60 degrees
constexpr double kAnneal = 0.6;           // robust scale of the next round over this one
constexpr double kScaleSigmas = 3.0;      // where annealing stops
constexpr double kMisfitSigmaMm = 0.15;   // a rigid segment on a bending part: misfit along the normal
constexpr double kCoveredRatio = 0.4;     // of a segment's arc bins, for its motion to count as data
constexpr double kBinMm = 5.0;
constexpr double kFarthestStartMm =
    60.0;  // edge points farther from the rigidly placed contour are another edge's
constexpr std::size_t kChunk = 512, kEdgeChunk = 64;

/// Scan points beside the contour that hold the segments' tilt.
struct StabilityPoint {
  std::size_t scan_index = 0;
  double arc_mm = 0.0;
  std::int32_t triangle = -1;  // of the last round
};

/// A scan edge point as a segment's motion puts it, and its foot on the contour.
struct PairedEdge {
  std::size_t segment = 0;
  Eigen::Vector3d x_mm = Eigen::Vector3d::Zero();  // CAD frame
  EdgePair pair;
};

double log_angle(const RigidMotion& motion, Eigen::Vector3d& turn) {
  const Eigen::AngleAxisd rotation(motion.linear());
  turn = rotation.angle() * rotation.axis();
  return rotation.angle();
}

/// One contour in kFoot mode: all segments move together, each by its own Gauss-Newton step a round.
class FootFit {
 public:
  FootFit(const CadModel& cad, std::size_t contour, const ScanModel& scan, const EdgeData& data,
          const RigidMotion& rigid, const SubdivisionIcpOptions& options, const ContourMotion* earlier)
      : cad_(cad),
        curve_(cad.contours[contour]),
        contour_(static_cast<int>(contour)),
        scan_(scan),
        data_(data),
        options_(options),
        subdivision_(earlier != nullptr ? earlier->subdivision() : Subdivision(curve_, options.subdivision)) {
    SegmentFit start;
    start.scan_from_cad = rigid;
    fits_.assign(subdivision_.segments().size(), start);
    for (const Segment& segment : subdivision_.segments())
      pivots_mm_.push_back(curve_.point_mm(curve_.wrap_mm(0.5 * (segment.begin_mm + segment.end_mm))));
    sigma_normal_mm_ = std::max(scan.noise_sigma_mm, kMisfitSigmaMm);
    choose_stability_points(rigid.inverse());
    start_scale_mm_ = start_scale_mm(rigid.inverse());
    if (earlier != nullptr) {
      fits_ = earlier->fits();
      anneal_ = 0.0;
    }
  }

  ContourMotion run() {
    double last_rms = 1e300;
    for (int k = 0; k < options_.max_iterations; ++k) {
      const double rms = round();
      for (SegmentFit& fit : fits_) fit.iterations = k + 1, fit.stop = "iteration limit";
      if (settled() && std::abs(last_rms - rms) <= options_.stop_change_ratio * rms) {
        for (SegmentFit& fit : fits_) fit.stop = "converged";
        break;
      }
      last_rms = rms;
      anneal_ *= kAnneal;
    }
    return {curve_, subdivision_, fits_};
  }

 private:
  /// Robust scale at the start: the rigid fit leaves the whole deformation in the residuals.
  double start_scale_mm(const RigidMotion& cad_from_scan) const {
    std::vector<double> sizes;
    for (const Eigen::Vector3d& e : data_.points_mm) {
      const EdgePair pair = pair_edge(cad_, cad_from_scan * e, kFarthestStartMm);
      if (pair.contour == contour_) sizes.push_back(std::hypot(pair.across_mm, pair.normal_mm));
    }
    return sizes.empty() ? 1.0 : 3.0 * median_of(std::move(sizes));
  }

  double across_scale_mm() const {
    return std::max(kScaleSigmas * data_.sigma_across_mm, anneal_ * start_scale_mm_);
  }
  double normal_scale_mm() const {
    return std::max(kScaleSigmas * sigma_normal_mm_, anneal_ * start_scale_mm_);
  }
  bool settled() const {
    return anneal_ * start_scale_mm_ <= kScaleSigmas * std::min(data_.sigma_across_mm, sigma_normal_mm_);
  }

  void choose_stability_points(const RigidMotion& cad_from_scan) {
    if (options_.stability == StabilityPoints::kNone) return;
    std::vector<double> arc(scan_.points_mm.size(), -1.0);
    parallel_for(arc.size(), kChunk, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const EdgePair pair =
            pair_edge(cad_, cad_from_scan * scan_.points_mm[i], options_.stability_distance_mm);
        if (pair.contour == contour_ && pair.across_mm > scan_.spacing_mm) arc[i] = pair.foot.arc_mm;
      }
    });
    std::vector<std::vector<StabilityPoint>> of(fits_.size());
    for (std::size_t i = 0; i < arc.size(); ++i)
      if (arc[i] >= 0.0)
        for (const int z : subdivision_.reaching(arc[i]))
          of[static_cast<std::size_t>(z)].push_back({i, arc[i]});
    const std::size_t limit = static_cast<std::size_t>(options_.stability_points);
    for (std::vector<StabilityPoint>& list : of) {
      if (list.size() <= limit) continue;
      for (std::size_t i = 0; i < limit; ++i) list[i] = list[i * list.size() / limit];
      list.resize(limit);
    }
    stability_ = std::move(of);
  }

  /// The motion the neighbours suggest for segment z, as cad_from_scan.
  RigidMotion suggested(std::size_t z) const {
    const std::size_t n = fits_.size();
    const bool open_start = !curve_.closed() && z == 0, open_end = !curve_.closed() && z + 1 == n;
    if (n == 1) return fits_[z].scan_from_cad.inverse();
    const RigidMotion before = fits_[open_start ? z + 1 : (z + n - 1) % n].scan_from_cad.inverse();
    const RigidMotion after = fits_[open_end ? z - 1 : (z + 1) % n].scan_from_cad.inverse();
    const RigidMotion apart = before.inverse() * after;
    Eigen::Vector3d turn;
    const double angle_rad = log_angle(apart, turn);
    RigidMotion middle = before;
    if (angle_rad > 0.0) middle.rotate(Eigen::AngleAxisd(0.5 * angle_rad, turn / angle_rad));
    const Eigen::Vector3d p_scan_mm = fits_[z].scan_from_cad * pivots_mm_[z];
    middle.translation() = 0.5 * (before * p_scan_mm + after * p_scan_mm) - middle.linear() * p_scan_mm;
    return middle;
  }

  /// One round over all segments; returns the rms across the contour.
  double round() {
    const std::size_t n = fits_.size();
    std::vector<NormalEquations> systems(n);
    std::vector<RigidMotion> current(n);
    for (std::size_t z = 0; z < n; ++z) current[z] = fits_[z].scan_from_cad.inverse();
    std::vector<std::vector<char>> seen(n);
    double cost = 0.0, weight = 0.0;
    for (std::size_t z = 0; z < n; ++z) {
      const Segment& segment = subdivision_.segments()[z];
      seen[z].assign(static_cast<std::size_t>((segment.end_mm - segment.begin_mm) / kBinMm) + 1, 0);
      fits_[z].pairs = 0;
    }
    assign_edges(current, systems, seen, cost, weight);
    parallel_for(stability_.size(), 1, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t z = begin; z < end; ++z) add_stability(z, current[z], systems[z]);
    });
    std::vector<RigidMotion> next(n);
    for (std::size_t z = 0; z < n; ++z) {
      const double covered = static_cast<double>(std::count(seen[z].begin(), seen[z].end(), 1)) /
                             static_cast<double>(seen[z].size());
      fits_[z].from_data = covered >= kCoveredRatio;
      next[z] = step(z, current[z], systems[z]);
    }
    for (std::size_t z = 0; z < n; ++z) fits_[z].scan_from_cad = next[z].inverse();
    return weight > 0.0 ? std::sqrt(cost / weight) : 0.0;
  }

  /// Scan edge points to their feet; the reach shrinks with the robust scale.
  void assign_edges(const std::vector<RigidMotion>& current, std::vector<NormalEquations>& systems,
                    std::vector<std::vector<char>>& seen, double& cost, double& weight) {
    const double across_scale = across_scale_mm(), normal_scale = normal_scale_mm();
    const double across_weight = 1.0 / (data_.sigma_across_mm * data_.sigma_across_mm);
    const double normal_weight = 1.0 / (sigma_normal_mm_ * sigma_normal_mm_);
    const double reach_mm = 3.0 * std::max(across_scale, scan_.spacing_mm);
    std::vector<std::vector<PairedEdge>> paired(data_.points_mm.size());
    parallel_for(paired.size(), kEdgeChunk, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) paired[i] = pairs_of(i, current, reach_mm);
    });
    std::vector<double> segment_cost(fits_.size(), 0.0), segment_weight(fits_.size(), 0.0);
    for (const std::vector<PairedEdge>& pairs : paired)
      for (const auto& [z, x_mm, pair] : pairs) {
        const double robust = geman_mcclure_weight(pair.across_mm * pair.across_mm, across_scale) *
                              geman_mcclure_weight(pair.normal_mm * pair.normal_mm, normal_scale);
        const Eigen::Vector3d x = x_mm - pivots_mm_[z];
        systems[z].add(x, pair.across, pair.across_mm, robust * across_weight);
        systems[z].add(x, pair.normal, pair.normal_mm, robust * normal_weight);
        segment_cost[z] += robust * pair.across_mm * pair.across_mm;
        segment_weight[z] += robust;
        if (robust > 0.25) mark_seen(z, pair.foot.arc_mm, seen[z]);
      }
    for (std::size_t z = 0; z < fits_.size(); ++z) {
      fits_[z].rms_mm = segment_weight[z] > 0.0 ? std::sqrt(segment_cost[z] / segment_weight[z]) : 0.0;
      cost += segment_cost[z];
      weight += segment_weight[z];
    }
  }

  /// Edge point i beside the contour, once for each segment that it belongs to.
  std::vector<PairedEdge> pairs_of(std::size_t i, const std::vector<RigidMotion>& current,
                                   double reach_mm) const {
    std::vector<PairedEdge> pairs;
    for (const int index : segments_of(i, current, reach_mm)) {
      const std::size_t z = static_cast<std::size_t>(index);
      const Eigen::Vector3d x_mm = current[z] * data_.points_mm[i];
      const EdgePair pair = pair_edge(cad_, x_mm, 2.0 * reach_mm);
      if (pair.contour == contour_) pairs.push_back({z, x_mm, pair});
    }
    return pairs;
  }

  void mark_seen(std::size_t z, double arc_mm, std::vector<char>& bins) {
    const Segment& segment = subdivision_.segments()[z];
    double from_begin = arc_mm - segment.begin_mm;
    if (curve_.closed() && from_begin < 0.0) from_begin += curve_.length_mm();
    if (from_begin < 0.0 || from_begin > segment.end_mm - segment.begin_mm) return;
    bins[std::min(bins.size() - 1, static_cast<std::size_t>(from_begin / kBinMm))] = 1;
    ++fits_[z].pairs;
  }

  /// The segments that an edge point belongs to: by its known place, else by its foot under the motion of the
  /// segment where the first segment's motion puts it (all motions are near each other).
  std::vector<int> segments_of(std::size_t i, const std::vector<RigidMotion>& current,
                               double reach_mm) const {
    if (!data_.arc_mm.empty())
      return static_cast<int>(data_.contour[i]) == contour_ ? subdivision_.reaching(data_.arc_mm[i])
                                                            : std::vector<int>{};
    const Eigen::Vector3d& e = data_.points_mm[i];
    const EdgePair first = pair_edge(cad_, current.front() * e, reach_mm + kFarthestStartMm);
    if (first.contour != contour_) return {};
    const std::vector<int> candidates = subdivision_.reaching(first.foot.arc_mm);
    if (candidates.empty()) return {};
    const EdgePair second =
        pair_edge(cad_, current[static_cast<std::size_t>(candidates.front())] * e, reach_mm);
    return second.contour == contour_ ? subdivision_.reaching(second.foot.arc_mm) : std::vector<int>{};
  }

  void add_stability(std::size_t z, const RigidMotion& cad_from_scan, NormalEquations& system) {
    const double scale_mm = normal_scale_mm();
    const double weight = 1.0 / (sigma_normal_mm_ * sigma_normal_mm_);
    for (StabilityPoint& sp : stability_[z]) {
      const Eigen::Vector3d x = cad_from_scan * scan_.points_mm[sp.scan_index];
      const SurfacePoint foot = cad_.surface.closest(x, 4.0 * scale_mm + scan_.spacing_mm, sp.triangle);
      sp.triangle = foot.triangle;
      if (foot.triangle < 0 || foot.on_border) continue;
      if (std::abs(foot.normal.dot(cad_from_scan.linear() * scan_.normals[sp.scan_index])) < kCosNormalsAgree)
        continue;
      const double residual_mm = foot.normal.dot(x - foot.foot_mm);
      system.add(x - pivots_mm_[z], foot.normal, residual_mm,
                 weight * geman_mcclure_weight(residual_mm * residual_mm, scale_mm));
    }
  }

  /// One step of segment z, tied softly to what its neighbours suggest.
  RigidMotion step(std::size_t z, const RigidMotion& cad_from_scan, NormalEquations system) const {
    Eigen::Matrix<double, 6, 1> prior;
    const auto inverse2 = [](double sd) { return 1.0 / (sd * sd); };
    prior << Eigen::Vector3d::Constant(inverse2(options_.neighbour_turn_rad)),
        Eigen::Vector3d::Constant(inverse2(options_.neighbour_shift_mm));
    const RigidMotion off = cad_from_scan * suggested(z).inverse();
    Eigen::Vector3d turn;
    log_angle(off, turn);
    Eigen::Matrix<double, 6, 1> residual;
    residual << turn, off * pivots_mm_[z] - pivots_mm_[z];
    system.gradient += prior.cwiseProduct(residual);
    return motion_of(system.solve(prior), pivots_mm_[z]) * cad_from_scan;
  }

  const CadModel& cad_;
  const Curve& curve_;
  int contour_;
  const ScanModel& scan_;
  const EdgeData& data_;
  const SubdivisionIcpOptions& options_;
  Subdivision subdivision_;
  std::vector<SegmentFit> fits_;
  std::vector<Eigen::Vector3d> pivots_mm_;  // of each segment: what its turns are about, CAD frame
  std::vector<std::vector<StabilityPoint>> stability_;
  double sigma_normal_mm_ = 0.0, start_scale_mm_ = 1.0, anneal_ = 1.0;
};

/// The paper's choices: contour points and all stability points of the surface, frozen partners for the
/// latter.
ContourMotion paper_fit(const Curve& curve, const ScanModel& scan, const EdgeData& data,
                        const RigidMotion& rigid, const SubdivisionIcpOptions& options) {
  const Subdivision subdivision(curve, options.subdivision);
  const NearestPoints tree(data.points_mm);
  const Contour model = resample(curve.contour(), std::max(0.5, scan.spacing_mm));
  std::vector<Eigen::Vector3d> stability_model, stability_scan;
  if (options.stability != StabilityPoints::kNone) {
    const int count = options.stability_points;
    for (int i = 0; i < count; ++i) {
      const double s_mm = curve.length_mm() * i / count;
      const Eigen::Vector3d inward = curve.normal(s_mm).cross(curve.tangent(s_mm)).normalized();
      const Eigen::Vector3d p = curve.point_mm(s_mm) + options.stability_distance_mm * inward;
      const Neighbour partner = scan.tree.nearest(rigid * p);
      if (partner.index < 0) continue;
      stability_model.push_back(p);
      stability_scan.push_back(scan.points_mm[static_cast<std::size_t>(partner.index)]);
    }
  }
  std::vector<SegmentFit> fits(subdivision.segments().size());
  for (std::size_t z = 0; z < fits.size(); ++z) {
    SegmentFit& fit = fits[z];
    fit.scan_from_cad = rigid;
    std::vector<Eigen::Vector3d> from, to;
    for (const Eigen::Vector3d& p : model.points_mm) {
      const std::vector<int> in = subdivision.reaching(curve.nearest(p).arc_mm);
      if (std::find(in.begin(), in.end(), static_cast<int>(z)) != in.end()) from.push_back(p);
    }
    fit.pairs = static_cast<int>(from.size());
    from.insert(from.end(), stability_model.begin(), stability_model.end());
    to.resize(from.size());
    std::copy(stability_scan.begin(), stability_scan.end(), to.begin() + fit.pairs);
    double last_rms = 1e300;
    fit.stop = "iteration limit";
    for (int k = 0; k < options.max_iterations && tree.size() > 0; ++k) {
      for (int i = 0; i < fit.pairs; ++i) {
        const std::size_t index = static_cast<std::size_t>(i);
        to[index] =
            data.points_mm[static_cast<std::size_t>(tree.nearest(fit.scan_from_cad * from[index]).index)];
      }
      const RigidFit rigid_fit = fit_rigid(from, to);
      if (!rigid_fit.usable()) {
        fit.from_data = false;
        fit.stop = rigid_fit.reason;
        break;
      }
      fit.scan_from_cad = rigid_fit.to_from;
      fit.rms_mm = rigid_fit.rms_mm;
      fit.iterations = k + 1;
      if (std::abs(last_rms - fit.rms_mm) <= options.stop_change_ratio * fit.rms_mm) {
        fit.stop = "converged";
        break;
      }
      last_rms = fit.rms_mm;
    }
  }
  return {curve, subdivision, fits};
}

}  // namespace

void SubdivisionIcpOptions::check() const {
  subdivision.check();
  if (max_iterations < 1)
    throw Error(Fault::kRecipe, {.what = "registration.subdivision.max_iterations is out of range",
                                 .found = std::to_string(max_iterations),
                                 .needed = "1 or more"});
  if (stability_points < 0)
    throw Error(Fault::kRecipe, {.what = "registration.subdivision.stability_points is out of range",
                                 .found = std::to_string(stability_points),
                                 .needed = "0 or more"});
}

std::vector<ContourMotion> subdivision_icp(const CadModel& cad, const ScanModel& scan, const EdgeData& data,
                                           const RigidMotion& rigid_scan_from_cad,
                                           const SubdivisionIcpOptions& options,
                                           const std::vector<ContourMotion>& start) {
  options.check();
  std::vector<ContourMotion> motions;
  for (std::size_t c = 0; c < cad.contours.size(); ++c) {
    if (options.match == SegmentMatch::kPaper)
      motions.push_back(paper_fit(cad.contours[c], scan, data, rigid_scan_from_cad, options));
    else
      motions.push_back(
          FootFit(cad, c, scan, data, rigid_scan_from_cad, options, start.empty() ? nullptr : &start[c])
              .run());
  }
  return motions;
}

}  // namespace arris
