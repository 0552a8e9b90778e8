// Makes depth frames touchable with PCL, as a peer of the depth path.
#include <pcl/common/io.h>
#include <pcl/features/integral_image_normal.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <cmath>
#include <limits>
#include <vector>

#include "peers/peers.hpp"

namespace palpate::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr back_project(const DepthFrame& frame) {
  Cloud::Ptr cloud(new Cloud(static_cast<unsigned>(frame.camera.width),
                             static_cast<unsigned>(frame.camera.height)));
  cloud->is_dense = false;
  const Pinhole& pinhole = frame.camera.pinhole;
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const auto width = static_cast<std::size_t>(frame.camera.width);
    const float z = frame.depth[i] > 0 ? frame.depth[i] : std::numeric_limits<float>::quiet_NaN();
    pcl::PointXYZ& p = (*cloud)[i];
    p.x = static_cast<float>((static_cast<double>(i % width) - pinhole.cx) / pinhole.fx) * z;
    p.y = static_cast<float>((static_cast<double>(i / width) - pinhole.cy) / pinhole.fy) * z;
    p.z = z;
  }
  return cloud;
}

template <class Point>
typename pcl::PointCloud<Point>::Ptr thin(const typename pcl::PointCloud<Point>::Ptr& cloud,
                                          float leaf) {
  pcl::VoxelGrid<Point> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(leaf, leaf, leaf);
  typename pcl::PointCloud<Point>::Ptr thinned(new pcl::PointCloud<Point>);
  grid.filter(*thinned);
  return thinned;
}

template <class Point>
double mean_spacing(const pcl::search::KdTree<Point>& tree, const pcl::PointCloud<Point>& cloud) {
  constexpr int kNearest = 3;  // derived: as the row spacing_k3
  std::vector<int> indices(kNearest + 1);
  std::vector<float> squared(kNearest + 1);
  double sum = 0;
  for (const Point& p : cloud) {
    const int found = tree.nearestKSearch(p, kNearest + 1, indices, squared);
    for (int j = 1; j < found; ++j) sum += std::sqrt(squared[static_cast<std::size_t>(j)]);
  }
  return sum / static_cast<double>(kNearest * cloud.size());
}

}  // namespace

std::size_t pcl_pipeline(const DepthFrame& frame, float leaf) {
  const Cloud::Ptr cloud = thin<pcl::PointXYZ>(back_project(frame), leaf);
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>(false));
  tree->setInputCloud(cloud);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(tree);
  estimation.setRadiusSearch(2.5 * leaf);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  return mean_spacing(*tree, *cloud) > 0 ? normals.size() : 0;
}

std::size_t pcl_organised_pipeline(const DepthFrame& frame, float leaf) {
  const Cloud::Ptr cloud = back_project(frame);
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.AVERAGE_3D_GRADIENT);
  estimation.setMaxDepthChangeFactor(0.02F);
  estimation.setNormalSmoothingSize(10);
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  pcl::PointCloud<pcl::PointNormal>::Ptr joined(new pcl::PointCloud<pcl::PointNormal>);
  pcl::concatenateFields(*cloud, normals, *joined);
  const auto thinned = thin<pcl::PointNormal>(joined, leaf);
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree(new pcl::search::KdTree<pcl::PointNormal>(false));
  tree->setInputCloud(thinned);
  return mean_spacing(*tree, *thinned) > 0 ? thinned->size() : 0;
}

}  // namespace palpate::bench
