// Projects points onto PCL's moving-least-squares surface, a peer of bench/rivals.
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/surface/mls.h>

#include "peers/peers.hpp"

namespace palpate::bench {

std::vector<Eigen::Vector3f> pcl_mls(std::span<const Eigen::Vector3f> points, double radius) {
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  const auto cloud = std::make_shared<Cloud>();
  for (const Eigen::Vector3f& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  pcl::MovingLeastSquares<pcl::PointXYZ, pcl::PointXYZ> mls;
  mls.setInputCloud(cloud);
  mls.setSearchRadius(radius);
  mls.setPolynomialOrder(2);
  Cloud projected;
  mls.process(projected);
  std::vector<Eigen::Vector3f> found;
  for (const pcl::PointXYZ& p : projected) found.emplace_back(p.x, p.y, p.z);
  return found;
}

}  // namespace palpate::bench
