#include "toolpath/robot/row_uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace arris {
namespace {

/// Both parts together along a unit direction; NaN when the row states none of its own.
double together_mm(double own_mm, const Eigen::Matrix3d& frame_mm2, const Eigen::Vector3d& direction) {
  if (!(own_mm > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(own_mm * own_mm + std::max(0.0, direction.dot(frame_mm2 * direction)));
}

}  // namespace

std::vector<RowUncertainty> row_uncertainty(const Correction& correction, const Eigen::Vector3d& offset_mm,
                                            const TargetFrame& frame) {
  ToolPath path;
  for (const CorrectedPoint& row : correction.points) path.points.push_back(row.point);
  const std::vector<Eigen::Vector3d> travel = directions(path);
  std::vector<RowUncertainty> rows;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const CorrectedPoint& row = correction.points[i];
    const Eigen::Matrix3d frame_mm2 =
        carried_covariance_mm2(frame, frame.robot_from_scan * (row.point.tip_mm + offset_mm));
    const Eigen::Matrix3d turn = frame.robot_from_scan.linear();
    const Eigen::Vector3d normal = turn * row.point.axis;
    Eigen::Vector3d along = turn * travel[i];
    along -= along.dot(normal) * normal;
    along = along.norm() > 1e-9 ? along.normalized() : frame_with_z(normal).col(0);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(frame_mm2, Eigen::EigenvaluesOnly);
    rows.push_back({together_mm(row.sd_normal_mm, frame_mm2, normal),
                    together_mm(row.sd_across_mm, frame_mm2, normal.cross(along)),
                    together_mm(row.sd_along_mm, frame_mm2, along),
                    std::sqrt(std::max(0.0, solver.eigenvalues()(2)))});
  }
  return rows;
}

}  // namespace arris
