#include "toolpath/correct.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/geometry/nearest.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"
#include "toolpath/formats/number.hpp"
#include "toolpath/limits.hpp"

namespace arris {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNoAnchor = std::numeric_limits<double>::infinity();

void check_rows(const ToolPath& nominal) {
  if (nominal.points.empty())
    throw Error(Fault::kInput, ErrorText{"the tool path is empty", nominal.source, "0 rows", "at least 1 row",
                                         "export the path again"});
  for (std::size_t i = 0; i < nominal.points.size(); ++i) {
    const PathPoint& row = nominal.points[i];
    const std::string where = nominal.source + ", row " + std::to_string(i + 1);
    if (!row.tip_mm.allFinite() || !row.axis.allFinite())
      throw Error(Fault::kInput,
                  ErrorText{"a tool path row is not finite", where, "a value that is no finite number",
                            "six finite numbers", "export the path again"});
    if (std::abs(row.axis.norm() - 1.0) > 1e-6)
      throw Error(Fault::kInput,
                  ErrorText{"a tool axis is not a unit vector", where,
                            "length " + fixed_text(row.axis.norm(), 6), "length 1", "export the path again"});
  }
}

/// Feet on the CAD's face. For a path on the far face the normal is turned to leave that face, and the
/// distance is counted from the end of the fibre through the part.
std::vector<SurfacePoint> feet_of(const ToolPath& nominal, const SurfaceQuery& cad,
                                  const CorrectOptions& options) {
  std::vector<SurfacePoint> feet(nominal.points.size());
  parallel_for(feet.size(), 256, options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3d& tip_mm = nominal.points[i].tip_mm;
      SurfacePoint& foot = feet[i] = cad.closest(tip_mm);
      if (options.far_face_mm == 0.0 || foot.triangle < 0) continue;
      foot.normal = -foot.normal;
      foot.distance_mm = (tip_mm - foot.foot_mm - options.far_face_mm * foot.normal).norm();
    }
  });
  return feet;
}

// Throws unless some row is within reach: a path in another frame or unit must not be carried anywhere.
void check_belongs(const ToolPath& nominal, const std::vector<SurfacePoint>& feet, double path_reach_mm) {
  const auto nearer = [](const SurfacePoint& a, const SurfacePoint& b) {
    return a.distance_mm < b.distance_mm;
  };
  const auto [near, far] = std::minmax_element(feet.begin(), feet.end(), nearer);
  if (near->triangle < 0)
    throw Error(Fault::kInput,
                ErrorText{"the path belongs nowhere on the CAD", nominal.source, "a CAD without a surface",
                          "at least one triangle", "export the CAD again"});
  if (near->distance_mm <= path_reach_mm) return;
  throw Error(Fault::kInput,
              ErrorText{"the path belongs nowhere on the CAD", nominal.source,
                        "row " + std::to_string(near - feet.begin() + 1) + ", the nearest, is " +
                            fixed_text(near->distance_mm, 1) + " mm from the CAD, the farthest " +
                            fixed_text(far->distance_mm, 1) + " mm",
                        "a row within " + fixed_text(path_reach_mm, 1) + " mm (path_reach_mm)",
                        "export the path in millimetres and in the CAD's own frame"});
}

std::vector<SurfacePoint> checked_feet(const ToolPath& nominal, const SurfaceQuery& cad,
                                       const CorrectOptions& options) {
  check_rows(nominal);
  std::vector<SurfacePoint> feet = feet_of(nominal, cad, options);
  check_belongs(nominal, feet, options.path_reach_mm);
  return feet;
}

// Each air row takes the row on the part that is nearest along its polyline, round the seam when it is
// closed.
void anchor_range(const PathRange& range, const std::vector<double>& arc_mm, double closing_mm,
                  std::vector<CorrectedPoint>& points) {
  const std::size_t n = range.size();
  std::vector<double> gap_mm(n, kNoAnchor);
  for (std::size_t i = 0; i < n; ++i)
    if (!points[range.begin + i].air_move) gap_mm[i] = 0.0;
  const double length_mm = arc_mm[range.end - 1] - arc_mm[range.begin];
  const auto step_mm = [&](std::size_t i, std::size_t j) {
    return i + 1 == j || j + 1 == i ? std::abs(arc_mm[range.begin + j] - arc_mm[range.begin + i])
                                    : closing_mm;
  };
  const auto relax = [&](std::size_t from, std::size_t to) {
    const double reached_mm = gap_mm[from] + step_mm(from, to);
    if (reached_mm >= gap_mm[to]) return;
    gap_mm[to] = reached_mm;
    points[range.begin + to].anchor = points[range.begin + from].anchor;
  };
  const int rounds = range.closed && n > 2 && length_mm > 0.0 ? 2 : 1;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 1; i < n; ++i) relax(i - 1, i);
    if (rounds == 2) relax(n - 1, 0);
    for (std::size_t i = n - 1; i > 0; --i) relax(i, i - 1);
    if (rounds == 2) relax(0, n - 1);
  }
}

// Polylines that never touch the part follow the nearest row of another one, in space.
std::size_t anchor_orphans(const ToolPath& nominal, std::vector<CorrectedPoint>& points) {
  std::vector<Vector3d> touching_mm;
  std::vector<std::ptrdiff_t> rows;
  std::size_t orphans = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    orphans += points[i].anchor < 0 ? 1 : 0;
    if (points[i].air_move) continue;
    touching_mm.push_back(nominal.points[i].tip_mm);
    rows.push_back(static_cast<std::ptrdiff_t>(i));
  }
  if (orphans == 0) return 0;
  const NearestPoints tree(touching_mm);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].anchor < 0)
      points[i].anchor = rows[static_cast<std::size_t>(tree.nearest(nominal.points[i].tip_mm).index)];
  return orphans;
}

void anchor_rows(const ToolPath& nominal, const std::vector<SurfacePoint>& feet, double path_reach_mm,
                 Correction& correction) {
  std::vector<CorrectedPoint>& points = correction.points;
  std::size_t air = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].foot_distance_mm = feet[i].distance_mm;
    points[i].air_move = feet[i].distance_mm > path_reach_mm;
    if (!points[i].air_move) points[i].anchor = static_cast<std::ptrdiff_t>(i);
    air += points[i].air_move ? 1 : 0;
  }
  if (air == 0) return;
  const std::vector<double> arc_mm = arc_along_mm(nominal);
  for (const PathRange& range : polylines(nominal)) {
    const double closing_mm =
        (nominal.points[range.begin].tip_mm - nominal.points[range.end - 1].tip_mm).norm();
    anchor_range(range, arc_mm, closing_mm, points);
  }
  const std::size_t orphans = anchor_orphans(nominal, points);
  correction.notes.push_back(std::to_string(air) + " of " + std::to_string(points.size()) +
                             " rows are air moves (farther than " + fixed_text(path_reach_mm, 1) +
                             " mm from the CAD) and follow the nearest row on the part");
  if (orphans > 0)
    correction.notes.push_back(std::to_string(orphans) +
                               " of them belong to polylines that never reach the part");
}

void check_rotation(const Matrix3d& rotation, const std::string& method) {
  const double departure = (rotation.transpose() * rotation - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(departure < 1e-6) || rotation.determinant() < 0.0)
    throw Error(Fault::kBug, "the field '" + method + "' gave a rotation that is none");
}

// sd of the tip along `u`: the foot's own and the axis's, over the lever from foot to tip. 0 stays: unknown.
double sd_at_tip_mm(double sd_foot_mm, double sd_axis_rad, const Vector3d& lever_mm, const Vector3d& u) {
  return sd_foot_mm > 0.0 ? std::hypot(sd_foot_mm, sd_axis_rad * lever_mm.cross(u).norm()) : 0.0;
}

// The nominal surface frame at a foot: normal, across (right of the travel), along; columns in this order.
Matrix3d surface_frame(const Vector3d& normal, const Vector3d& travel) {
  const Vector3d in_surface = travel - travel.dot(normal) * normal;
  Matrix3d frame;
  frame.col(0) = normal;
  frame.col(2) =
      in_surface.norm() > 1e-6 ? Vector3d(in_surface.normalized()) : Vector3d(frame_with_z(normal).col(0));
  frame.col(1) = frame.col(2).cross(normal);
  return frame;
}

struct Carrier {
  const ToolPath& nominal;
  const std::vector<SurfacePoint>& feet;
  const std::vector<MappedPoint>& mapped;
  const std::vector<Vector3d>& travel;
  const RigidMotion& scan_from_cad;

  void carry(std::size_t i, CorrectedPoint& out) const {
    const auto anchor = static_cast<std::size_t>(out.anchor);
    const MappedPoint& place = mapped[anchor];
    const PathPoint& row = nominal.points[i];
    const Vector3d tip_rigid_mm = scan_from_cad * row.tip_mm;
    const Vector3d axis_rigid = scan_from_cad.linear() * row.axis;
    out.point = row;
    out.point.tip_mm = tip_rigid_mm;
    out.point.axis = axis_rigid.normalized();
    out.has_place = usable(place);
    if (!out.has_place) return;
    const Vector3d lever_mm = row.tip_mm - feet[anchor].foot_mm;
    out.point.tip_mm = place.p_scan_mm + place.rotation_scan_from_cad * lever_mm;
    out.point.axis = (place.rotation_scan_from_cad * row.axis).normalized();
    const Vector3d shift_mm = out.point.tip_mm - tip_rigid_mm;
    const Matrix3d frame = surface_frame(feet[anchor].normal, travel[i]);
    const Vector3d parts_mm = (scan_from_cad.linear() * frame).transpose() * shift_mm;
    out.shift_mm = shift_mm.norm();
    out.shift_normal_mm = parts_mm.x();
    out.shift_across_mm = parts_mm.y();
    out.tilt_rad = std::atan2(out.point.axis.cross(axis_rigid).norm(), out.point.axis.dot(axis_rigid));
    out.sd_normal_mm = sd_at_tip_mm(place.sd_mm.x(), place.sd_axis_rad, lever_mm, frame.col(0));
    out.sd_across_mm = sd_at_tip_mm(place.sd_mm.y(), place.sd_axis_rad, lever_mm, frame.col(1));
    out.sd_along_mm = sd_at_tip_mm(place.sd_mm.z(), place.sd_axis_rad, lever_mm, frame.col(2));
    out.sd_axis_rad = place.sd_axis_rad;
    out.from_data = place.from_data;
  }

  static bool usable(const MappedPoint& place) {
    return place.in_domain && place.p_scan_mm.allFinite() && place.rotation_scan_from_cad.allFinite() &&
           place.sd_mm.allFinite() && std::isfinite(place.sd_axis_rad);
  }
};

std::vector<MappedPoint> map_feet(const std::vector<SurfacePoint>& feet,
                                  const std::vector<CorrectedPoint>& points, const DeformationField& field,
                                  int threads) {
  std::vector<MappedPoint> mapped(feet.size());
  parallel_for(feet.size(), 256, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (points[i].air_move) continue;
      mapped[i] = field.map(feet[i].foot_mm);
      if (Carrier::usable(mapped[i])) check_rotation(mapped[i].rotation_scan_from_cad, field.method());
    }
  });
  return mapped;
}

std::vector<std::string> rows_without_place(const ToolPath& nominal, const Correction& correction,
                                            const std::vector<MappedPoint>& mapped) {
  const auto listed = [&](bool in_domain, const std::string& text) {
    return list_rows(
        nominal,
        [&](std::size_t i) {
          const MappedPoint& place = mapped[i];
          const CorrectedPoint& row = correction.points[i];
          const bool faulty = !row.air_move && !row.has_place && place.in_domain == in_domain;
          return faulty ? std::optional<double>(0.0) : std::optional<double>();
        },
        [&](double) { return text; });
  };
  std::vector<std::string> reasons =
      listed(false, "outside the domain of the deformation field, which says nothing there");
  for (std::string& reason : listed(true, "the deformation field gives no finite place"))
    reasons.push_back(std::move(reason));
  return reasons;
}

}  // namespace

void CorrectOptions::check() const {
  const auto need = [](bool holds, const char* field, double value, const char* bound) {
    if (!holds)
      throw Error(Fault::kRecipe, std::string(field) + " = " + std::to_string(value) + ", need " + bound);
  };
  need(max_correction_mm > 0.0 && std::isfinite(max_correction_mm), "max_correction_mm", max_correction_mm,
       "> 0");
  need(max_tilt_rad > 0.0 && max_tilt_rad <= 3.1415927, "max_tilt_rad", max_tilt_rad, "in (0, pi]");
  need(max_step_ratio >= 1.0 && std::isfinite(max_step_ratio), "max_step_ratio", max_step_ratio, ">= 1");
  need(step_slack_mm >= 0.0 && std::isfinite(step_slack_mm), "step_slack_mm", step_slack_mm, ">= 0");
  need(far_face_mm >= 0.0 && std::isfinite(far_face_mm), "far_face_mm", far_face_mm, ">= 0");
  need(path_reach_mm > 0.0 && std::isfinite(path_reach_mm), "path_reach_mm", path_reach_mm, "> 0");
}

void check_path_belongs(const ToolPath& nominal, const SurfaceQuery& cad, const CorrectOptions& options) {
  (void)checked_feet(nominal, cad, options);
}

Correction correct(const ToolPath& nominal, const SurfaceQuery& cad, const DeformationField& field,
                   const RigidMotion& scan_from_cad, const CorrectOptions& options) {
  options.check();
  const std::vector<SurfacePoint> feet = checked_feet(nominal, cad, options);

  Correction correction;
  correction.source = nominal.source;
  correction.points.resize(nominal.points.size());
  anchor_rows(nominal, feet, options.path_reach_mm, correction);

  const std::vector<MappedPoint> mapped = map_feet(feet, correction.points, field, options.threads);
  const std::vector<Vector3d> travel = directions(nominal);
  const Carrier carrier{nominal, feet, mapped, travel, scan_from_cad};
  std::vector<Matrix3d> rotations;
  for (std::size_t i = 0; i < nominal.points.size(); ++i) {
    carrier.carry(i, correction.points[i]);
    const MappedPoint& place = mapped[static_cast<std::size_t>(correction.points[i].anchor)];
    rotations.push_back(Carrier::usable(place) ? place.rotation_scan_from_cad
                                               : Matrix3d(scan_from_cad.linear()));
  }
  correction.reasons = rows_without_place(nominal, correction, mapped);
  for (std::string& reason : limits_broken(nominal, correction, rotations, options))
    correction.reasons.push_back(std::move(reason));
  return correction;
}

}  // namespace arris
