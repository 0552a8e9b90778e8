#include "peers/peers.hpp"

namespace palpate::bench {

std::unique_ptr<PclCloud> make_pcl_cloud(std::span<const Eigen::Vector3f>) {
  return nullptr;
}

}  // namespace palpate::bench
