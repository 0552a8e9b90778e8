// Measures PCL's kd-tree, octree and normals as peers of the index.
#include <pcl/features/normal_3d.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_search.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <cmath>

#include "peers/peers.hpp"

namespace palpate::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

class KdTreePeer final : public Peer {
 public:
  explicit KdTreePeer(Cloud::ConstPtr cloud)
      : cloud_(std::move(cloud)), tree_(new pcl::search::KdTree<pcl::PointXYZ>(false)) {
    tree_->setInputCloud(cloud_);
  }

  double mean_spacing(std::size_t k) override {
    std::vector<int> indices(k + 1);
    std::vector<float> squared(k + 1);
    double sum = 0;
    for (const pcl::PointXYZ& p : *cloud_) {
      tree_->nearestKSearch(p, static_cast<int>(k + 1), indices, squared);
      for (std::size_t j = 1; j <= k; ++j) sum += std::sqrt(squared[j]);
    }
    return sum / static_cast<double>(k * cloud_->size());
  }

  std::vector<Eigen::Vector3f> normals(float radius, const Eigen::Vector3f& viewpoint) override {
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud_);
    estimation.setSearchMethod(tree_);
    estimation.setRadiusSearch(radius);
    estimation.setViewPoint(viewpoint.x(), viewpoint.y(), viewpoint.z());
    pcl::PointCloud<pcl::Normal> estimated;
    estimation.compute(estimated);
    std::vector<Eigen::Vector3f> normals;
    normals.reserve(estimated.size());
    for (const pcl::Normal& n : estimated) {
      const bool defined = std::isfinite(n.normal_x);
      normals.push_back(defined ? Eigen::Vector3f(n.getNormalVector3fMap())
                                : Eigen::Vector3f(0, 0, 0));
    }
    return normals;
  }

 private:
  Cloud::ConstPtr cloud_;
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree_;
};

class PclPoints final : public PclCloud {
 public:
  explicit PclPoints(std::span<const Eigen::Vector3f> points) {
    const auto cloud = std::make_shared<Cloud>();
    cloud->reserve(points.size());
    for (const Eigen::Vector3f& p : points) cloud->push_back({p.x(), p.y(), p.z()});
    cloud_ = cloud;
  }

  [[nodiscard]] std::unique_ptr<Peer> make_kdtree() const override {
    return std::make_unique<KdTreePeer>(cloud_);
  }

  [[nodiscard]] std::size_t build_octree(double leaf) const override {
    pcl::octree::OctreePointCloudSearch<pcl::PointXYZ> octree(leaf);
    octree.setInputCloud(cloud_);
    octree.addPointsFromInputCloud();
    return octree.getLeafCount();
  }

 private:
  Cloud::ConstPtr cloud_;
};

}  // namespace

std::unique_ptr<PclCloud> make_pcl_cloud(std::span<const Eigen::Vector3f> points) {
  return std::make_unique<PclPoints>(points);
}

}  // namespace palpate::bench
