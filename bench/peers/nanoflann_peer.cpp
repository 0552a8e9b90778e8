// Measures nanoflann's kd-tree as a peer of the index.
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <utility>

#include "peers/nanoflann_tree.hpp"
#include "peers/peers.hpp"

namespace palpate::bench {
namespace {

class NanoflannPeer final : public Peer {
 public:
  explicit NanoflannPeer(std::span<const Eigen::Vector3f> points)
      : adaptor_{points}, tree_(3, adaptor_, {10}) {}

  double mean_spacing(std::size_t k) override {
    std::vector<std::uint32_t> indices(k + 1);
    std::vector<float> squared(k + 1);
    double sum = 0;
    for (const Eigen::Vector3f& p : adaptor_.points) {
      tree_.knnSearch(p.data(), k + 1, indices.data(), squared.data());
      for (std::size_t j = 1; j <= k; ++j) sum += std::sqrt(squared[j]);
    }
    return sum / static_cast<double>(k * adaptor_.points.size());
  }

  std::vector<Eigen::Vector3f> normals(float radius, const Eigen::Vector3f& viewpoint) override {
    std::vector<Eigen::Vector3f> normals;
    normals.reserve(adaptor_.points.size());
    std::vector<std::pair<std::uint32_t, float>> found;
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    for (const Eigen::Vector3f& p : adaptor_.points) {
      tree_.radiusSearch(p.data(), radius * radius, found, unsorted);
      normals.push_back(found.size() < 3 ? Eigen::Vector3f(0, 0, 0) : fit(p, found));
      if (normals.back().dot(viewpoint - p) < 0) normals.back() = -normals.back();
    }
    return normals;
  }

 private:
  Eigen::Vector3f fit(const Eigen::Vector3f& p,
                      const std::vector<std::pair<std::uint32_t, float>>& found) const {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
    for (const auto& neighbor : found) {
      const Eigen::Vector3f d = adaptor_.points[neighbor.first] - p;
      sum += d;
      squares += d * d.transpose();
    }
    const auto n = static_cast<float>(found.size());
    const Eigen::Matrix3f covariance = squares / n - (sum / n) * (sum / n).transpose();
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(covariance).eigenvectors().col(0);
  }

  NanoflannPoints adaptor_;
  NanoflannTree tree_;
};

}  // namespace

std::unique_ptr<Peer> make_nanoflann(std::span<const Eigen::Vector3f> points) {
  return std::make_unique<NanoflannPeer>(points);
}

}  // namespace palpate::bench
