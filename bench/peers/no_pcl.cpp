// Stands in for the PCL peers in builds without PCL: they have no rows then.
#include "peers/peers.hpp"

namespace palpate::bench {

std::unique_ptr<PclCloud> make_pcl_cloud(std::span<const Eigen::Vector3f>) {
  return nullptr;
}

std::vector<Eigen::Vector3f> pcl_mls(std::span<const Eigen::Vector3f>, double) {
  return {};
}

std::size_t pcl_pipeline(const DepthFrame&, float) {
  return 0;
}

std::size_t pcl_organised_pipeline(const DepthFrame&, float) {
  return 0;
}

}  // namespace palpate::bench
