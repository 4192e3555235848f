#include "tests/bench/accuracy/pcl_icp.hpp"

#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

namespace arris::bench {
namespace {

constexpr int kRoundsToPoint = 200;  // PCL's own default is 10
constexpr double kSmallestChange = 1e-10;

template <class Point>
void put(const Eigen::Vector3d& p_mm, Point& point) {
  point.x = static_cast<float>(p_mm.x());
  point.y = static_cast<float>(p_mm.y());
  point.z = static_cast<float>(p_mm.z());
}

template <class Point>
typename pcl::PointCloud<Point>::Ptr cloud_of(std::span<const Eigen::Vector3d> points_mm) {
  auto cloud = pcl::make_shared<pcl::PointCloud<Point>>();
  cloud->resize(points_mm.size());
  for (std::size_t i = 0; i < points_mm.size(); ++i) put(points_mm[i], (*cloud)[i]);
  return cloud;
}

template <class Icp>
RigidMotion run(Icp& icp, int rounds, const RigidMotion& start) {
  icp.setMaximumIterations(rounds);
  icp.setTransformationEpsilon(kSmallestChange);
  icp.setEuclideanFitnessEpsilon(kSmallestChange);
  typename Icp::PointCloudSource carried;
  icp.align(carried, start.matrix().cast<float>());
  RigidMotion motion = RigidMotion::Identity();
  const Eigen::Matrix4d found = icp.getFinalTransformation().template cast<double>();
  motion.linear() =
      Eigen::Quaterniond(Eigen::Matrix3d(found.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
  motion.translation() = found.topRightCorner<3, 1>();
  return motion;
}

}  // namespace

RigidMotion pcl_point_to_point(std::span<const Eigen::Vector3d> model_mm,
                               std::span<const Eigen::Vector3d> data_mm,
                               const RigidMotion& start_scan_from_cad) {
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputSource(cloud_of<pcl::PointXYZ>(model_mm));
  icp.setInputTarget(cloud_of<pcl::PointXYZ>(data_mm));
  return run(icp, kRoundsToPoint, start_scan_from_cad);
}

RigidMotion pcl_point_to_plane(std::span<const Eigen::Vector3d> model_mm,
                               std::span<const Eigen::Vector3d> data_mm,
                               std::span<const Eigen::Vector3d> data_normals,
                               const RigidMotion& start_scan_from_cad, double reach_mm, int most_rounds) {
  const auto data = cloud_of<pcl::PointNormal>(data_mm);
  for (std::size_t i = 0; i < data_normals.size(); ++i)
    (*data)[i].getNormalVector3fMap() = data_normals[i].cast<float>();
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setInputSource(cloud_of<pcl::PointNormal>(model_mm));
  icp.setInputTarget(data);
  icp.setMaxCorrespondenceDistance(reach_mm);
  return run(icp, most_rounds, start_scan_from_cad);
}

}  // namespace arris::bench
