#include "acquisition/geometry/surface_query.hpp"

#include <embree3/rtcore.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"
#include "tests/geometry/meshes.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

using namespace testing;  // NOLINT: meshes and points of this folder

const Eigen::Vector3d kHalf_mm(30.0, 20.0, 10.0);

// The twin: nearest point of a triangle as the nearest of its plane's foot, if inside, and its three edges.
double triangle_distance_mm(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                            const Eigen::Vector3d& q) {
  const auto to_edge = [&](const Eigen::Vector3d& s, const Eigen::Vector3d& e) {
    const double ratio = std::clamp((e - s).dot(q - s) / (e - s).squaredNorm(), 0.0, 1.0);
    return (s + ratio * (e - s) - q).norm();
  };
  const double edges = std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
  const Eigen::Vector3d n = (b - a).cross(c - a).normalized();
  const bool inside = n.cross(b - a).dot(q - a) >= 0.0 && n.cross(c - b).dot(q - b) >= 0.0 &&
                      n.cross(a - c).dot(q - c) >= 0.0;
  return inside ? std::abs(n.dot(q - a)) : edges;
}

double brute_distance_mm(const TriangleMesh& mesh, const Eigen::Vector3d& q) {
  double best_mm = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    best_mm = std::min(best_mm, triangle_distance_mm(mesh.vertices_mm[static_cast<std::size_t>(a)],
                                                     mesh.vertices_mm[static_cast<std::size_t>(b)],
                                                     mesh.vertices_mm[static_cast<std::size_t>(c)], q));
  return best_mm;
}

TriangleMesh triangle_soup(int count, unsigned seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::int32_t t = 0; t < count; ++t) {
    const Eigen::Vector3d centre_mm = random.in_cube_mm(100.0);
    for (int k = 0; k < 3; ++k)
      mesh.vertices_mm.push_back(centre_mm + random.in_cube_mm(t % 3 == 0 ? 30.0 : 3.0));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

RigidMotion far_motion(double distance_mm) {
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  motion.translation() = distance_mm * Eigen::Vector3d(0.6, -0.48, 0.64);
  return motion;
}

TEST(SurfaceQuery, IsTheBruteForceDistanceNearAndFar) {
  for (const double far_mm : {0.0, 1e4, 1e6}) {
    const RigidMotion motion = far_motion(far_mm);
    for (const TriangleMesh& local : {triangle_soup(300, 1), sphere_mesh(40.0, 3), box_mesh(kHalf_mm)}) {
      const TriangleMesh mesh = moved(local, motion);
      const SurfaceQuery surface(mesh);
      Random random(2);
      for (int i = 0; i < 1000; ++i) {
        const double reach_mm = i % 10 == 0 ? 1e5 : i % 2 == 0 ? 200.0 : 45.0;
        const Eigen::Vector3d query_mm = motion * random.in_cube_mm(reach_mm);
        const SurfacePoint found = surface.closest(query_mm);
        const double twin_mm = brute_distance_mm(mesh, query_mm);
        EXPECT_NEAR(found.distance_mm, twin_mm, 1e-9 + 1e-14 * (far_mm + reach_mm) * reach_mm);
        EXPECT_NEAR((found.foot_mm - query_mm).norm(), found.distance_mm, 1e-9);
        EXPECT_NEAR(std::abs(found.signed_mm), found.distance_mm, 0.0);
      }
    }
  }
}

/// Embree's nearest triangles of a mesh about its origin: a tree that shares nothing with ours.
class EmbreeTwin {
 public:
  explicit EmbreeTwin(const TriangleMesh& mesh) : mesh_(mesh) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* xyz = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices_mm.size()));
    auto* abc = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Eigen::Vector3d& v_mm : mesh.vertices_mm)
      for (int axis = 0; axis < 3; ++axis) *xyz++ = static_cast<float>(v_mm[axis]);
    for (const auto& triangle : mesh.triangles)
      for (const std::int32_t v : triangle) *abc++ = static_cast<unsigned>(v);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  EmbreeTwin(const EmbreeTwin&) = delete;
  EmbreeTwin& operator=(const EmbreeTwin&) = delete;
  ~EmbreeTwin() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  [[nodiscard]] double distance_mm(const Eigen::Vector3d& query_mm) const {
    Visit visit{mesh_, query_mm, std::numeric_limits<double>::infinity()};
    RTCPointQuery query{};
    query.x = static_cast<float>(query_mm.x());
    query.y = static_cast<float>(query_mm.y());
    query.z = static_cast<float>(query_mm.z());
    query.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, &Visit::triangle, &visit);
    return visit.nearest_mm;
  }

 private:
  struct Visit {
    const TriangleMesh& mesh;
    const Eigen::Vector3d& query_mm;
    double nearest_mm;
    static bool triangle(RTCPointQueryFunctionArguments* args) {
      Visit& visit = *static_cast<Visit*>(args->userPtr);
      const auto& [a, b, c] = visit.mesh.triangles[args->primID];
      const double off_mm =
          triangle_distance_mm(visit.mesh.vertices_mm[static_cast<std::size_t>(a)],
                               visit.mesh.vertices_mm[static_cast<std::size_t>(b)],
                               visit.mesh.vertices_mm[static_cast<std::size_t>(c)], visit.query_mm);
      if (off_mm >= visit.nearest_mm) return false;
      visit.nearest_mm = off_mm;
      args->query->radius = static_cast<float>(off_mm) * (1.0F + 1e-5F) + 1e-3F;  // rounding hides nothing
      return true;
    }
  };
  const TriangleMesh& mesh_;
  RTCDevice device_ = rtcNewDevice(nullptr);
  RTCScene scene_ = rtcNewScene(device_);
};

TEST(SurfaceQuery, IsEmbreesDistanceOnManyTriangles) {
  for (const TriangleMesh& mesh : {triangle_soup(20000, 15), sphere_mesh(40.0, 6), sheet_mesh(100.0, 100)}) {
    const SurfaceQuery surface(mesh);
    const EmbreeTwin twin(mesh);
    Random random(16);
    for (int i = 0; i < 5000; ++i) {
      const Eigen::Vector3d query_mm = random.in_cube_mm(i % 2 == 0 ? 150.0 : 45.0);
      EXPECT_NEAR(surface.closest(query_mm).distance_mm, twin.distance_mm(query_mm), 1e-9);
    }
  }
}

TEST(SurfaceQuery, DistancesOfManyPointsAreEmbrees) {
  // Points that follow each other lie near each other, near the surface and ever farther from it.
  for (const TriangleMesh& mesh : {triangle_soup(20000, 17), sphere_mesh(40.0, 6), sheet_mesh(100.0, 100)}) {
    const SurfaceQuery surface(mesh);
    const EmbreeTwin twin(mesh);
    Random random(18);
    std::vector<Eigen::Vector3d> queries_mm;
    for (std::size_t i = 0; i < 6000; ++i) {
      const auto& t = mesh.triangles[i * mesh.triangles.size() / 6000];
      queries_mm.push_back(mesh.vertices_mm[static_cast<std::size_t>(t[i % 3])] +
                           random.in_cube_mm(std::pow(10.0, static_cast<double>(i % 5000) / 1000.0 - 3.0)));
    }
    std::vector<SurfacePoint> answers(queries_mm.size());
    std::vector<double> signed_mm(queries_mm.size());
    surface.closest(queries_mm, 1e30, answers);
    surface.signed_distances(queries_mm, 1e30, signed_mm);
    for (std::size_t i = 0; i < queries_mm.size(); ++i) {
      const double distance_mm = twin.distance_mm(queries_mm[i]);
      EXPECT_NEAR(answers[i].distance_mm, distance_mm, 1e-9) << i;
      if (!answers[i].on_border) {
        EXPECT_NEAR(std::abs(signed_mm[i]), distance_mm, 1e-9) << i;
      }
    }
  }
}

TEST(SurfaceQuery, FloatTreeNeverHidesTheNearest) {
  // Specks around a query that lies 500 mm from the mesh's centre, where floats are 30 nm apart: in floats
  // their order is scrambled, the nearest must be found all the same. Each is there eight times, to fill
  // leaves.
  Random random(14);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d q_mm = Eigen::Vector3d(300.0, -310.0, 290.0) + random.in_cube_mm(1.0);
    TriangleMesh mesh = moved(box_mesh(Eigen::Vector3d::Ones()), far_motion(-700.0));
    double nearest_mm = 2.0;
    for (int speck = 0; speck < 300; ++speck) {
      const Eigen::Vector3d out = random.direction();
      const Eigen::Vector3d across = out.unitOrthogonal();
      const double near_mm = 1.0 + random.uniform(0.0, 1e-5);
      nearest_mm = std::min(nearest_mm, near_mm);
      const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
      for (const double side : {0.0, -2e-6, 2e-6})
        mesh.vertices_mm.push_back(q_mm + (near_mm + std::abs(side)) * out + side * across);
      mesh.triangles.insert(mesh.triangles.end(), 8, {first, first + 1, first + 2});
    }
    EXPECT_NEAR(SurfaceQuery(mesh).closest(q_mm).distance_mm, nearest_mm, 1e-9);
  }
}

TEST(SurfaceQuery, FootIsWhereItsBarycentricCoordinatesSay) {
  const TriangleMesh mesh = triangle_soup(100, 3);
  const SurfaceQuery surface(mesh);
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const SurfacePoint found = surface.closest(random.in_cube_mm(150.0));
    const auto& triangle = mesh.triangles[static_cast<std::size_t>(found.triangle)];
    Eigen::Vector3d foot_mm = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      foot_mm +=
          found.barycentric[static_cast<int>(k)] * mesh.vertices_mm[static_cast<std::size_t>(triangle[k])];
    EXPECT_LT((foot_mm - found.foot_mm).norm(), 1e-10);
    EXPECT_GE(found.barycentric.minCoeff(), -1e-12);
    EXPECT_NEAR(found.barycentric.sum(), 1.0, 1e-12);
    EXPECT_NEAR(found.normal.norm(), 1.0, 1e-12);
  }
}

TEST(SurfaceQuery, SignOfABoxNeverFlips) {
  Random random(5);
  for (const double far_mm : {0.0, 5000.0}) {
    const RigidMotion motion = far_motion(far_mm);
    const SurfaceQuery surface(moved(box_mesh(kHalf_mm), motion));
    for (int i = 0; i < 60000; ++i) {
      // Around corners, edges and faces, at distances from a micrometre to 30 mm.
      Eigen::Vector3d p_mm = kHalf_mm;
      const double reach_mm = std::pow(10.0, random.uniform(-3.0, 1.5));
      for (int axis = 0; axis < 3; ++axis) {
        if (i % 3 == axis || (i % 2 == 0 && (i + 1) % 3 == axis)) p_mm[axis] *= random.uniform(-1.1, 1.1);
        if (random.uniform(0.0, 1.0) > 0.3) p_mm[axis] += random.uniform(-reach_mm, reach_mm);
        if (random.uniform(0.0, 1.0) > 0.5) p_mm[axis] = -p_mm[axis];
      }
      const double truth_mm = box_signed_mm(kHalf_mm, p_mm);
      EXPECT_NEAR(surface.closest(motion * p_mm).signed_mm, truth_mm, 1e-9) << p_mm.transpose();
    }
  }
}

TEST(SurfaceQuery, SignHoldsExactlyAboveTheEdgesOfABox) {
  // Straight above an edge two faces tie, and one of them is seen edge-on: the case that a face normal gets
  // wrong.
  const SurfaceQuery surface(box_mesh(kHalf_mm));
  Random random(6);
  for (int i = 0; i < 20000; ++i) {
    Eigen::Vector3d p_mm(kHalf_mm.x(), random.uniform(-1.0, 1.0) * kHalf_mm.y(), kHalf_mm.z());
    const double height_mm = std::pow(10.0, random.uniform(-6.0, 2.0));
    p_mm[i % 2 == 0 ? 0 : 2] += height_mm;
    const SurfacePoint found = surface.closest(p_mm);
    EXPECT_GT(found.signed_mm, 0.0);
    EXPECT_NEAR(found.signed_mm, height_mm, 1e-9);
    EXPECT_FALSE(found.on_border);
  }
}

TEST(SurfaceQuery, MeasuresASphereFromBothSides) {
  constexpr double kRadius_mm = 50.0;
  const SurfaceQuery surface(sphere_mesh(kRadius_mm, 5));
  Random random(7);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d direction = random.direction();
    const double r_mm = random.uniform(20.0, 90.0);
    const SurfacePoint found = surface.closest(r_mm * direction);
    EXPECT_NEAR(found.signed_mm, r_mm - kRadius_mm, 0.05);  // sagitta of a 2.5 mm chord
    EXPECT_GT(found.normal.dot(direction), 0.99);
    EXPECT_FALSE(found.on_border);
  }
}

TEST(SurfaceQuery, KnowsTheBorderOfASheet) {
  const SurfaceQuery surface(sheet_mesh(10.0, 5));
  const auto at = [&](double x, double y, double z) { return surface.closest(Eigen::Vector3d(x, y, z)); };
  EXPECT_FALSE(at(1.0, 2.0, 3.0).on_border);
  EXPECT_FALSE(at(-2.0, -2.0, 3.0).on_border);  // an inner vertex
  EXPECT_TRUE(at(12.0, 1.0, 1.0).on_border);
  EXPECT_TRUE(at(12.0, 13.0, -1.0).on_border);  // a corner
  EXPECT_TRUE(at(10.0, 1.0, 1.0).on_border);    // straight above the rim
  EXPECT_GT(at(1.0, 2.0, 3.0).signed_mm, 0.0);
  EXPECT_LT(at(1.0, 2.0, -3.0).signed_mm, 0.0);
  EXPECT_NEAR(at(12.0, 1.0, 0.5).distance_mm, std::hypot(2.0, 0.5), 1e-12);
}

TEST(SurfaceQuery, ClosedMeshHasNoBorder) {
  const SurfaceQuery surface(box_mesh(kHalf_mm));
  for (const Eigen::Vector3d& q_mm : random_cube_mm(2000, 60.0, 8))
    EXPECT_FALSE(surface.closest(q_mm).on_border);
}

TEST(SurfaceQuery, AnswersWithinTheRadiusOnly) {
  const SurfaceQuery surface(box_mesh(kHalf_mm));
  const Eigen::Vector3d above_mm(0.0, 0.0, 15.0);
  EXPECT_EQ(surface.closest(above_mm, 4.999999).triangle, -1);
  EXPECT_GE(surface.closest(above_mm, 5.0).triangle, 0);
  EXPECT_GE(surface.closest(Eigen::Vector3d(1.0, 2.0, 10.0), 0.0).triangle, 0);
  EXPECT_EQ(surface.closest(above_mm, -1.0).triangle, -1);
}

TEST(SurfaceQuery, TiesGoToTheLowerTriangle) {
  TriangleMesh mesh = box_mesh(kHalf_mm);
  mesh.triangles.insert(mesh.triangles.end(), mesh.triangles.begin(),
                        mesh.triangles.end());  // each face twice
  const SurfaceQuery surface(mesh);
  for (const Eigen::Vector3d& q_mm : random_cube_mm(2000, 60.0, 9))
    EXPECT_LT(surface.closest(q_mm).triangle, 12);
  const SurfaceQuery once(box_mesh(kHalf_mm));
  EXPECT_EQ(once.closest(Eigen::Vector3d(0.0, 0.0, 20.0)).triangle, 2);  // on the diagonal of the top
}

TEST(SurfaceQuery, NoHintChangesTheAnswer) {
  TriangleMesh twice = box_mesh(kHalf_mm);
  twice.triangles.insert(twice.triangles.end(), twice.triangles.begin(), twice.triangles.end());
  for (const TriangleMesh& mesh : {sphere_mesh(40.0, 3), triangle_soup(300, 4), twice}) {
    const SurfaceQuery surface(mesh);
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d query_mm = random.in_cube_mm(60.0);
      const double reach_mm = i % 2 == 0 ? 1e30 : 20.0;
      const auto hint = static_cast<std::int32_t>(static_cast<std::size_t>(i) % mesh.triangles.size());
      const SurfacePoint plain = surface.closest(query_mm, reach_mm);
      const SurfacePoint hinted = surface.closest(query_mm, reach_mm, hint);
      EXPECT_EQ(plain.triangle, hinted.triangle);
      EXPECT_EQ(plain.foot_mm, hinted.foot_mm);
      EXPECT_EQ(plain.signed_mm, hinted.signed_mm);
    }
  }
}

bool are_equal(const SurfacePoint& a, const SurfacePoint& b) {
  return a.triangle == b.triangle && a.foot_mm == b.foot_mm && a.normal == b.normal &&
         a.barycentric == b.barycentric && a.distance_mm == b.distance_mm && a.signed_mm == b.signed_mm &&
         a.on_border == b.on_border;
}

/// Points in a row and points anywhere, on the mesh and beyond reach, and some that are no points.
std::vector<Eigen::Vector3d> mixed_queries(const TriangleMesh& mesh, double size_mm, unsigned seed) {
  Random random(seed);
  std::vector<Eigen::Vector3d> queries_mm;
  const Eigen::Vector3d middle_mm = mesh.vertices_mm.front();
  const Eigen::Vector3d step_mm = random.in_cube_mm(0.01 * size_mm);
  for (int i = 0; i < 200; ++i) queries_mm.push_back(middle_mm + (i - 100) * step_mm);
  for (int i = 0; i < 203; ++i) queries_mm.push_back(middle_mm + random.in_cube_mm(2.0 * size_mm));
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); v += 1 + mesh.vertices_mm.size() / 100)
    queries_mm.push_back(mesh.vertices_mm[v]);
  queries_mm[5].x() = std::numeric_limits<double>::quiet_NaN();
  queries_mm[16].setConstant(std::numeric_limits<double>::infinity());
  for (int axis = 0; axis < 3; ++axis) queries_mm.push_back(middle_mm + 1e12 * Eigen::Vector3d::Unit(axis));
  return queries_mm;
}

TEST(SurfaceQuery, ManyPointsGetTheAnswersOfEachAlone) {
  TriangleMesh needles = triangle_soup(300, 21);  // each third corner almost on the line of the others
  for (std::size_t t = 0; t < needles.triangles.size(); ++t)
    needles.vertices_mm[3 * t + 2] =
        0.5 * (needles.vertices_mm[3 * t] + needles.vertices_mm[3 * t + 1]) +
        std::pow(10.0, -static_cast<double>(t % 12)) * Eigen::Vector3d(0.3, 0.2, -0.1);
  TriangleMesh stacked;  // more triangles in one place than a packet can list
  for (int copy = 0; copy < 40; ++copy) {
    for (const auto& t : box_mesh(kHalf_mm).triangles) {
      stacked.triangles.push_back(t);
      for (std::int32_t& corner : stacked.triangles.back()) corner += 8 * copy;
    }
    for (const Eigen::Vector3d& v_mm : box_mesh(kHalf_mm).vertices_mm) stacked.vertices_mm.push_back(v_mm);
  }
  const std::vector<TriangleMesh> meshes = {triangle_soup(2000, 20),
                                            needles,
                                            stacked,
                                            box_mesh(kHalf_mm),
                                            sphere_mesh(50.0, 4),
                                            sheet_mesh(60.0, 25),
                                            moved(sphere_mesh(50.0, 4), far_motion(1e6)),
                                            moved(sheet_mesh(1e-3, 4), far_motion(10.0)),
                                            {{{1, 2, 3}}, {}}};
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const SurfaceQuery query(meshes[m]);
    const std::vector<Eigen::Vector3d> queries_mm = mixed_queries(meshes[m], 60.0, 22);
    for (const double reach_mm : {1e30, 20.0, 0.5, 0.0, -1.0}) {
      std::vector<SurfacePoint> answers(queries_mm.size());
      std::vector<double> signed_mm(queries_mm.size());
      query.closest(queries_mm, reach_mm, answers);
      query.signed_distances(queries_mm, reach_mm, signed_mm);
      for (std::size_t i = 0; i < queries_mm.size(); ++i) {
        const SurfacePoint alone = query.closest(queries_mm[i], reach_mm);
        ASSERT_TRUE(are_equal(answers[i], alone)) << "mesh " << m << " point " << i << " reach " << reach_mm;
        if (alone.triangle < 0 || alone.on_border)
          ASSERT_TRUE(std::isnan(signed_mm[i])) << "mesh " << m << " point " << i << " reach " << reach_mm;
        else
          ASSERT_EQ(signed_mm[i], alone.signed_mm) << "mesh " << m << " point " << i << " reach " << reach_mm;
      }
    }
  }
  std::vector<SurfacePoint> too_few(1);
  EXPECT_THROW(SurfaceQuery(meshes[0]).closest(mixed_queries(meshes[0], 1.0, 1), 1.0, too_few), Error);
  std::vector<double> too_few_mm(1);
  EXPECT_THROW(SurfaceQuery(meshes[0]).signed_distances(mixed_queries(meshes[0], 1.0, 1), 1.0, too_few_mm),
               Error);
}

TEST(SurfaceQuery, SeesThroughTrianglesWithoutArea) {
  // A T-junction on a box edge, closed by a triangle without area, as CAD exports write them.
  TriangleMesh mesh = box_mesh(kHalf_mm);
  const auto middle = static_cast<std::int32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.push_back(0.5 * (mesh.vertices_mm[5] + mesh.vertices_mm[7]));  // edge +x +z
  mesh.triangles.back() = {3, 7, middle};                                         // was {3, 7, 5}
  mesh.triangles.push_back({3, middle, 5});
  mesh.triangles.push_back({7, 5, middle});  // the needle between them and the top
  const SurfaceQuery surface(mesh);
  Random random(10);
  for (int i = 0; i < 20000; ++i) {
    Eigen::Vector3d p_mm(kHalf_mm.x(), random.uniform(-1.2, 1.2) * kHalf_mm.y(), kHalf_mm.z());
    p_mm += random.in_cube_mm(i % 2 == 0 ? 1.0 : 0.01);
    if (i % 5 == 0) p_mm.x() = kHalf_mm.x();
    const SurfacePoint found = surface.closest(p_mm);
    EXPECT_NEAR(found.signed_mm, box_signed_mm(kHalf_mm, p_mm), 1e-9) << p_mm.transpose();
    EXPECT_FALSE(found.on_border);
  }
}

TEST(SurfaceQuery, GivesTheSameBytesForAnyThreadCount) {
  const TriangleMesh mesh = sphere_mesh(40.0, 4);
  const std::vector<Eigen::Vector3d> queries_mm = random_cube_mm(20000, 60.0, 11);
  const auto run = [&](int threads) {
    const SurfaceQuery surface(mesh, threads);  // built anew
    std::vector<Eigen::Vector4d> answers(queries_mm.size());
    parallel_for(queries_mm.size(), 256, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const SurfacePoint found = surface.closest(queries_mm[i]);
        answers[i] << found.foot_mm + found.normal, found.signed_mm + found.triangle;
      }
    });
    return answers;
  };
  const auto one = run(1);
  for (const int threads : {2, 8})
    EXPECT_EQ(std::memcmp(run(threads).data(), one.data(), one.size() * sizeof(one[0])), 0) << threads;
}

TEST(SurfaceQuery, MovesWithTheMesh) {
  const TriangleMesh mesh = triangle_soup(200, 12);
  const RigidMotion motion = far_motion(300.0);
  const SurfaceQuery here(mesh);
  const SurfaceQuery there(moved(mesh, motion));
  for (const Eigen::Vector3d& q_mm : random_cube_mm(2000, 150.0, 13))
    EXPECT_NEAR(here.closest(q_mm).distance_mm, there.closest(motion * q_mm).distance_mm, 1e-9);
}

TEST(SurfaceQuery, AnswersNothingWhenThereIsNothing) {
  TriangleMesh flat;
  flat.vertices_mm.assign(3, Eigen::Vector3d::Ones());
  flat.triangles = {{0, 1, 2}};
  for (const TriangleMesh& mesh : {TriangleMesh{}, flat})
    EXPECT_EQ(SurfaceQuery(mesh).closest(Eigen::Vector3d::Zero()).triangle, -1);
  const SurfaceQuery box(box_mesh(kHalf_mm));
  EXPECT_EQ(box.closest(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())).triangle, -1);
  flat.triangles = {{0, 1, 3}};
  EXPECT_THROW(SurfaceQuery{flat}, Error);
}

}  // namespace
}  // namespace arris
