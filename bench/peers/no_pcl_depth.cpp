#include "peers/depth_peers.hpp"

namespace palpate::bench {

std::size_t pcl_pipeline(const DepthFrame&, float) {
  return 0;
}

std::size_t pcl_organised_pipeline(const DepthFrame&, float) {
  return 0;
}

}  // namespace palpate::bench
