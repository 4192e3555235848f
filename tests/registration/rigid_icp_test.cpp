#include "registration/rigid_icp.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "registration/coarse_align.hpp"
#include "registration/normal_equations.hpp"
#include "registration/registration.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using scenes::Trial;
using synthetic::PlatePart;

synthetic::PlateShape flat(synthetic::PlateShape shape) {
  shape.bend_curvature_per_mm = shape.twist_rad_per_mm = 0.0;
  return shape;
}

/// Largest distance between the two images of the contour's points.
double apart_mm(const Curve& curve, const RigidMotion& a, const RigidMotion& b) {
  double most = 0.0;
  for (const Eigen::Vector3d& p : curve.contour().points_mm) most = std::max(most, (a * p - b * p).norm());
  return most;
}

std::vector<Eigen::Vector3d> carried(const std::vector<Eigen::Vector3d>& points, const RigidMotion& motion) {
  std::vector<Eigen::Vector3d> out;
  for (const Eigen::Vector3d& p : points) out.push_back(motion * p);
  return out;
}

/// Kabsch by SVD: shares nothing with Horn's quaternion.
RigidMotion kabsch(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = a;
  const double n = static_cast<double>(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) a += from[i] / n, b += to[i] / n;
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) h += (from[i] - a) * (to[i] - b).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(h, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  sign(2, 2) = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
  RigidMotion out = RigidMotion::Identity();
  out.linear() = svd.matrixV() * sign * svd.matrixU().transpose();
  out.translation() = b - out.linear() * a;
  return out;
}

/// The loop of the paper with nothing but loops: returns the motion and counts its rounds.
RigidMotion brute_force_icp(const std::vector<Eigen::Vector3d>& model,
                            const std::vector<Eigen::Vector3d>& data, RigidMotion motion, double delta,
                            int k_max, int& rounds) {
  double last = 1e300;
  for (rounds = 0; rounds < k_max;) {
    std::vector<Eigen::Vector3d> partner;
    for (const Eigen::Vector3d& p : model) {
      std::size_t best = 0;
      for (std::size_t j = 1; j < data.size(); ++j)
        if ((data[j] - motion * p).squaredNorm() < (data[best] - motion * p).squaredNorm()) best = j;
      partner.push_back(data[best]);
    }
    motion = kabsch(model, partner);
    double sum2 = 0.0;
    for (std::size_t i = 0; i < model.size(); ++i) sum2 += (motion * model[i] - partner[i]).squaredNorm();
    const double rms = std::sqrt(sum2 / static_cast<double>(model.size()));
    ++rounds;
    if (std::abs(last - rms) <= delta * rms) break;
    last = rms;
  }
  return motion;
}

class PointToPoint : public testing::Test {
 protected:
  PlatePart part_{flat(synthetic::plate_with_rounded_rectangle())};
  std::vector<Eigen::Vector3d> model_mm_ = part_.nominal_curve(0, 4.0);
  synthetic::Random random_{7};
  RigidMotion truth_ = scenes::disturbance(random_, {500.0, 0.0, 0.0}, 2.0, 300.0);
};

TEST_F(PointToPoint, RecoversAMotionExactlyWhenThePointsAreTheSame) {
  const std::vector<Eigen::Vector3d> data_mm = carried(model_mm_, truth_);
  const NearestPoints tree(data_mm);
  const RigidMotion start = truth_ * scenes::disturbance(random_, {20.0, 10.0, 0.0}, 0.01, 0.8);
  const RigidIcpResult result = icp_point_to_point(model_mm_, tree, data_mm, start, {});
  ASSERT_TRUE(result.usable()) << result.reason;
  EXPECT_LT((result.scan_from_cad.matrix() - truth_.matrix()).norm(), 1e-8);
  EXPECT_LT(result.rms_mm, 1e-9);
  EXPECT_EQ(result.stop, "converged");
}

TEST_F(PointToPoint, AgreesWithABruteForceTwinRoundByRound) {
  std::vector<Eigen::Vector3d> data_mm = carried(part_.nominal_curve(0, 3.1), truth_);
  for (Eigen::Vector3d& p : data_mm)
    p += 0.3 * Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
  const NearestPoints tree(data_mm);
  const RigidMotion start = truth_ * scenes::disturbance(random_, {20.0, 10.0, 0.0}, 0.08, 6.0);
  for (const int k_max : {1, 2, 5, 60}) {
    RigidIcpOptions options;
    options.max_iterations = k_max;
    const RigidIcpResult result = icp_point_to_point(model_mm_, tree, data_mm, start, options);
    int rounds = 0;
    const RigidMotion twin =
        brute_force_icp(model_mm_, data_mm, start, options.stop_change_ratio, options.max_iterations, rounds);
    EXPECT_EQ(result.iterations, rounds);
    EXPECT_LT((result.scan_from_cad.matrix() - twin.matrix()).norm(), 1e-8);
  }
}

TEST_F(PointToPoint, GoesOnWhileTheChangeExceedsDeltaAndRoundsAreLeft) {
  std::vector<Eigen::Vector3d> data_mm = carried(part_.nominal_curve(0, 3.1), truth_);
  const NearestPoints tree(data_mm);
  const RigidMotion start = truth_ * scenes::disturbance(random_, {20.0, 10.0, 0.0}, 0.1, 8.0);
  RigidIcpOptions options;
  options.stop_change_ratio = 1e-3;
  const RigidIcpResult full = icp_point_to_point(model_mm_, tree, data_mm, start, options);
  ASSERT_EQ(full.stop, "converged");
  ASSERT_LT(full.iterations, options.max_iterations);
  ASSERT_GT(full.iterations, 3);
  double last_mm = 1e300;
  for (int k = 1; k <= full.iterations; ++k) {
    options.max_iterations = k;
    const RigidIcpResult result = icp_point_to_point(model_mm_, tree, data_mm, start, options);
    EXPECT_EQ(result.iterations, k);
    EXPECT_LE(result.rms_mm, last_mm + 1e-12);  // eq. 2 never rises
    const bool small_change = std::abs(last_mm - result.rms_mm) <= options.stop_change_ratio * result.rms_mm;
    EXPECT_EQ(result.stop, small_change ? "converged" : "iteration limit") << k;
    EXPECT_EQ(small_change, k == full.iterations) << k;
    last_mm = result.rms_mm;
  }
}

class PointToPlane : public testing::Test {
 protected:
  PlatePart part_{flat(synthetic::plate_with_rounded_rectangle())};
  CadModel cad_ = scenes::cad_of(part_);
  synthetic::Random random_{11};
  const Curve& curve() const { return cad_.contours.front(); }
};

TEST_F(PointToPlane, RecoversAKnownPoseExactlyWithoutNoise) {
  scenes::IdealOptions ideal;
  ideal.noise_sigma_mm = 0.0;
  const Trial trial = scenes::ideal_trial(part_, ideal, 3);
  for (int i = 0; i < 5; ++i) {
    const RigidMotion truth = scenes::disturbance(random_, {0, 0, 0}, random_.uniform(0.0, 3.0), 500.0);
    const RigidMotion start = truth * scenes::disturbance(random_, {20.0, 10.0, 0.0}, 0.1, 8.0);
    const RigidIcpResult result = icp_point_to_plane(cad_, scenes::moved(trial.scan, truth), start, {});
    ASSERT_TRUE(result.usable()) << result.reason;
    // The contour is a polyline of 1 mm chords, 0.006 mm inside its corners.
    EXPECT_LT(apart_mm(curve(), result.scan_from_cad, truth), 0.006);
    EXPECT_LT(result.surface_rms_mm, 1e-3);
  }
}

TEST_F(PointToPlane, RecoversAKnownPoseToTheNoiseOverRootN) {
  scenes::IdealOptions ideal;
  ideal.noise_sigma_mm = 0.2;
  double sum2 = 0.0;
  std::size_t edge_points = 0;
  const int runs = 12;
  for (int i = 0; i < runs; ++i) {
    const Trial trial = scenes::ideal_trial(part_, ideal, 20 + static_cast<std::uint64_t>(i));
    edge_points = trial.scan.edge_mm.size();
    const RigidMotion truth = scenes::disturbance(random_, {0, 0, 0}, 1.0, 100.0);
    const RigidMotion start = truth * scenes::disturbance(random_, {20.0, 10.0, 0.0}, 0.05, 5.0);
    const RigidIcpResult result = icp_point_to_plane(cad_, scenes::moved(trial.scan, truth), start, {});
    ASSERT_TRUE(result.usable()) << result.reason;
    sum2 += std::pow(apart_mm(curve(), result.scan_from_cad, truth), 2);
  }
  // Each edge point gives two rows for six unknowns: a placed point has an rms of sigma sqrt(6 / (2 n)) a row
  // on average over the contour; what is judged is the farthest point, in three directions.
  const double expected_mm = 0.2 * std::sqrt(3.0 / static_cast<double>(edge_points));
  EXPECT_LT(std::sqrt(sum2 / runs), 3.5 * expected_mm);
}

TEST_F(PointToPlane, MovingScanAndCadTogetherChangesNothing) {
  const Trial trial = scenes::ideal_trial(part_, {}, 5);
  const RigidMotion start = scenes::disturbance(random_, {20.0, 10.0, 0.0}, 0.05, 5.0);
  const RigidIcpResult plain = icp_point_to_plane(cad_, trial.scan, start, {});
  for (int i = 0; i < 6; ++i) {
    const double far_mm = i < 3 ? 100.0 : 10000.0;
    const RigidMotion a = scenes::disturbance(random_, {0, 0, 0}, random_.uniform(0.0, 3.1), far_mm);
    const RigidMotion b = scenes::disturbance(random_, {0, 0, 0}, random_.uniform(0.0, 3.1), far_mm);
    TriangleMesh mesh = part_.cad_mesh(20.0);
    for (Eigen::Vector3d& p : mesh.vertices_mm) p = b * p;
    Contour contour = curve().contour();
    for (Eigen::Vector3d& p : contour.points_mm) p = b * p;
    for (Eigen::Vector3d& n : contour.normals) n = b.linear() * n;
    const CadModel moved_cad = prepare_cad(mesh, {contour});
    const RigidIcpResult result =
        icp_point_to_plane(moved_cad, scenes::moved(trial.scan, a), a * start * b.inverse(), {});
    ASSERT_TRUE(result.usable());
    EXPECT_EQ(result.iterations, plain.iterations);
    EXPECT_LT(apart_mm(curve(), a.inverse() * result.scan_from_cad * b, plain.scan_from_cad), 1e-6) << far_mm;
  }
}

TEST_F(PointToPlane, SameBytesForAnyThreadCount) {
  const Trial trial = scenes::ideal_trial(part_, {}, 5);
  RigidIcpOptions options;
  options.threads = 1;
  const RigidIcpResult one = icp_point_to_plane(cad_, trial.scan, RigidMotion::Identity(), options);
  for (const int threads : {2, 8}) {
    options.threads = threads;
    const RigidIcpResult many = icp_point_to_plane(cad_, trial.scan, RigidMotion::Identity(), options);
    EXPECT_EQ(one.scan_from_cad.matrix(), many.scan_from_cad.matrix());
    EXPECT_EQ(one.information, many.information);
  }
}

TEST_F(PointToPlane, RefusesAScanFarAway) {
  const Trial trial = scenes::ideal_trial(part_, {}, 5);
  RigidMotion far = RigidMotion::Identity();
  far.translation().x() = 5000.0;
  const RigidIcpResult result = icp_point_to_plane(cad_, trial.scan, far, {});
  EXPECT_FALSE(result.usable());
  EXPECT_NE(result.reason.find("6"), std::string::npos) << result.reason;
}

TEST(FreeDirections, CircleInAPlaneTurnsAboutItsAxisAndNothingElse) {
  const PlatePart part(flat(synthetic::plate_with_circle(60.0)));  // about (15, -10)
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {}, 2);
  const RigidIcpResult fit = icp_point_to_plane(cad, trial.scan, RigidMotion::Identity(), {});
  const std::vector<std::string> free = free_directions(fit.information, fit.pivot_mm, 60.0);
  ASSERT_EQ(free.size(), 1u);
  double axis[3], at[3];
  ASSERT_EQ(std::sscanf(free[0].c_str(), "turn about the axis (%lf %lf %lf) through (%lf %lf %lf) mm",
                        &axis[0], &axis[1], &axis[2], &at[0], &at[1], &at[2]),
            6)
      << free[0];
  EXPECT_NEAR(std::abs(axis[2]), 1.0, 1e-3);
  EXPECT_NEAR(at[0], 15.0, 0.5);
  EXPECT_NEAR(at[1], -10.0, 0.5);
}

TEST(FreeDirections, RoundedRectangleLeavesNoneFree) {
  const PlatePart part(flat(synthetic::plate_with_rounded_rectangle()));
  const CadModel cad = scenes::cad_of(part);
  const Trial trial = scenes::ideal_trial(part, {}, 2);
  const RigidIcpResult fit = icp_point_to_plane(cad, trial.scan, RigidMotion::Identity(), {});
  EXPECT_TRUE(free_directions(fit.information, fit.pivot_mm, 90.0).empty());
}

TEST(FreeDirections, PlaneLeavesThreeAndPlaneWithAStraightEdgeOne) {
  NormalEquations sum;
  for (double x = -50.0; x <= 50.0; x += 10.0)
    for (double y = 0.0; y <= 50.0; y += 10.0) sum.add({x, y, 0.0}, Eigen::Vector3d::UnitZ(), 0.0, 1.0);
  EXPECT_EQ(free_directions(sum.information, Eigen::Vector3d::Zero(), 50.0).size(), 3u);
  for (double x = -50.0; x <= 50.0; x += 10.0) sum.add({x, 0.0, 0.0}, Eigen::Vector3d::UnitY(), 0.0, 1.0);
  const std::vector<std::string> free = free_directions(sum.information, Eigen::Vector3d::Zero(), 50.0);
  ASSERT_EQ(free.size(), 1u);
  double axis[3];
  ASSERT_EQ(std::sscanf(free[0].c_str(), "shift along (%lf %lf %lf)", &axis[0], &axis[1], &axis[2]), 3)
      << free[0];
  EXPECT_NEAR(std::abs(axis[0]), 1.0, 1e-3);
}

TEST(FreeDirections, AxisPassesWhereTheScrewStandsStill) {
  // A turn about (0 0 1) through (30, -40, 0), seen from a pivot elsewhere: everything else is held.
  const Eigen::Vector3d pivot_mm(10.0, -20.0, 5.0), through_mm(30.0, -40.0, 0.0),
      axis = Eigen::Vector3d::UnitZ();
  Eigen::Matrix<double, 6, 1> screw;
  screw << 50.0 * axis / 50.0, axis.cross(pivot_mm - through_mm);
  Eigen::Matrix<double, 6, 1> scale;  // in the scaled space a turn counts `size` mm a radian
  scale << Eigen::Vector3d::Constant(50.0), Eigen::Vector3d::Ones();
  const Eigen::Matrix<double, 6, 1> unit = scale.cwiseProduct(screw).normalized();
  const Eigen::Matrix<double, 6, 6> held = Eigen::Matrix<double, 6, 6>::Identity() - unit * unit.transpose();
  const std::vector<std::string> free =
      free_directions(scale.asDiagonal() * held * scale.asDiagonal(), pivot_mm, 50.0);
  ASSERT_EQ(free.size(), 1u);
  double a[3], at[3];
  ASSERT_EQ(std::sscanf(free[0].c_str(), "turn about the axis (%lf %lf %lf) through (%lf %lf %lf)", &a[0],
                        &a[1], &a[2], &at[0], &at[1], &at[2]),
            6)
      << free[0];
  EXPECT_NEAR(at[0], through_mm.x(), 0.2);
  EXPECT_NEAR(at[1], through_mm.y(), 0.2);
}

TEST(RigidIcpOptions, RefusesValuesOutOfRange) {
  RigidIcpOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(options.check(), std::exception);
  options.max_iterations = 5;
  options.stop_change_ratio = 0.0;
  EXPECT_THROW(options.check(), std::exception);
}

/// The small motion of the part, about `about_mm` in the CAD frame, that the found pose is off by.
Eigen::Matrix<double, 6, 1> pose_error(const RigidMotion& true_pose, const RigidMotion& found,
                                       const Eigen::Vector3d& about_mm) {
  const RigidMotion error = true_pose.inverse() * found;  // of the part, CAD frame
  const Eigen::AngleAxisd turn(error.linear());
  Eigen::Matrix<double, 6, 1> out;
  out << turn.angle() * turn.axis(), error * about_mm - about_mm;
  return out;
}

TEST(RigidCovariance, StatesTheScatterOfThePoseOverManyScansOfAnUndeformedPart) {
  synthetic::PlateShape shape = synthetic::asymmetric_plate();
  shape.twist_rad_per_mm = shape.bend_curvature_per_mm = 0.0;
  const synthetic::PlatePart part(shape);
  const CadModel cad = scenes::cad_of(part);
  const int runs = 40;
  std::vector<Eigen::Matrix<double, 6, 1>> errors;
  Eigen::Matrix<double, 6, 6> stated = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  for (int run = 0; run < runs; ++run) {
    Trial trial = scenes::trial_of(part, {}, 500 + static_cast<std::uint64_t>(run));
    RegistrationOptions options;
    options.coarse.initial_scan_from_cad = trial.scan_from_cad;
    const Registration found = register_part(cad, trial.scan, options);
    ASSERT_TRUE(found.usable()) << found.refusals.front();
    errors.push_back(pose_error(trial.scan_from_cad, found.rigid.scan_from_cad, found.rigid.pivot_mm));
    mean += errors.back() / runs;
    stated += found.rigid.covariance / runs;
  }
  for (int i = 0; i < 6; ++i) {
    double scatter2 = 0.0;
    for (const auto& e : errors) scatter2 += std::pow(e[i] - mean[i], 2) / (runs - 1);
    const double ratio = std::sqrt(stated(i, i) / scatter2);
    EXPECT_GT(ratio, 0.5) << "direction " << i << ", true sd " << std::sqrt(scatter2);
    EXPECT_LT(ratio, 2.0) << "direction " << i << ", true sd " << std::sqrt(scatter2);
    RecordProperty("ratio_percent_" + std::to_string(i), static_cast<int>(100 * ratio));
  }
}

TEST(RigidCovariance, OfAFreeTurnIsNoSmallNumber) {
  const synthetic::PlatePart part(synthetic::plate_with_circle());
  const CadModel cad = scenes::cad_of(part);
  Trial trial = scenes::trial_of(part, {}, 3);
  const Registration found = register_part(cad, trial.scan, {});
  ASSERT_TRUE(found.usable());
  ASSERT_EQ(found.free_directions.size(), 1u);
  EXPECT_NEAR(found.rigid.covariance(2, 2), 1.0, 0.05);  // about z, rad^2
  EXPECT_LT(std::sqrt(found.rigid.covariance(5, 5)), 0.1);
}

}  // namespace
}  // namespace arris
