#include "registration/edge_posterior.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "fixtures/synthetic/random.hpp"

namespace arris {
namespace {

/// Points y inside of an edge x0 + slope * s, both unknown: a Gaussian prior, a density that pulls the edge
/// towards them, and one bound a point.
struct StraightEdge {
  struct Point {
    double s = 0.0, y_mm = 0.0;
  };
  std::vector<Point> points;
  WallPoints wall;  ///< any point may be one of these
  double prior_sd_mm = 0.5, density_per_mm = 20.0, stray_ratio = 1e-3;
  std::vector<std::int32_t> node = {0};

  /// Normal equations at x with the sites' messages.
  SurfaceSystem system(const Eigen::Vector2d& x, const std::vector<EdgeSite>& sites) const {
    SurfaceSystem sum(std::make_shared<NodeBand>(NodeBand::full(1)), 1);
    const double prior = 1.0 / (prior_sd_mm * prior_sd_mm);
    sum.add_to_nodes(prior);  // of its three unknowns the first is used
    sum.add_to_offset(0, prior);
    sum.gradient[0] += prior * x[1];
    sum.gradient[3] += prior * x[0] - density_per_mm;
    for (const EdgeSite& site : sites)
      sum.add(site.row, site.message.slope_at(site.inside_mm), site.message.precision_per_mm2);
    return sum;
  }
  double inside_mm(const Point& p, const Eigen::Vector2d& x) const { return p.y_mm - x[0] - p.s * x[1]; }
  std::vector<EdgeSite> sites(const Eigen::Vector2d& x) const {
    std::vector<EdgeSite> all;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EdgeSite site{i, {}, inside_mm(points[i], x), {1.0, 1.0 + 1.0 * inside_mm(points[i], x)}, wall};
      site.row.node = &node;
      site.row.direction = {Eigen::Vector3d(-points[i].s, 0.0, 0.0)};
      site.row.offset = 0;
      site.row.offset_derivative = -1.0;
      all.push_back(site);
    }
    return all;
  }
  double log_posterior(const Eigen::Vector2d& x) const {
    double sum = -0.5 * x.squaredNorm() / (prior_sd_mm * prior_sd_mm) + density_per_mm * x[0];
    for (const Point& p : points) {
      const double z = inside_mm(p, x) / kEdgeBlurMm - 0.3375;
      sum += std::log(0.5 * std::erfc(-z / std::sqrt(2.0)) + stray_ratio + wall.ratio(inside_mm(p, x)));
    }
    return sum;
  }
};

struct Moments {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

Moments by_grid(const StraightEdge& edge, double reach_mm, int cells) {
  Moments sum;
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  double all = 0.0;
  const double top = edge.log_posterior(Eigen::Vector2d::Zero());
  for (int a = 0; a < cells; ++a)
    for (int b = 0; b < cells; ++b) {
      const Eigen::Vector2d x(reach_mm * (2.0 * (a + 0.5) / cells - 1.0),
                              reach_mm * (2.0 * (b + 0.5) / cells - 1.0));
      const double weight = std::exp(edge.log_posterior(x) - top);
      all += weight;
      sum.mean += weight * x;
      square += weight * x * x.transpose();
    }
  sum.mean /= all;
  sum.covariance = square / all - sum.mean * sum.mean.transpose();
  return sum;
}

Moments by_messages(const StraightEdge& edge) {
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  std::vector<EdgeSite> sites = edge.sites(x);
  pass_messages(edge.system(x, sites), edge.stray_ratio, sites);
  const SurfaceSystem system = edge.system(x, sites);
  const Eigen::Matrix4d inverse = system.dense().inverse();
  const Eigen::Vector4d move = -inverse * system.gradient;
  Moments found;
  found.mean = {move[3], move[0]};
  found.covariance << inverse(3, 3), inverse(3, 0), inverse(0, 3), inverse(0, 0);
  return found;
}

/// A true edge at 0 and slope 0: points of the given density over s in (-1, 1) and y in (0, 1).
StraightEdge drawn(double density_per_mm, std::uint64_t seed) {
  StraightEdge edge;
  edge.density_per_mm = density_per_mm;
  synthetic::Random random(seed);
  for (double y_mm = -std::log(random.uniform()) / density_per_mm; y_mm < 1.0;
       y_mm -= std::log(random.uniform()) / density_per_mm)
    edge.points.push_back({random.uniform(-1.0, 1.0), y_mm});
  return edge;
}

TEST(EdgePosterior, HasTheMeanAndCovarianceOfTheBoundsThemselves) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const StraightEdge edge = drawn(15.0, seed);
    const Moments truth = by_grid(edge, 0.8, 400), found = by_messages(edge);
    const double sd0_mm = std::sqrt(truth.covariance(0, 0)), sd1_mm = std::sqrt(truth.covariance(1, 1));
    EXPECT_NEAR(found.mean[0], truth.mean[0], 0.25 * sd0_mm) << seed;
    EXPECT_NEAR(found.mean[1], truth.mean[1], 0.25 * sd1_mm) << seed;
    EXPECT_NEAR(std::sqrt(found.covariance(0, 0)) / sd0_mm, 1.0, 0.2) << seed;
    EXPECT_NEAR(std::sqrt(found.covariance(1, 1)) / sd1_mm, 1.0, 0.2) << seed;
  }
}

TEST(EdgePosterior, IsUnbiasedAndAsFarOffAsItSays) {
  double sum = 0.0, squares = 0.0, stated = 0.0;
  constexpr int kDraws = 400;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const Moments found = by_messages(drawn(15.0, seed));
    sum += found.mean[0];
    squares += found.mean[0] * found.mean[0];
    stated += found.covariance(0, 0);
  }
  const double rms_mm = std::sqrt(squares / kDraws);
  EXPECT_LT(std::abs(sum / kDraws), 3.0 * rms_mm / std::sqrt(kDraws) + 0.1 / 15.0);
  EXPECT_NEAR(rms_mm / std::sqrt(stated / kDraws), 1.0, 0.15);
}

/// The same edge with points of the cut's wall among those of the face, `per_mm` of the edge.
StraightEdge drawn_with_wall(double density_per_mm, double per_mm, std::uint64_t seed) {
  StraightEdge edge = drawn(density_per_mm, seed);
  synthetic::Random random(1000 + seed);
  edge.wall = {2.0 * per_mm / density_per_mm, 0.05};  // the edge is 2 mm long
  for (int k = 0; k < 2.0 * per_mm; ++k)
    edge.points.push_back({random.uniform(-1.0, 1.0), edge.wall.sd_mm * random.normal()});
  return edge;
}

TEST(EdgePosterior, WithWallPointsHasTheMeanAndCovarianceOfTheWhole) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const StraightEdge edge = drawn_with_wall(15.0, 3.0, seed);
    const Moments truth = by_grid(edge, 0.8, 400), found = by_messages(edge);
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double sd_mm = std::sqrt(truth.covariance(k, k));
      EXPECT_NEAR(found.mean[k], truth.mean[k], 0.35 * sd_mm) << seed;
      EXPECT_NEAR(std::sqrt(found.covariance(k, k)) / sd_mm, 1.0, 0.4)
          << seed;  // of so few points it may have two humps
    }
  }
}

TEST(EdgePosterior, WallPointsHelpAndDoNotPull) {
  constexpr int kDraws = 300;
  double sum = 0.0, squares = 0.0, stated = 0.0, bare = 0.0, taken_for_face = 0.0;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    StraightEdge edge = drawn_with_wall(15.0, 3.0, seed);
    const Moments found = by_messages(edge);
    sum += found.mean[0] / kDraws;
    squares += found.mean[0] * found.mean[0] / kDraws;
    stated += found.covariance(0, 0) / kDraws;
    edge.wall.width_mm = 0.0;
    taken_for_face += by_messages(edge).mean[0] / kDraws;
    const double without = by_messages(drawn(15.0, seed)).mean[0];
    bare += without * without / kDraws;
  }
  EXPECT_LT(std::abs(sum), 3.0 * std::sqrt(squares / kDraws) + 0.1 / 15.0);
  EXPECT_NEAR(std::sqrt(squares / stated), 1.0, 0.2);
  EXPECT_LT(squares, bare) << "they show where the edge is";
  EXPECT_LT(taken_for_face, -0.03) << "taken for the face's they pull it outward";
}

TEST(EdgePosterior, AFarStrayPullsNothing) {
  StraightEdge edge = drawn(15.0, 3);
  const Moments before = by_messages(edge);
  edge.points.push_back({0.2, -1.5});
  const Moments after = by_messages(edge);
  EXPECT_NEAR(after.mean[0], before.mean[0], 0.1 * std::sqrt(before.covariance(0, 0)));
}

TEST(EdgePosterior, NoBoundNoChange) {
  const StraightEdge edge = drawn(15.0, 1);
  std::vector<EdgeSite> none;
  pass_messages(edge.system(Eigen::Vector2d::Zero(), none), edge.stray_ratio, none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace arris
