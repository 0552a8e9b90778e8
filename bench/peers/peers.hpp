#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::bench {

/// A peer's index over points, and what the speed tables ask of it. Distances in metres.
class Peer {
 public:
  virtual ~Peer() = default;
  /// Mean over all points of the mean distance to the k nearest others.
  virtual double mean_spacing(std::size_t k) = 0;
  /// Normals from all points within `radius`, one for each point in the input's order, zero where
  /// undefined, turned to `viewpoint`.
  virtual std::vector<Eigen::Vector3f> normals(float radius, const Eigen::Vector3f& viewpoint) = 0;
};

/// nanoflann's KD-tree (leaf of 10, its default), with Eigen's SelfAdjointEigenSolver for normals.
[[nodiscard]] std::unique_ptr<Peer> make_nanoflann(std::span<const Eigen::Vector3f> points);

/// A PCL cloud, made beforehand so that the tables do not count the copying.
class PclCloud {
 public:
  virtual ~PclCloud() = default;
  /// KdTreeFLANN with its defaults; NormalEstimation for normals.
  [[nodiscard]] virtual std::unique_ptr<Peer> make_kdtree() const = 0;
  /// Builds an octree (OctreePointCloudSearch) with leaves of this size; returns its leaves.
  [[nodiscard]] virtual std::size_t build_octree(double leaf) const = 0;
};

/// Null in builds without PCL.
[[nodiscard]] std::unique_ptr<PclCloud> make_pcl_cloud(std::span<const Eigen::Vector3f> points);

/// The points on their own surface by MovingLeastSquares of order 2, in the input's order. Weights
/// fall to 1/e at the radius (m), where they end. Empty in builds without PCL.
[[nodiscard]] std::vector<Eigen::Vector3f> pcl_mls(std::span<const Eigen::Vector3f> points,
                                                   double radius);

/// The peers' pipelines that make a depth frame touchable: points, normals and an index over them,
/// and the mean distance to the three nearest others, on one thread. Returns the number of points,
/// 0 in builds without PCL.

/// Back-projection, VoxelGrid with this leaf (m), KdTreeFLANN, NormalEstimation within 2.5 s, s the
/// leaf, and the k = 3 spacing.
[[nodiscard]] std::size_t pcl_pipeline(const DepthFrame& frame, float leaf);

/// Back-projection, IntegralImageNormalEstimation (AVERAGE_3D_GRADIENT), VoxelGrid over points with
/// normals, KdTreeFLANN and the k = 3 spacing.
[[nodiscard]] std::size_t pcl_organised_pipeline(const DepthFrame& frame, float leaf);

}  // namespace palpate::bench
