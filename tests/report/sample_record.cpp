#include "sample_record.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "report/statistics.hpp"
#include "report/verdict.hpp"

namespace arris::test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kHoleRadius = 62.0, kHalfLength = 160.0, kHalfWidth = 110.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Shape of the bent plate above the drawing, after the rigid alignment.
double bend_mm(double x, double y) {
  return 4.4 * std::sin(x / 62.0) + 2.6 * (y / kHalfWidth) * (x / kHalfLength);
}

RigidMotion pose() {
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() =
      (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  motion.translation() = Eigen::Vector3d(10120.0, -35.0, 410.0);
  return motion;
}

TriangleMesh plate_mesh() {
  TriangleMesh mesh;
  constexpr int kAround = 96, kRings = 6;
  for (int ring = 0; ring <= kRings; ++ring)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * kPi * i / kAround, c = std::cos(angle), s = std::sin(angle);
      const double outer =
          std::min(kHalfLength / std::max(std::abs(c), 1e-9), kHalfWidth / std::max(std::abs(s), 1e-9));
      const double radius = kHoleRadius + (outer - kHoleRadius) * ring / kRings;
      mesh.vertices_mm.emplace_back(radius * c, radius * s, 0.0);
    }
  for (int ring = 0; ring < kRings; ++ring)
    for (int i = 0; i < kAround; ++i) {
      const int a = ring * kAround + i, b = ring * kAround + (i + 1) % kAround, c = a + kAround,
                d = b + kAround;
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
  return mesh;
}

void add_scan(RunRecord& record) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(-kHalfLength, kHalfLength), aside(-kHalfWidth, kHalfWidth);
  std::normal_distribution<double> noise(0.0, 0.05);
  record.cloud.offset_mm = Eigen::Vector3d(10000.0, 0.0, 0.0);
  const RigidMotion scan_from_cad = record.alignment.scan_from_cad;
  const auto add = [&](const Eigen::Vector3d& p_cad, double deviation) {
    record.cloud.points_mm.push_back((scan_from_cad * p_cad - record.cloud.offset_mm).cast<float>());
    record.deviation_mm.push_back(static_cast<float>(deviation));
  };
  while (record.cloud.size() < 9000) {
    const double x = along(random), y = aside(random);
    const bool in_hole = std::hypot(x, y) < kHoleRadius + 0.3;
    const bool missing = std::hypot(x - 105.0, y + 60.0) < 24.0;
    if (in_hole || missing) continue;
    const double d = bend_mm(x, y) + noise(random);
    add({x, y, d}, d);
  }
  for (int i = 0; i < 25; ++i) add({along(random), aside(random), 14.0 + noise(random)}, kNan);
}

Contour circle(double radius, bool bent, const RigidMotion& to_scan, const Eigen::Vector3d& offset) {
  Contour contour;
  contour.id = 1;
  contour.closed = true;
  contour.source = "boundary";
  for (int i = 0; i < 180; ++i) {
    const double angle = 2.0 * kPi * i / 180, x = radius * std::cos(angle), y = radius * std::sin(angle);
    const Eigen::Vector3d p(x, y, bent ? bend_mm(x, y) : 0.0);
    contour.points_mm.push_back(bent ? Eigen::Vector3d(to_scan * p - offset) : p);
    contour.normals.push_back(bent ? Eigen::Vector3d(to_scan.linear() * Eigen::Vector3d::UnitZ())
                                   : Eigen::Vector3d::UnitZ());
  }
  return contour;
}

void add_path(RunRecord& record) {
  record.has_toolpath = true;
  record.nominal_path.source = "porthole_path.csv";
  const RigidMotion& motion = record.alignment.scan_from_cad;
  constexpr int kRows = 240;
  for (int i = -8; i < kRows + 8; ++i) {
    const double angle = 2.0 * kPi * std::clamp(i, 0, kRows - 1) / kRows;
    const bool air = i < 0 || i >= kRows;
    const double lift = i < 0 ? -5.0 * i : (i >= kRows ? 5.0 * (i - kRows + 1) : 0.0);
    PathPoint nominal;
    nominal.tip_mm = {(kHoleRadius - 1.5) * std::cos(angle), (kHoleRadius - 1.5) * std::sin(angle), lift};
    record.nominal_path.points.push_back(nominal);
    CorrectedPoint corrected;
    const double d = bend_mm(nominal.tip_mm.x(), nominal.tip_mm.y());
    corrected.point = nominal;
    corrected.point.tip_mm = motion * (nominal.tip_mm + Eigen::Vector3d(0.3 * std::cos(2 * angle), 0.0, d)) -
                             record.cloud.offset_mm;
    corrected.point.axis =
        motion.linear() * Eigen::Vector3d(-0.07 * std::cos(nominal.tip_mm.x() / 62.0), 0.0, 1.0).normalized();
    corrected.shift_normal_mm = d;
    corrected.shift_across_mm = 0.3 * std::cos(2 * angle) * std::cos(angle);
    corrected.shift_mm = std::hypot(d, 0.3 * std::cos(2 * angle));
    corrected.sd_normal_mm = 0.012;
    corrected.sd_across_mm = 0.08;
    corrected.tilt_rad = 0.07;
    corrected.air_move = air;
    corrected.from_data = !air && !(i > 96 && i < 112);
    record.correction.points.push_back(corrected);
  }
}

void add_errors(RunRecord& record) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 0.06);
  ContourError error;
  error.contour = "contour 1";
  for (int i = 0; i < 180; ++i) {
    const double angle = 2.0 * kPi * i / 180, x = kHoleRadius * std::cos(angle),
                 y = kHoleRadius * std::sin(angle);
    const bool seen = !(i > 70 && i < 85) && i != 20;
    error.arc_mm.push_back(kHoleRadius * angle);
    error.rigid_mm.push_back(seen ? std::hypot(bend_mm(x, y), 0.3) + std::abs(noise(random)) : kNan);
    error.across_mm.push_back(seen ? 0.1 * std::sin(3 * angle) + noise(random) : kNan);
    error.normal_mm.push_back(seen ? noise(random) * 0.4 : kNan);
  }
  record.contour_errors.push_back(error);
}

void add_segments(RunRecord& record) {
  for (int i = 0; i < 6; ++i) {
    RunRecord::SegmentSummary segment;
    segment.contour = 1;
    segment.from_mm = 2.0 * kPi * kHoleRadius * i / 6.0;
    segment.to_mm = segment.from_mm + 2.0 * kPi * kHoleRadius / 6.0 * 1.3;
    segment.rms_mm = 0.11 + 0.01 * i;
    segment.iterations = 9 + i;
    segment.pairs = 210 - 7 * i;
    segment.from_data = i != 2;
    segment.stop = i == 2 ? "too few pairs" : "change below stop_change";
    record.segments.push_back(segment);
  }
  record.refinement = {
      true,
      true,
      "converged after 2 rounds; seams jump by 0.031 mm rms, before 0.112 mm",
      {{3.0, 191.46, 162.55, 5, "iteration limit", 0.205}, {3.0, 163.1, 163.0, 1, "converged", 0.0}},
      {{1, 0.0, 52.4, 48, 0.061, 0.084}},
      {{1, 52.4, 0.112, 0.031, 0.0295, 0.0231}}};
  record.stage_residual_mm = {{"matching loops", 3.9}, {"rigid", 3.12}, {"subdivision", 0.14}};
}

void judge(RunRecord& record) {
  record.surface_profile_mm = 1.0;
  record.contour_profile_mm = 0.6;
  record.max_correction_mm = 20.0;
  record.as_scanned = report::deviation_statistics(std::span<const float>(record.deviation_mm), 1.0);
  record.judged_as_scanned =
      report::not_judged(report::max_abs_mm(record.as_scanned), 1.0, "as clamped, not judged");
  if (record.contour_errors.empty()) return;
  record.pulled_back =
      report::deviation_statistics(std::span<const double>(record.contour_errors[0].across_mm), 0.6);
  record.judged_pulled_back = report::judge_profile(report::max_abs_mm(record.pulled_back), 0.6, 0.12,
                                                    "found edge against the nominal edge");
}

RunRecord header() {
  RunRecord record;
  record.part_number = "A-1042 <rev C> & \"co\"";
  record.version = "arris 0.1.0";
  const std::string hash(64, 'a');
  record.inputs = {{"scan", "part7.ply", hash},
                   {"cad", "porthole.stl", std::string(64, 'b')},
                   {"path", "porthole_path.csv", hash},
                   {"recipe", "porthole.toml", hash},
                   {"cell", "cell.toml", hash}};
  record.result_hash = "3f1c09d2a4b75e6688990a1b2c3d4e5f60718293a4b5c6d7e8f9a0b1c2d3e4f5";
  record.report_time = "2025-03-04T09:12:33Z";
  record.state = "clamped";
  record.role = "edge";
  record.method = "subdivision";
  record.points_read = 9064;
  record.points_nonfinite = 3;
  record.points_outlier = 36;
  record.points_used = 9025;
  record.spacing_mm = 2.5;
  record.noise_sigma_mm = 0.05;
  record.alignment.scan_from_cad = pose();
  return record;
}

}  // namespace

RunRecord sample_record() {
  RunRecord record = header();
  record.notes = {"loop 2 of the scan was dropped: 31 mm long, no CAD loop of that length",
                  "one hole of the scan mesh was filled by the scanner: 214 triangles"};
  AlignmentSummary& alignment = record.alignment;
  alignment.rms_mm = 3.12;
  alignment.overlap_ratio = 0.964;
  alignment.pairs = 3120;
  alignment.runner_up_ratio = 0.31;
  alignment.side_decided_by = "seen_from";
  alignment.start = "matching loops";
  alignment.free_directions = {"turn about the hole's axis"};
  alignment.covariance_6x6.assign(36, 0.0);
  for (std::size_t i = 0; i < 6; ++i) alignment.covariance_6x6[7 * i] = i < 3 ? 1.234567e-9 : 2.5e-5;
  record.mean_strain_ratio = 0.0004;
  record.edge_limit_mm = 0.31;
  record.surface_limit_mm = 0.009;
  record.cad = plate_mesh();
  record.cad_contours = {circle(kHoleRadius, false, pose(), Eigen::Vector3d::Zero())};
  add_scan(record);
  record.found_contours = {circle(kHoleRadius, true, pose(), record.cloud.offset_mm)};
  record.dropped_contours = {record.found_contours[0]};
  for (Eigen::Vector3d& p : record.dropped_contours[0].points_mm)
    p = pose() * Eigen::Vector3d(0.37 * (pose().inverse() * (p + record.cloud.offset_mm)) +
                                 Eigen::Vector3d(105, -60, 0)) -
        record.cloud.offset_mm;
  add_segments(record);
  add_path(record);
  add_errors(record);
  judge(record);
  record.program_written = true;
  record.program_note = "program.mod, program_dry.mod";
  return record;
}

RunRecord refused_record() {
  RunRecord record = sample_record();
  record.max_correction_mm = 3.0;
  record.refusals = {
      "the correction is 6.60 mm at row 41, the recipe allows max_correction_mm = 3.00 (rows 22 to 78)",
      "alignment: \"overlap\" 0.31, at least 0.60 needed"};
  record.correction.reasons = {record.refusals[0]};
  record.program_written = false;
  record.program_note = "refused";
  return record;
}

RunRecord targets_record(bool refused) {
  RunRecord record = sample_record();
  record.frame_max_residual_mm = 0.2;
  TargetFrame frame;
  for (const char* id : {"A", "B <1>", "C", "D"}) {
    TargetSighting sighting;
    sighting.target = {id, TargetKind::kSphere, Eigen::Vector3d(1200.0, 300.0, 80.0), 38.1, 0.02};
    sighting.found = std::string(id) != "D";
    sighting.residual_mm = 0.031;
    sighting.sd_mm = 0.004;
    sighting.points = 1234;
    sighting.scan_mm = Eigen::Vector3d(4.0, 5.0, 6.0);
    frame.targets.push_back(sighting);
  }
  frame.robot_from_scan.translation() = Eigen::Vector3d(850.0, 0.0, 400.0);
  frame.covariance.diagonal() << 1e-10, 4e-10, 9e-10, 1e-4, 4e-4, 9e-4;
  frame.pivot_mm = Eigen::Vector3d(1100.0, 200.0, 50.0);
  frame.extra = 2;
  if (refused) {
    frame.targets[1].residual_mm = 0.74;
    frame.targets[1].over_limit = true;
    frame.reasons = {"fixture target B <1> is 1.02 mm from its place as the others show it (at most 0.20)"};
    record.program_written = false;
    record.program_note = "no robot program was written: " + frame.reasons.front();
  } else {
    record.robot_sd.assign(record.correction.points.size(), {0.021, 0.052, std::nan(""), 0.013});
  }
  record.frame = frame;
  return record;
}

RunRecord barely_started_record() {
  RunRecord record = header();
  add_scan(record);
  record.deviation_mm.clear();
  record.has_toolpath = true;
  record.alignment.scan_from_cad = RigidMotion::Identity();
  record.refusals = {"a flat part fits upside down as well, and nothing says which side was scanned"};
  record.program_note = "refused";
  return record;
}

}  // namespace arris::test
