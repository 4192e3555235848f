#include "tests/support/scan_trial.hpp"

#include <algorithm>

#include "acquisition/geometry/rigid_fit.hpp"
#include "cli/recipe_options.hpp"

namespace arris::bench {
namespace {

constexpr double kRawEdgeSpacings = 0.5;  // scatter of angle-gap edge points across the edge
constexpr double kLeastStepMm = 0.5;      // between the contour points of the paper's ICP

}  // namespace

ScanTrial::ScanTrial(const BenchPart& part, const synthetic::SyntheticScan& scan) : part_(part), scan_(scan) {
  const PointCloud cloud = scan.cloud();
  prepared_ = prepare(part, cloud);
  cad_from_local_ = scan.scan_from_cad.inverse() * Eigen::Translation3d(cloud.offset_mm);
  RegistrationOptions rigid = options();
  rigid.method = RegistrationMethod::kRigid;
  rigid_ = register_part(part.cad, prepared_.model, rigid);
}

RegistrationOptions ScanTrial::options() const {
  return registration_options(part_.recipe, part_.threads);
}

RigidMotion ScanTrial::paper_rigid() const {
  const std::vector<Eigen::Vector3d> contour =
      contour_points(part_.cad, std::max(kLeastStepMm, model().spacing_mm));
  const NearestPoints tree(model().edge_mm);
  return icp_point_to_point(contour, tree, model().edge_mm, rigid_.coarse.scan_from_cad, options().rigid)
      .scan_from_cad;
}

EdgeData ScanTrial::raw_edge() const {
  EdgeData edge;
  edge.points_mm = model().edge_mm;
  edge.sigma_across_mm = std::max(0.05, kRawEdgeSpacings * model().spacing_mm);
  return edge;
}

std::optional<CarriedPath> ScanTrial::chain(const RegistrationOptions& options) {
  const Registration found = register_part(part_.cad, prepared_.model, options);
  if (!found.usable()) return std::nullopt;
  const Correction correction = correct_path(part_, found);
  CarriedPath path;
  for (const CorrectedPoint& row : correction.points) {
    path.tips_mm.push_back(cad_from_local_ * row.point.tip_mm);
    path.axes.push_back(cad_from_local_.linear() * row.point.axis);
  }
  path.reasons = found.refusals;
  path.reasons.insert(path.reasons.end(), correction.reasons.begin(), correction.reasons.end());
  return path;
}

CarriedPath ScanTrial::carried(const RigidMotion& local_from_cad) const {
  const RigidMotion there_and_back = cad_from_local_ * local_from_cad;
  CarriedPath path;
  for (const PathPoint& row : part_.drawing.path.points) {
    path.tips_mm.push_back(there_and_back * row.tip_mm);
    path.axes.push_back(there_and_back.linear() * row.axis);
  }
  return path;
}

CarriedPath ScanTrial::carried(const ContourMotion& motion) const {
  CarriedPath path;
  for (const PathPoint& row : part_.drawing.path.points) {
    const RigidMotion there_and_back =
        cad_from_local_ * motion.at(part_.cad.contours[0].nearest(row.tip_mm).arc_mm);
    path.tips_mm.push_back(there_and_back * row.tip_mm);
    path.axes.push_back(there_and_back.linear() * row.axis);
  }
  return path;
}

CarriedPath ScanTrial::nominal() const {
  return carried(cad_from_local_.inverse());
}

CarriedPath ScanTrial::best_rigid() const {
  std::vector<Eigen::Vector3d> nominal_mm, true_mm;
  for (const synthetic::EdgePoint& e : part_.truth.edge()) {
    nominal_mm.push_back(e.nominal_mm);
    true_mm.push_back(e.true_mm);
  }
  return carried(cad_from_local_.inverse() * fit_rigid(nominal_mm, true_mm).to_from);
}

CarriedPath backwards(const CarriedPath& rigid, const CarriedPath& corrected) {
  CarriedPath path = rigid;
  for (std::size_t i = 0; i < path.tips_mm.size(); ++i)
    path.tips_mm[i] += rigid.tips_mm[i] - corrected.tips_mm[i];
  return path;
}

}  // namespace arris::bench
