#include "tests/support/released.hpp"

#include <Eigen/LU>

#include "acquisition/types/error.hpp"

namespace arris::bench {
namespace {

constexpr int kMostRounds = 60;
constexpr double kDoneMm = 1e-7;
constexpr double kKinkMm =
    0.02;  // normals of neighbouring elements differ: off the face a step may flip there

/// Columns: the two tangents of an element and its unit normal.
Eigen::Matrix3d frame_of(const synthetic::Triangle6::Nodes& nodes, const synthetic::ElementPlace& place) {
  Eigen::Matrix3d frame;
  frame.col(0) = nodes * synthetic::Triangle6::slope_s(place.s, place.t);
  frame.col(1) = nodes * synthetic::Triangle6::slope_t(place.s, place.t);
  frame.col(2) = frame.col(0).cross(frame.col(1)).normalized();
  return frame;
}

}  // namespace

ReleaseMap::Local ReleaseMap::at(const Eigen::Vector3d& nominal_mm) const {
  const synthetic::ElementPlace place = part_.locate(nominal_mm);
  const synthetic::FacePoint foot = part_.at(place);
  const Eigen::Matrix3d gradient = frame_of(part_.nodes_of(place.element, true), place) *
                                   frame_of(part_.nodes_of(place.element, false), place).inverse();
  return {foot.true_mm + gradient * (nominal_mm - foot.nominal_mm), gradient};
}

Eigen::Vector3d ReleaseMap::clamped_mm(const Eigen::Vector3d& nominal_mm) const {
  return at(nominal_mm).place_mm;
}

Eigen::Vector3d ReleaseMap::released_mm(const Eigen::Vector3d& clamped_mm) const {
  Eigen::Vector3d nominal_mm = clamped_mm;
  double last_step_mm = 0.0;
  for (int round = 0; round < kMostRounds; ++round) {
    const Local local = at(nominal_mm);
    const Eigen::Vector3d step_mm = local.gradient.partialPivLu().solve(clamped_mm - local.place_mm);
    nominal_mm += step_mm;
    last_step_mm = step_mm.norm();
    if (last_step_mm < kDoneMm) return nominal_mm;
  }
  if (last_step_mm < kKinkMm) return nominal_mm;
  throw Error(Fault::kBug, "a clamped place has no material point: the map back does not converge");
}

std::vector<Eigen::Vector3d> ReleaseMap::released_mm(const std::vector<Eigen::Vector3d>& clamped_mm) const {
  std::vector<Eigen::Vector3d> nominal_mm;
  nominal_mm.reserve(clamped_mm.size());
  for (const Eigen::Vector3d& p : clamped_mm) nominal_mm.push_back(released_mm(p));
  return nominal_mm;
}

}  // namespace arris::bench
