#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "acquisition/geometry/packet_search.hpp"

/// The feet of sixteen queries on triangles, in double: bit for bit those of nearest_on_triangle().
namespace arris::packet {

struct Feet {
  alignas(32) double q_mm[3][kLanes];     ///< the queries, frame of the mesh
  alignas(32) double limit2_mm2[kLanes];  ///< of what is still nearer; in the end the squared distance
  alignas(32) double triangle[kLanes];    ///< its number in the mesh, exact; -1: none
  alignas(32) double foot_mm[3][kLanes];
  alignas(32) double b[kLanes], c[kLanes];  ///< barycentric, of the second and the third corner
  alignas(32) double height_mm[kLanes];     ///< of the query over the foot, along the face's normal
  alignas(32) double inside[kLanes];        ///< least barycentric coordinate less far_inside of the face
};

/// No foot yet, nothing farther than the limit.
void begin(Feet& feet, double limit2_mm2);

/// A face of the mesh that may be nearest to the queries of the mask.
struct Face {
  std::array<Eigen::Vector3d, 3> corners_mm;
  Eigen::Vector3d normal;
  double far_inside;
  std::int32_t number;
  std::uint32_t lanes;
};

/// Takes the face for the queries whose foot on it is nearer, or as near and its number lower.
void look_at(const Face& face, Feet& feet);

/// Puts a foot that was found otherwise.
void put(std::int32_t triangle, const Eigen::Vector3d& foot_mm, const Eigen::Vector3d& barycentric,
         double distance2_mm2, int lane, Feet& feet);

}  // namespace arris::packet
