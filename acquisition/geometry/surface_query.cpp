#include "acquisition/geometry/surface_query.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/box_tree.hpp"
#include "acquisition/geometry/mesh_normals.hpp"
#include "acquisition/geometry/packet_search.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

// A foot this near to an edge, in parts of the triangle's longest edge, is on it: the edge's normal decides
// the side.
constexpr double kOnEdgeRatio = 1e-9;
constexpr double kRoundedTwice = 2.0;   // the query and the triangle
constexpr double kFarForPackets = 1e9;  // mm; squares of floats

struct Foot {
  Eigen::Vector3d foot_mm;
  Eigen::Vector3d barycentric;
  double distance2_mm2;
};

Foot foot_at(const std::array<Eigen::Vector3d, 3>& corners_mm, const Eigen::Vector3d& barycentric,
             const Eigen::Vector3d& query_mm) {
  const Eigen::Vector3d foot_mm = corners_mm[0] + barycentric[1] * (corners_mm[1] - corners_mm[0]) +
                                  barycentric[2] * (corners_mm[2] - corners_mm[0]);
  return {foot_mm, barycentric, (query_mm - foot_mm).squaredNorm()};
}

// Nearest point of a triangle by its Voronoi regions (Ericson, Real-Time Collision Detection, 2005,
// section 5.1.5).
Foot nearest_on_triangle(const std::array<Eigen::Vector3d, 3>& corners_mm, const Eigen::Vector3d& query_mm) {
  const Eigen::Vector3d ab = corners_mm[1] - corners_mm[0];
  const Eigen::Vector3d ac = corners_mm[2] - corners_mm[0];
  const auto answer = [&](double b, double c) {
    return foot_at(corners_mm, Eigen::Vector3d(1.0 - b - c, b, c), query_mm);
  };
  const Eigen::Vector3d ap = query_mm - corners_mm[0];
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return answer(0.0, 0.0);
  const Eigen::Vector3d bp = query_mm - corners_mm[1];
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return answer(1.0, 0.0);
  const Eigen::Vector3d cp = query_mm - corners_mm[2];
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return answer(0.0, 1.0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return answer(d1 / (d1 - d3), 0.0);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return answer(0.0, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return answer(1.0 - w, w);
  }
  const double total = va + vb + vc;
  const double b = std::clamp(vb / total, 0.0, 1.0);
  return answer(b, std::clamp(vc / total, 0.0, 1.0 - b));
}

/// The nearest triangle of those looked at so far.
struct Nearest {
  const TriangleMesh& mesh;
  const Eigen::Vector3d& query_mm;
  double limit2_mm2;
  std::int32_t triangle = -1, item = -1;  // of the mesh, in the tree
  Foot foot{};

  void look_at(std::int32_t t, std::int32_t its_item) {
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(t)];
    const Foot candidate = nearest_on_triangle(
        {mesh.vertices_mm[static_cast<std::size_t>(a)], mesh.vertices_mm[static_cast<std::size_t>(b)],
         mesh.vertices_mm[static_cast<std::size_t>(c)]},
        query_mm);
    if (!(candidate.distance2_mm2 <= limit2_mm2)) return;
    if (candidate.distance2_mm2 == limit2_mm2 && triangle >= 0 && t > triangle) return;
    limit2_mm2 = candidate.distance2_mm2;
    triangle = t;
    item = its_item;
    foot = candidate;
  }
};

/// Four times the coordinate of a foot that counts as on an edge; above 1 for a triangle without area.
float far_inside_of(const std::array<Eigen::Vector3d, 3>& p_mm) {
  const Eigen::Vector3d ab = p_mm[1] - p_mm[0], ac = p_mm[2] - p_mm[0];
  const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  const double ratio = 4.0 * kOnEdgeRatio * longest2 / ab.cross(ac).norm();
  return ratio < 1.0 ? static_cast<float>(ratio) : 2.0F;
}

}  // namespace

struct SurfaceQuery::Impl {
  explicit Impl(const TriangleMesh& mesh_) : mesh(mesh_), normals(mesh_normals(mesh_)) {
    std::vector<Eigen::AlignedBox3d> boxes_mm;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (normals.degenerate[t] != 0) continue;
      triangle_of.push_back(static_cast<std::int32_t>(t));
      boxes_mm.emplace_back();
      for (const Eigen::Vector3d& corner_mm : corners(t)) boxes_mm.back().extend(corner_mm);
    }
    tree = BoxTree(boxes_mm);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) far_inside.push_back(far_inside_of(corners(t)));
    for (const std::int32_t t : triangle_of) {
      const std::array<Eigen::Vector3d, 3> p_mm = corners(static_cast<std::size_t>(t));
      const Eigen::Vector3d& centre_mm = tree.centre_mm();
      packed.push_back(packet::triangle_of(p_mm[0] - centre_mm, p_mm[1] - centre_mm, p_mm[2] - centre_mm,
                                           kRoundedTwice * tree.slack_mm(Eigen::Vector3d::Zero())));
    }
  }

  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::size_t t) const {
    const auto& [a, b, c] = mesh.triangles[t];
    return {mesh.vertices_mm[static_cast<std::size_t>(a)], mesh.vertices_mm[static_cast<std::size_t>(b)],
            mesh.vertices_mm[static_cast<std::size_t>(c)]};
  }

  [[nodiscard]] SurfacePoint describe(std::size_t triangle, const Foot& foot,
                                      const Eigen::Vector3d& query_mm) const;

  /// Looks at what the tree shows within the limit of `nearest`.
  void search_alone(const Eigen::Vector3d& query_mm, Nearest& nearest) const {
    tree.search(query_mm, nearest.limit2_mm2, [&](std::int32_t item) {
      nearest.look_at(triangle_of[static_cast<std::size_t>(item)], item);
      return nearest.limit2_mm2;
    });
  }

  std::int32_t answer_packet(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm,
                             std::int32_t near_item, std::span<SurfacePoint> answers) const;

  TriangleMesh mesh;
  MeshNormals normals;
  std::vector<std::int32_t> triangle_of;  // mesh triangle of each triangle in the tree
  std::vector<float> far_inside;  // of all: a foot whose barycentric coordinates exceed it is on no edge
  BoxTree tree;
  std::vector<packet::Triangle> packed;  // of the triangles in the tree
};

SurfacePoint SurfaceQuery::Impl::describe(std::size_t triangle, const Foot& foot,
                                          const Eigen::Vector3d& query_mm) const {
  SurfacePoint answer;
  answer.triangle = static_cast<std::int32_t>(triangle);
  answer.foot_mm = foot.foot_mm;
  answer.barycentric = foot.barycentric;
  answer.distance_mm = std::sqrt(foot.distance2_mm2);
  answer.normal = normals.face[triangle];

  const auto sign = [&] {
    const bool outside = answer.normal.dot(query_mm - foot.foot_mm) >= 0.0;
    answer.signed_mm = outside ? answer.distance_mm : -answer.distance_mm;
    return answer;
  };
  if (foot.barycentric.minCoeff() > static_cast<double>(far_inside[triangle])) return sign();

  const std::array<Eigen::Vector3d, 3> p_mm = corners(triangle);
  const std::array<double, 3> edge_mm = {(p_mm[1] - p_mm[0]).norm(), (p_mm[2] - p_mm[1]).norm(),
                                         (p_mm[0] - p_mm[2]).norm()};
  const double tolerance_mm = kOnEdgeRatio * std::max({edge_mm[0], edge_mm[1], edge_mm[2]});
  const double area2_mm2 = (p_mm[1] - p_mm[0]).cross(p_mm[2] - p_mm[0]).norm();
  for (std::size_t k = 0; k < 3;
       ++k) {  // height of the foot over edge k: its share of the opposite corner's height
    if (foot.barycentric[static_cast<int>((k + 2) % 3)] * area2_mm2 > tolerance_mm * edge_mm[k]) continue;
    const auto edge = static_cast<std::size_t>(normals.edge_of[triangle][k]);
    answer.normal = normals.edge[edge];
    answer.on_border = answer.on_border || normals.edge_is_border[edge] != 0;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if ((foot.foot_mm - p_mm[k]).norm() > tolerance_mm) continue;
    const auto vertex = static_cast<std::size_t>(mesh.triangles[triangle][k]);
    answer.normal = normals.vertex[vertex];
    answer.on_border = normals.vertex_is_border[vertex] != 0;
  }
  if (answer.normal.squaredNorm() < 0.5)
    answer.normal = normals.face[triangle];  // faces folded onto each other
  return sign();
}

/// Answers up to kLanes queries; returns the item to look at first for those that follow.
std::int32_t SurfaceQuery::Impl::answer_packet(std::span<const Eigen::Vector3d> queries_mm,
                                               double max_distance_mm, std::int32_t near_item,
                                               std::span<SurfacePoint> answers) const {
  packet::Queries packed_queries;
  packet::Candidates candidates;
  const auto can_join = [&](const Eigen::Vector3d& q) {
    return (q - tree.centre_mm()).cwiseAbs().maxCoeff() < kFarForPackets;  // false for what is not finite
  };
  const auto leads = std::find_if(queries_mm.begin(), queries_mm.end(), can_join);
  if (leads != queries_mm.end() && max_distance_mm >= 0.0) {
    for (std::size_t lane = 0; lane < packet::kLanes; ++lane) {
      const bool joins = lane < queries_mm.size() && can_join(queries_mm[lane]);
      const Eigen::Vector3d local_mm = (joins ? queries_mm[lane] : *leads) - tree.centre_mm();
      for (int axis = 0; axis < 3; ++axis)
        packed_queries.p_mm[axis][lane] = static_cast<float>(local_mm[axis]);
      packed_queries.limit2_mm2[lane] =
          BoxTree::limit_above(max_distance_mm * max_distance_mm, 2.0 * tree.slack_mm(local_mm));
    }
    packet::search(tree, packed.data(), near_item, packed_queries, candidates);
  }
  for (std::size_t lane = 0; lane < queries_mm.size(); ++lane) {
    const Eigen::Vector3d& query_mm = queries_mm[lane];
    answers[lane] = {};
    if (!query_mm.allFinite() || !(max_distance_mm >= 0.0)) continue;
    Nearest nearest{mesh, query_mm, max_distance_mm * max_distance_mm};
    if (!can_join(query_mm) || candidates.count[lane] < 0) {
      search_alone(query_mm, nearest);
    } else {
      for (int k = 0; k < candidates.count[lane]; ++k) {
        if (candidates.least2_mm2[lane][k] > packed_queries.limit2_mm2[lane]) continue;
        const std::int32_t item = candidates.item[lane][k];
        nearest.look_at(triangle_of[static_cast<std::size_t>(item)], item);
      }
    }
    if (nearest.triangle < 0) continue;
    answers[lane] = describe(static_cast<std::size_t>(nearest.triangle), nearest.foot, query_mm);
    if (nearest.item >= 0) near_item = nearest.item;
  }
  return near_item;
}

SurfaceQuery::SurfaceQuery(const TriangleMesh& mesh) : impl_(std::make_shared<const Impl>(mesh)) {}

SurfacePoint SurfaceQuery::closest(const Eigen::Vector3d& query_mm, double max_distance_mm,
                                   std::int32_t hint) const {
  const Impl& impl = *impl_;
  if (!query_mm.allFinite() || !(max_distance_mm >= 0.0)) return {};
  Nearest nearest{impl.mesh, query_mm, max_distance_mm * max_distance_mm};
  if (hint >= 0) nearest.look_at(hint, -1);
  impl.search_alone(query_mm, nearest);
  if (nearest.triangle < 0) return {};
  return impl.describe(static_cast<std::size_t>(nearest.triangle), nearest.foot, query_mm);
}

void SurfaceQuery::closest(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm,
                           std::span<SurfacePoint> answers) const {
  if (answers.size() != queries_mm.size())
    throw Error(Fault::kBug, "closest: " + std::to_string(answers.size()) + " answers for " +
                                 std::to_string(queries_mm.size()) + " points");
  const Impl& impl = *impl_;
  std::int32_t near_item = -1;
  for (std::size_t first = 0; first < queries_mm.size(); first += packet::kLanes) {
    const std::size_t count = std::min<std::size_t>(packet::kLanes, queries_mm.size() - first);
    near_item = impl.answer_packet(queries_mm.subspan(first, count), max_distance_mm, near_item,
                                   answers.subspan(first, count));
  }
}

}  // namespace arris
