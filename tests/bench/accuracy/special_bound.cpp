// What scans can show of a part's edges at best. The posterior mean of the pose in the plane and of each
// contour's size, given all that a program cannot know: how the part is deformed, that no point is a stray
// and the density of the points. No estimator has a smaller mean square error over scans of these densities.

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fixtures/synthetic/random.hpp"
#include "tests/bench/accuracy/case.hpp"
#include "tests/bench/accuracy/special.hpp"

namespace arris::bench {
namespace {

constexpr double kReachEdgeLimits = 12.0;  // points deeper in the material bound nothing
constexpr double kMostSizeMm = 2.0;        // a contour larger or smaller than drawn, all round
constexpr int kMoves = 60000, kWarmUp = 10000;
constexpr MeanMax kMedianGoalMm{0.03, 0.07};

/// Shift (2), turn (times the farthest edge's distance) and the contours' sizes: how far each moves an edge
/// towards the void. Every point must stay on material, and by Poisson's law an area without points costs its
/// density: log p = -density * sum(length * size), within bounds that are linear in the motion.
class EdgeBound {
 public:
  explicit EdgeBound(const std::vector<synthetic::EdgePoint>& edge)
      : edge_(edge), ranges_(synthetic::contour_ranges(edge)) {
    for (const synthetic::EdgePoint& e : edge_) {
      middle_mm_ += e.true_mm / static_cast<double>(edge_.size());
      normal_ += e.true_normal;
    }
    normal_.normalize();
    x_ = normal_.unitOrthogonal();
    y_ = normal_.cross(x_);
    for (const synthetic::EdgePoint& e : edge_)
      size_mm_ = std::max(size_mm_, (e.true_mm - middle_mm_).norm());
  }

  /// Mean and greatest error of the edge by the posterior mean; points in the CAD frame, deformed.
  [[nodiscard]] MeanMax error_mm(const std::vector<Eigen::Vector3d>& points_mm, double edge_limit_mm,
                                 std::uint64_t seed) {
    bound_by(points_mm, kReachEdgeLimits * edge_limit_mm);
    const Eigen::VectorXd mean = posterior_mean(1.0 / (50.0 * edge_limit_mm), seed);
    MeanMax error;
    for (std::size_t i = 0; i < edge_.size(); ++i) {
      const double off_mm = std::abs(row_at(i).dot(mean));
      error.mean_mm += off_mm / static_cast<double>(edge_.size());
      error.max_mm = std::max(error.max_mm, off_mm);
    }
    return error;
  }

 private:
  [[nodiscard]] Eigen::Index freedom() const { return 3 + static_cast<Eigen::Index>(ranges_.size()); }

  /// How far the edge at sample i moves towards the void.
  [[nodiscard]] Eigen::VectorXd row_at(std::size_t i) const {
    const Eigen::Vector3d& to_void = edge_[i].true_void;
    Eigen::VectorXd row = Eigen::VectorXd::Zero(freedom());
    row[0] = to_void.dot(x_);
    row[1] = to_void.dot(y_);
    row[2] = to_void.dot(normal_.cross(edge_[i].true_mm - middle_mm_)) / size_mm_;
    for (std::size_t c = 0; c < ranges_.size(); ++c)
      if (i >= ranges_[c].begin && i < ranges_[c].end) row[3 + static_cast<Eigen::Index>(c)] = 1.0;
    return row;
  }

  void bound_by(const std::vector<Eigen::Vector3d>& points_mm, double reach_mm) {
    std::vector<Eigen::VectorXd> rows;
    std::vector<double> depths_mm;
    for (const Eigen::Vector3d& p : points_mm) {
      const auto near = std::min_element(edge_.begin(), edge_.end(), [&](const auto& a, const auto& b) {
        return (a.true_mm - p).squaredNorm() < (b.true_mm - p).squaredNorm();
      });
      if ((near->true_mm - p).norm() > reach_mm) continue;
      rows.push_back(row_at(static_cast<std::size_t>(near - edge_.begin())));
      depths_mm.push_back(std::max(0.0, (near->true_mm - p).dot(near->true_void)));
    }
    rows_.resize(static_cast<Eigen::Index>(rows.size()), freedom());
    depths_mm_.resize(rows_.rows());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows_.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
      depths_mm_[static_cast<Eigen::Index>(i)] = depths_mm[i];
    }
  }

  /// Hit and run (Smith, Operations Research 32, 1984): along a random line through the place the posterior
  /// is an exponential between two bounds.
  [[nodiscard]] Eigen::VectorXd posterior_mean(double density_per_mm2, std::uint64_t seed) const {
    synthetic::Random random(seed);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(freedom());
    for (std::size_t c = 0; c < ranges_.size(); ++c)
      gradient[3 + static_cast<Eigen::Index>(c)] = -density_per_mm2 * ranges_[c].length_mm;
    Eigen::VectorXd at = Eigen::VectorXd::Zero(freedom()), mean = at,
                    moved_mm = Eigen::VectorXd::Zero(rows_.rows());
    for (int move = 0; move < kMoves; ++move) {
      Eigen::VectorXd along(freedom());
      for (Eigen::Index k = 0; k < along.size(); ++k)
        along[k] = move % 2 == 0 ? random.normal() : (move / 2 % freedom() == k ? 1.0 : 0.0);
      const Eigen::VectorXd rate = rows_ * along;
      double low = -std::numeric_limits<double>::max(), high = -low;
      const auto bound = [&](double speed, double room) {  // speed * t >= -room
        if (speed > 1e-12) low = std::max(low, -room / speed);
        if (speed < -1e-12) high = std::min(high, -room / speed);
      };
      for (Eigen::Index i = 0; i < rate.size(); ++i) bound(rate[i], depths_mm_[i] + moved_mm[i]);
      for (Eigen::Index k = 3; k < freedom(); ++k) {
        bound(along[k], kMostSizeMm + at[k]);
        bound(-along[k], kMostSizeMm - at[k]);
      }
      const double t = drawn(gradient.dot(along), low, high, random.uniform(0.0, 1.0));
      at += t * along;
      moved_mm += t * rate;
      if (move >= kWarmUp) mean += at / (kMoves - kWarmUp);
    }
    return mean;
  }

  /// A draw from exp(slope * t) between low and high.
  static double drawn(double slope, double low, double high, double u) {
    const double most = slope * (high - low);
    if (std::abs(most) < 1e-9) return low + u * (high - low);
    return most > 0.0 ? high + std::log(u + (1.0 - u) * std::exp(-most)) / slope
                      : low + std::log(1.0 - u * (1.0 - std::exp(most))) / slope;
  }

  const std::vector<synthetic::EdgePoint>& edge_;
  std::vector<synthetic::EdgeRange> ranges_;
  Eigen::Vector3d middle_mm_ = Eigen::Vector3d::Zero(), normal_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_ = Eigen::Vector3d::UnitX(), y_ = Eigen::Vector3d::UnitY();
  double size_mm_ = 0.0;
  Eigen::MatrixXd rows_;       // one a point near an edge
  Eigen::VectorXd depths_mm_;  // of the point in the material
};

struct BoundScans {
  std::vector<MeanMax> errors;
  double edge_limit_mm = 0.0;  ///< mean over the scans
};

BoundScans bound_scans(const std::string& name, const SpecialSetup& setup) {
  const BenchPart part(setup.fixtures / name, setup.threads);
  const BenchCase usual = bench_cases().front();
  EdgeBound bound(part.truth.edge());
  BoundScans scans;
  for (int seed = 1; seed <= setup.seeds; ++seed) {
    const synthetic::SyntheticScan scan = sample_scan(part.fe, usual.scan, static_cast<std::uint64_t>(seed));
    const RigidMotion cad_from_scan = scan.scan_from_cad.inverse();
    std::vector<Eigen::Vector3d> points_mm;
    for (const Eigen::Vector3d& p : scan.points_mm) points_mm.push_back(cad_from_scan * p);
    scans.errors.push_back(bound.error_mm(points_mm, scan.edge_limit_mm(), static_cast<std::uint64_t>(seed)));
    scans.edge_limit_mm += scan.edge_limit_mm() / setup.seeds;
  }
  return scans;
}

GoalRow mean_row(const std::string& name, const MeanMax& goal_edge_limits, const BoundScans& scans) {
  const double edge_limit_mm = scans.edge_limit_mm;
  const MeanMax goal_mm{goal_edge_limits.mean_mm * edge_limit_mm, goal_edge_limits.max_mm * edge_limit_mm};
  GoalRow row;
  row.what = "by the best estimator there is (deformation and density known, no strays), " +
             bench_cases().front().name;
  row.part = name;
  row.goal = fmt::format("{} ({:.2f} / {:.1f} E)", text_of(goal_mm), goal_edge_limits.mean_mm,
                         goal_edge_limits.max_mm);
  judge(row, scans.errors, 0, goal_mm);
  MeanMax mean;
  for (const MeanMax& error : scans.errors) {
    mean.mean_mm += error.mean_mm / static_cast<double>(scans.errors.size());
    mean.max_mm += error.max_mm / static_cast<double>(scans.errors.size());
  }
  row.reached +=
      fmt::format(" ({:.2f} / {:.2f} E)", mean.mean_mm / edge_limit_mm, mean.max_mm / edge_limit_mm);
  return row;
}

GoalRow median_row(const std::string& name, const BoundScans& scans) {
  GoalRow row;
  row.what = "median over the scans, by the best estimator there is";
  row.part = name;
  row.goal = text_of(kMedianGoalMm);
  judge(row, scans.errors, 0, kMedianGoalMm);
  const MeanMax median_mm = medians(scans.errors, scans.errors.size());
  row.reached = text_of(median_mm);
  row.met = median_mm.within(kMedianGoalMm);
  return row;
}

}  // namespace

std::vector<GoalRow> bound_rows(const SpecialSetup& setup) {
  const BoundScans bracket = bound_scans("bracket", setup);
  return {mean_row("porthole", {0.2, 0.6}, bound_scans("porthole", setup)),
          mean_row("bracket", {0.35, 1.5}, bracket), median_row("bracket", bracket)};
}

}  // namespace arris::bench
