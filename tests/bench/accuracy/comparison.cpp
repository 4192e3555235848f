#include "tests/bench/accuracy/case.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/rigid_fit.hpp"
#include "tests/bench/accuracy/pcl_icp.hpp"
#include "tests/support/one_run.hpp"

namespace arris::bench {
namespace {

constexpr double kPclReachMm = 20.0;
constexpr double kRawEdgeSpacings = 0.5;  // scatter of angle-gap edge points across the edge

using Points = std::vector<Eigen::Vector3d>;

template <class Carry>
Points carried(const Points& points, const Carry& carry) {
  Points result;
  for (const Eigen::Vector3d& p : points) result.push_back(carry(p));
  return result;
}

/// Of a path on the edge: the surface's normals there.
Points axes(const ToolPath& path) {
  Points normals;
  for (const PathPoint& row : path.points) normals.push_back(row.axis);
  return normals;
}

/// Median over the edge of the face points within 10 mm.
double points_near_edge(const synthetic::SyntheticScan& scan) {
  Points face;
  for (std::size_t i = 0; i < scan.points_mm.size(); ++i)
    if (scan.labels[i] == synthetic::Label::kSurface) face.push_back(scan.points_mm[i]);
  const synthetic::PointGrid grid(std::move(face), 10.0);
  std::vector<std::size_t> counts;
  for (std::size_t i = 0; i < scan.edge.size(); i += 10)
    counts.push_back(grid.within(scan.edge[i].true_mm, 10.0).size());
  std::nth_element(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2),
                   counts.end());
  return std::max(1.0, static_cast<double>(counts[counts.size() / 2]));
}

/// One scan with everything the rows of the table share.
class Comparison {
 public:
  /// Keeps references.
  Comparison(const BenchPart& part, const synthetic::SyntheticScan& scan) : part_(part), truth_scan_(scan) {
    const PointCloud cloud = scan.cloud();
    scan_.emplace(prepare(part, cloud));
    cad_from_local_ = scan.scan_from_cad.inverse() * Eigen::Translation3d(cloud.offset_mm);
    registration_ = register_part(part.cad, scan_->model, options());
  }

  Outcome run(bool every_method) {
    rigid_known();
    if (every_method && registration_.coarse.usable() && registration_.rigid.usable()) {
      rigid_icps();
      put_projection(kParabola, ProjectionKind::kParabola);
      put_projection(kHeightSpline, ProjectionKind::kSpline);
      subdivisions();
    }
    whole();
    return std::move(outcome_);
  }

 private:
  RegistrationOptions options() const { return calibrated_options(part_.recipe, part_.threads); }
  PathError error_of(const Points& path_local_mm) const {
    return part_.truth.error(
        part_.path_mm, carried(path_local_mm, [&](const Eigen::Vector3d& p) { return cad_from_local_ * p; }));
  }
  void put_rigid(Method method, const RigidMotion& local_from_cad) {
    outcome_.error[method] =
        error_of(carried(part_.path_mm, [&](const Eigen::Vector3d& p) { return local_from_cad * p; }));
  }
  /// By the motion of the nearest place on the nearest contour.
  void put_motions(Method method, const std::vector<ContourMotion>& motions) {
    outcome_.error[method] = error_of(carried(part_.path_mm, [&](const Eigen::Vector3d& p) {
      std::size_t contour = 0;
      CurveFoot foot = part_.cad.contours[0].nearest(p);
      for (std::size_t k = 1; k < motions.size(); ++k) {
        const CurveFoot other = part_.cad.contours[k].nearest(p);
        if (other.distance_mm >= foot.distance_mm) continue;
        foot = other;
        contour = k;
      }
      return motions[contour].at(foot.arc_mm) * p;
    }));
  }

  void rigid_known() {
    put_rigid(kNominal, cad_from_local_.inverse());
    Points nominal, deformed;
    for (const synthetic::EdgePoint& e : part_.truth.edge()) {
      nominal.push_back(e.nominal_mm);
      deformed.push_back(e.true_mm);
    }
    put_rigid(kBestRigid, cad_from_local_.inverse() * fit_rigid(nominal, deformed).to_from);
  }

  void rigid_icps() {
    const ScanModel& model = scan_->model;
    const RigidMotion& start = registration_.coarse.scan_from_cad;
    const Points contour = contour_points(part_.cad, std::max(0.5, model.spacing_mm));
    const NearestPoints tree(model.edge_mm);
    to_point_ = icp_point_to_point(contour, tree, model.edge_mm, start, options().rigid).scan_from_cad;
    put_rigid(kOursToPoint, to_point_);
    put_rigid(kOursToPlane, registration_.rigid.scan_from_cad);
    put_rigid(kPclToPoint, pcl_point_to_point(contour, model.edge_mm, start));
    put_rigid(kPclToPlane,
              pcl_point_to_plane(part_.surface_mm, model.points_mm, model.normals, start, kPclReachMm));
    for (const Method method : {kOursToPoint, kOursToPlane, kPclToPoint, kPclToPlane})
      if (outcome_.error[method]->mean_mm < outcome_.error[outcome_.rigid_winner]->mean_mm)
        outcome_.rigid_winner = method;
    outcome_.error[kRigidIcp] = outcome_.error[outcome_.rigid_winner];
  }

  /// The whole chain again with method projection: its own path, whether or not it would be refused.
  void put_projection(Method method, ProjectionKind kind) {
    RegistrationOptions chosen = options();
    chosen.method = RegistrationMethod::kProjection;
    chosen.projection.kind = kind;
    put_chain(method, chosen);
  }
  void put_chain(Method method, const RegistrationOptions& chosen) {
    const Registration found = register_part(part_.cad, scan_->model, chosen);
    if (!found.usable()) return;
    outcome_.error[method] = error_of(
        carried(part_.path_mm, [&](const Eigen::Vector3d& p) { return found.field->map(p).p_scan_mm; }));
  }

  void subdivisions() {
    const ScanModel& model = scan_->model;
    EdgeData raw;
    raw.points_mm = model.edge_mm;
    raw.sigma_across_mm = std::max(0.05, kRawEdgeSpacings * model.spacing_mm);
    const SubdivisionIcpOptions ours = options().subdivision;
    SubdivisionIcpOptions paper = ours;
    paper.match = SegmentMatch::kPaper;
    paper.stability = StabilityPoints::kPaper;
    put_motions(kPaper, subdivision_icp(part_.cad, model, raw, to_point_, paper));
    paper.stability = StabilityPoints::kNone;
    put_motions(kPaperNoSupport, subdivision_icp(part_.cad, model, raw, to_point_, paper));
    put_motions(kPlain, subdivision_icp(part_.cad, model, raw, registration_.rigid.scan_from_cad, ours));
    RegistrationOptions supported = options();
    supported.method = RegistrationMethod::kSubdivision;
    put_chain(kSupported, supported);
    supported.refine = RefineMethod::kCeres;
    put_chain(kRefined, supported);
  }

  void whole() {
    outcome_.reasons = registration_.refusals;
    if (!registration_.usable()) return;
    const Correction correction = correct_path(part_, registration_);
    outcome_.reasons.insert(outcome_.reasons.end(), correction.reasons.begin(), correction.reasons.end());
    Points path;
    for (const CorrectedPoint& row : correction.points) path.push_back(row.point.tip_mm);
    const PathError error = error_of(path);
    if (!outcome_.reasons.empty()) {
      outcome_.refused = error;
      return;
    }
    outcome_.error[kWhole] = error;
    outcome_.stated = stated_errors(part_.truth, *registration_.field, truth_scan_, cad_from_local_,
                                    {part_.path_mm, axes(part_.drawing.path)});
    outcome_.axis_p95_deg = axis_p95_deg(outcome_.stated);
  }

  const BenchPart& part_;
  const synthetic::SyntheticScan& truth_scan_;
  std::optional<PreparedScan> scan_;
  RigidMotion cad_from_local_ = RigidMotion::Identity();  // the true pose, undone
  RigidMotion to_point_ = RigidMotion::Identity();
  Registration registration_;
  Outcome outcome_;
};

}  // namespace

Outcome measure(const BenchPart& part, const BenchCase& bench_case, std::uint64_t seed) {
  const synthetic::SyntheticScan scan = sample_scan(part.fe, bench_case.scan, seed);
  Outcome outcome = Comparison(part, scan).run(bench_case.every_method);
  outcome.edge_limit_mm = scan.edge_limit_mm();
  outcome.surface_limit_mm = bench_case.scan.noise_sigma_mm / std::sqrt(points_near_edge(scan));
  outcome.points = scan.points_mm.size();
  return outcome;
}

}  // namespace arris::bench
