#include "acquisition/geometry/surface_query.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/box_tree.hpp"
#include "acquisition/geometry/mesh_normals.hpp"
#include "acquisition/geometry/packet_feet.hpp"
#include "acquisition/geometry/packet_search.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

// A foot this near to an edge, in parts of the triangle's longest edge, is on it: the edge's normal decides
// the side.
constexpr double kOnEdgeRatio = 1e-9;
constexpr double kRoundedTwice = 2.0;   // the query and the triangle
constexpr double kFarForPackets = 1e9;  // mm; squares of floats
constexpr double kLargestGuess2Mm2 = 1e18;
constexpr int kLongestWait = 31;
constexpr std::size_t kChunk = 4096;

std::size_t at(std::int32_t index) {
  return static_cast<std::size_t>(index);
}

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
  double limit2_mm2 = 0.0;
  std::int32_t triangle = -1;
  Foot foot{};

  void look_at(const std::array<Eigen::Vector3d, 3>& corners_mm, std::int32_t t,
               const Eigen::Vector3d& query_mm) {
    const Foot candidate = nearest_on_triangle(corners_mm, query_mm);
    if (!(candidate.distance2_mm2 <= limit2_mm2)) return;
    if (candidate.distance2_mm2 == limit2_mm2 && triangle >= 0 && t > triangle) return;
    limit2_mm2 = candidate.distance2_mm2;
    triangle = t;
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

/// Where the search of the next packet begins: near the last one.
struct Seed {
  std::int32_t place = -1;  // in the tree
  float guess2_mm2 = 0.0F;
  int wait = 0, next_wait = 0;  // packets to ask alone, after one whose queries lie far apart
};

}  // namespace

struct SurfaceQuery::Impl {
  Impl(const TriangleMesh& mesh_, int threads) : mesh(mesh_), normals(face_normals(mesh_, threads)) {
    parallel_for(2, 1, threads, [&](std::size_t begin, std::size_t end) {  // much of either is for one thread
      for (std::size_t half = begin; half < end; ++half)
        half == 0 ? build_tree(threads) : add_edge_and_vertex_normals(mesh, threads, normals);
    });
  }

  void build_tree(int threads) {
    std::vector<std::int32_t> with_area;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (normals.degenerate[t] == 0) with_area.push_back(static_cast<std::int32_t>(t));
    std::vector<Eigen::AlignedBox3d> boxes_mm(with_area.size());
    parallel_for(boxes_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (const Eigen::Vector3d& corner_mm : corners(at(with_area[i]))) boxes_mm[i].extend(corner_mm);
    });
    tree = BoxTree(boxes_mm, threads);
    far_inside.resize(mesh.triangles.size());
    place_of.assign(mesh.triangles.size(), -1);
    packed.resize(with_area.size());
    triangle_at.resize(with_area.size());
    triangle_of = std::move(with_area);
    const double slack_mm = kRoundedTwice * tree.slack_mm(Eigen::Vector3d::Zero());
    parallel_for(packed.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t place = begin; place < end; ++place) {
        const std::int32_t t = triangle_of[at(tree.item_at()[place])];
        const std::array<Eigen::Vector3d, 3> p_mm = corners(at(t));
        const Eigen::Vector3d& centre_mm = tree.centre_mm();
        triangle_at[place] = t;
        place_of[at(t)] = static_cast<std::int32_t>(place);
        far_inside[at(t)] = far_inside_of(p_mm);
        packed[place] =
            packet::triangle_of(p_mm[0] - centre_mm, p_mm[1] - centre_mm, p_mm[2] - centre_mm, slack_mm);
      }
    });
  }

  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::size_t t) const {
    const auto& [a, b, c] = mesh.triangles[t];
    return {mesh.vertices_mm[static_cast<std::size_t>(a)], mesh.vertices_mm[static_cast<std::size_t>(b)],
            mesh.vertices_mm[static_cast<std::size_t>(c)]};
  }

  [[nodiscard]] SurfacePoint describe(std::size_t triangle, const Foot& foot,
                                      const Eigen::Vector3d& query_mm) const;
  [[nodiscard]] SurfacePoint describe(const packet::Feet& feet, std::size_t lane,
                                      const Eigen::Vector3d& query_mm) const;
  [[nodiscard]] double signed_mm(const packet::Feet& feet, std::size_t lane,
                                 const Eigen::Vector3d& query_mm) const;

  void look_at_triangle(std::int32_t t, const Eigen::Vector3d& query_mm, Nearest& nearest) const {
    nearest.look_at(corners(at(t)), t, query_mm);
  }

  /// Looks at what the tree shows within the limit of `nearest`.
  void search_alone(const Eigen::Vector3d& query_mm, Nearest& nearest) const {
    tree.search(query_mm, nearest.limit2_mm2, [&](std::int32_t item) {
      look_at_triangle(triangle_of[at(item)], query_mm, nearest);
      return nearest.limit2_mm2;
    });
  }

  bool pack(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm, packet::Queries& queries,
            packet::Feet& feet) const;
  void look_alone(std::span<const Eigen::Vector3d> queries_mm, Seed& seed, packet::Feet& feet) const;
  void look(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm, Seed& seed,
            packet::Feet& feet) const;
  template <class Answer>
  void answer_all(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm, Answer&& answer) const;

  TriangleMesh mesh;
  MeshNormals normals;
  std::vector<std::int32_t> triangle_of;            // mesh triangle of each item of the tree
  std::vector<std::int32_t> triangle_at, place_of;  // mesh triangle at each place in the tree, and back
  std::vector<float> far_inside;  // of all: a foot whose barycentric coordinates exceed it is on no edge
  BoxTree tree;
  std::vector<packet::Triangle> packed;  // by their places in the tree
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

SurfacePoint SurfaceQuery::Impl::describe(const packet::Feet& feet, std::size_t lane,
                                          const Eigen::Vector3d& query_mm) const {
  if (feet.triangle[lane] < 0.0) return {};
  const double b = feet.b[lane], c = feet.c[lane];
  const Foot foot{{feet.foot_mm[0][lane], feet.foot_mm[1][lane], feet.foot_mm[2][lane]},
                  {1.0 - b - c, b, c},
                  feet.limit2_mm2[lane]};
  return describe(static_cast<std::size_t>(feet.triangle[lane]), foot, query_mm);
}

double SurfaceQuery::Impl::signed_mm(const packet::Feet& feet, std::size_t lane,
                                     const Eigen::Vector3d& query_mm) const {
  if (feet.triangle[lane] < 0.0) return std::numeric_limits<double>::quiet_NaN();
  if (feet.inside[lane] > 0.0) {
    const double distance_mm = std::sqrt(feet.limit2_mm2[lane]);
    return feet.height_mm[lane] >= 0.0 ? distance_mm : -distance_mm;
  }
  const SurfacePoint answer = describe(feet, lane, query_mm);
  return answer.on_border ? std::numeric_limits<double>::quiet_NaN() : answer.signed_mm;
}

/// Makes the queries ready for the float search; false where one is too far off for it, or not finite.
bool SurfaceQuery::Impl::pack(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm,
                              packet::Queries& queries, packet::Feet& feet) const {
  double farthest_mm = 0.0;
  bool can_join = true;
  for (std::size_t lane = 0; lane < packet::kLanes; ++lane) {
    const Eigen::Vector3d& query_mm = queries_mm[std::min(lane, queries_mm.size() - 1)];
    const Eigen::Vector3d local_mm = query_mm - tree.centre_mm();
    const double far_mm = local_mm.cwiseAbs().maxCoeff();
    can_join = can_join && far_mm < kFarForPackets && local_mm.allFinite();
    farthest_mm = std::max(farthest_mm, far_mm);
    for (int axis = 0; axis < 3; ++axis) {
      queries.p_mm[axis][lane] = static_cast<float>(local_mm[axis]);
      feet.q_mm[axis][lane] = query_mm[axis];
    }
  }
  const double slack_mm = 2.0 * tree.slack_mm(Eigen::Vector3d::Constant(farthest_mm));
  std::fill_n(queries.limit2_mm2, packet::kLanes,
              BoxTree::limit_above(max_distance_mm * max_distance_mm, slack_mm));
  return can_join;
}

/// Queries that follow each other, each by itself.
void SurfaceQuery::Impl::look_alone(std::span<const Eigen::Vector3d> queries_mm, Seed& seed,
                                    packet::Feet& feet) const {
  for (std::size_t lane = 0; lane < queries_mm.size(); ++lane) {
    if (!queries_mm[lane].allFinite()) continue;
    Nearest nearest{feet.limit2_mm2[lane]};
    if (seed.place >= 0) look_at_triangle(triangle_at[at(seed.place)], queries_mm[lane], nearest);
    search_alone(queries_mm[lane], nearest);
    if (nearest.triangle < 0) continue;
    seed.place = place_of[at(nearest.triangle)];
    seed.guess2_mm2 = static_cast<float>(std::min(nearest.limit2_mm2, kLargestGuess2Mm2));
    packet::put(nearest.triangle, nearest.foot.foot_mm, nearest.foot.barycentric, nearest.limit2_mm2,
                static_cast<int>(lane), feet);
  }
}

/// Finds the feet of up to kLanes queries: together where they lie near each other.
void SurfaceQuery::Impl::look(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm, Seed& seed,
                              packet::Feet& feet) const {
  packet::begin(feet, max_distance_mm * max_distance_mm);
  packet::Queries queries;
  packet::Candidates candidates;
  if (!pack(queries_mm, max_distance_mm, queries, feet) || seed.place < 0 || seed.wait > 0) {
    seed.wait -= seed.wait > 0 ? 1 : 0;
    return look_alone(queries_mm, seed, feet);
  }
  if (!packet::search(tree, packed.data(), seed.place, seed.guess2_mm2, queries, candidates)) {
    seed.wait = seed.next_wait = std::min(2 * seed.next_wait + 1, kLongestWait);
    return look_alone(queries_mm, seed, feet);
  }
  seed.next_wait = 0;
  for (int k = 0; k < candidates.count; ++k) {
    const auto t = at(triangle_at[at(candidates.place[k])]);
    packet::look_at({corners(t), normals.face[t], static_cast<double>(far_inside[t]),
                     static_cast<std::int32_t>(t), candidates.lanes[k]},
                    feet);
  }
  if (candidates.count > 0) seed.place = candidates.place[0];
}

/// Calls answer(number of the query, feet, its lane) for each query in turn.
template <class Answer>
void SurfaceQuery::Impl::answer_all(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm,
                                    Answer&& answer) const {
  Seed seed;
  packet::Feet feet;
  for (std::size_t first = 0; first < queries_mm.size(); first += packet::kLanes) {
    const std::size_t count = std::min<std::size_t>(packet::kLanes, queries_mm.size() - first);
    if (max_distance_mm >= 0.0)
      look(queries_mm.subspan(first, count), max_distance_mm, seed, feet);
    else
      packet::begin(feet, 0.0);
    for (std::size_t lane = 0; lane < count; ++lane) answer(first + lane, feet, lane);
  }
}

SurfaceQuery::SurfaceQuery(const TriangleMesh& mesh, int threads)
    : impl_(std::make_shared<const Impl>(mesh, threads)) {}

SurfacePoint SurfaceQuery::closest(const Eigen::Vector3d& query_mm, double max_distance_mm,
                                   std::int32_t hint) const {
  const Impl& impl = *impl_;
  if (!query_mm.allFinite() || !(max_distance_mm >= 0.0)) return {};
  Nearest nearest{max_distance_mm * max_distance_mm};
  if (hint >= 0) impl.look_at_triangle(hint, query_mm, nearest);
  impl.search_alone(query_mm, nearest);
  if (nearest.triangle < 0) return {};
  return impl.describe(static_cast<std::size_t>(nearest.triangle), nearest.foot, query_mm);
}

void SurfaceQuery::closest(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm,
                           std::span<SurfacePoint> answers) const {
  if (answers.size() != queries_mm.size())
    throw Error(Fault::kBug, "closest: " + std::to_string(answers.size()) + " answers for " +
                                 std::to_string(queries_mm.size()) + " points");
  impl_->answer_all(queries_mm, max_distance_mm,
                    [&](std::size_t i, const packet::Feet& feet, std::size_t lane) {
                      answers[i] = impl_->describe(feet, lane, queries_mm[i]);
                    });
}

void SurfaceQuery::signed_distances(std::span<const Eigen::Vector3d> queries_mm, double max_distance_mm,
                                    std::span<double> answers_mm) const {
  if (answers_mm.size() != queries_mm.size())
    throw Error(Fault::kBug, "signed_distances: " + std::to_string(answers_mm.size()) + " answers for " +
                                 std::to_string(queries_mm.size()) + " points");
  impl_->answer_all(queries_mm, max_distance_mm,
                    [&](std::size_t i, const packet::Feet& feet, std::size_t lane) {
                      answers_mm[i] = impl_->signed_mm(feet, lane, queries_mm[i]);
                    });
}

}  // namespace arris
