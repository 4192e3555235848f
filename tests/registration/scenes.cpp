#include "tests/registration/scenes.hpp"

#include <algorithm>
#include <filesystem>

#include "acquisition/clean.hpp"

namespace arris::scenes {

CadModel cad_of(const synthetic::Part& part, const std::vector<int>& contours, double edge_mm) {
  std::vector<Contour> accepted;
  std::vector<Contour> others;
  for (int c = 0; c < part.contour_count(); ++c) {
    const bool follow = std::find(contours.begin(), contours.end(), c) != contours.end();
    (follow ? accepted : others).push_back(part.nominal_contour(c, 1.0));
  }
  return prepare_cad(part.cad_mesh(edge_mm), accepted, others);
}

synthetic::PlateShape bent_plate_with_circle() {
  synthetic::PlateShape shape = synthetic::plate_with_circle(100.0);
  shape.bend_curvature_per_mm = 1.0 / 1500.0;
  shape.bend_axis_rad = 0.4;
  shape.twist_rad_per_mm = 2e-4;
  return shape;
}

synthetic::FePart fe(const std::string& name) {
  return synthetic::load_fe_part(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures" / "fe" / name);
}

Trial changed_trial(const synthetic::Part& part, const synthetic::ScanOptions& options, std::uint64_t seed,
                    const std::function<void(Eigen::Vector3f&, Eigen::Vector3f&)>& change) {
  const synthetic::SyntheticScan truth = synthetic::sample_scan(part, options, seed);
  Scan scan;
  scan.cloud = clean(truth.cloud(), {}).cloud;
  Eigen::Vector3f unused = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    change(scan.cloud.points_mm[i], scan.cloud.has_normals() ? scan.cloud.normals[i] : unused);
  Trial trial{prepare_scan(scan, {}).model, truth.scan_from_cad, truth.true_curve_mm(),
              truth.edge_limit_mm()};
  trial.scan_from_cad.pretranslate(-scan.cloud.offset_mm);
  for (Eigen::Vector3d& p : trial.true_curve_mm) p -= scan.cloud.offset_mm;
  return trial;
}

Trial trial_of(const synthetic::Part& part, const synthetic::ScanOptions& options, std::uint64_t seed) {
  return changed_trial(part, options, seed, [](Eigen::Vector3f&, Eigen::Vector3f&) {});
}

Trial ideal_trial(const synthetic::Part& part, const IdealOptions& options, std::uint64_t seed) {
  synthetic::ScanOptions sampling;
  sampling.points = static_cast<std::int64_t>(options.points);
  sampling.noise_sigma_mm = options.noise_sigma_mm;
  sampling.band_mm = options.band_mm;
  sampling.random_pose = false;
  const synthetic::SyntheticScan truth = synthetic::sample_scan(part, sampling, seed);
  synthetic::Random random(seed + 1000);
  std::vector<Eigen::Vector3d> edge_mm, edge_normals;
  for (const synthetic::EdgePoint& p : part.edge(0, options.edge_step_mm)) {
    const Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
    edge_mm.push_back(p.true_mm + options.noise_sigma_mm * noise);
    edge_normals.push_back(p.true_normal);
  }
  Contour loop;
  loop.closed = true;
  loop.points_mm = edge_mm;
  loop.normals = edge_normals;
  ScanModel scan{truth.points_mm, truth.normals,    NearestPoints(truth.points_mm), {loop},         edge_mm,
                 edge_normals,    truth.spacing_mm, options.noise_sigma_mm,         SideKnown::kYes};
  return {std::move(scan), truth.scan_from_cad, truth.true_curve_mm(), truth.edge_limit_mm()};
}

ScanModel moved(const ScanModel& scan, const RigidMotion& motion) {
  const auto carry = [&](std::vector<Eigen::Vector3d> points) {
    for (Eigen::Vector3d& p : points) p = motion * p;
    return points;
  };
  const auto turn = [&](std::vector<Eigen::Vector3d> normals) {
    for (Eigen::Vector3d& n : normals) n = motion.linear() * n;
    return normals;
  };
  std::vector<Eigen::Vector3d> points_mm = carry(scan.points_mm);
  NearestPoints tree(points_mm);
  ScanModel out{std::move(points_mm), turn(scan.normals),  std::move(tree),
                scan.loops,           carry(scan.edge_mm), turn(scan.edge_normals),
                scan.spacing_mm,      scan.noise_sigma_mm, scan.side};
  for (Contour& loop : out.loops) {
    loop.points_mm = carry(loop.points_mm);
    loop.normals = turn(loop.normals);
  }
  return out;
}

ContourMotion rigid_along(const Curve& curve, const RigidMotion& scan_from_cad) {
  const Subdivision subdivision(curve, {});
  SegmentFit fit;
  fit.scan_from_cad = scan_from_cad;
  return {curve, subdivision, std::vector<SegmentFit>(subdivision.segments().size(), fit)};
}

double distance_mm(const Eigen::Vector3d& p_mm, const std::vector<Eigen::Vector3d>& loop_mm) {
  double best = 1e300;
  for (std::size_t i = 0; i < loop_mm.size(); ++i) {
    const Eigen::Vector3d &a = loop_mm[i], &b = loop_mm[(i + 1) % loop_mm.size()];
    const double t = std::clamp((p_mm - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    best = std::min(best, (p_mm - a - t * (b - a)).squaredNorm());
  }
  return std::sqrt(best);
}

Distance distance_between(const std::vector<Eigen::Vector3d>& points_mm,
                          const std::vector<Eigen::Vector3d>& loop_mm) {
  Distance out;
  for (const Eigen::Vector3d& p : points_mm) {
    const double d = distance_mm(p, loop_mm);
    out.mean_mm += d / static_cast<double>(points_mm.size());
    out.max_mm = std::max(out.max_mm, d);
  }
  return out;
}

std::vector<Eigen::Vector3d> carried(
    const Curve& curve, double step_mm,
    const std::function<Eigen::Vector3d(double, const Eigen::Vector3d&)>& carry) {
  std::vector<Eigen::Vector3d> out;
  for (double s_mm = 0.0; s_mm < curve.length_mm(); s_mm += step_mm)
    out.push_back(carry(s_mm, curve.point_mm(s_mm)));
  return out;
}

RigidMotion disturbance(synthetic::Random& random, const Eigen::Vector3d& about_mm, double angle_rad,
                        double shift_mm) {
  RigidMotion out = RigidMotion::Identity();
  out.linear() = Eigen::AngleAxisd(angle_rad, random.direction()).toRotationMatrix();
  out.translation() = about_mm - out.linear() * about_mm + shift_mm * random.direction();
  return out;
}

}  // namespace arris::scenes
