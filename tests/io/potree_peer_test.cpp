// Potree stores give the nodes and points that potree-core (npm), Potree's viewer, gives.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "io/potree/hierarchy.hpp"
#include "io/potree/potree.hpp"
#include "io/potree_writer.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

struct PotreePeerPoint {
  Eigen::Vector3d place;  // m
  Eigen::Vector3d color;
  double intensity = 0;
};

using PeerNodes = std::map<std::string, std::vector<PotreePeerPoint>>;

class PotreePeer : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("node --version >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "node is absent (Debian: nodejs)";
    }
    if (!fs::exists(fs::path(PALPATE_PEER) / "node_modules/potree-core")) {
      GTEST_SKIP() << "tests/peer/node_modules is absent: run npm ci in tests/peer";
    }
  }

  // The nodes that potree-core reads from the store in the folder.
  [[nodiscard]] PeerNodes nodes_of_peer() const {
    const std::string command = fmt::format("cd {} && node potree.mjs {} >{} 2>&1", PALPATE_PEER,
                                            folder_.path().string(), folder_ / "out");
    EXPECT_EQ(std::system(command.c_str()), 0) << std::ifstream(folder_ / "out").rdbuf();
    PeerNodes nodes;
    std::ifstream file(folder_ / "peer.txt");
    std::string name;
    std::size_t count = 0;
    while (file >> name >> count) {
      std::vector<PotreePeerPoint>& points = nodes[name];
      points.resize(count);
      for (PotreePeerPoint& p : points) {
        for (double& x : p.place) file >> x;
        for (double& c : p.color) file >> c;
        file >> p.intensity;
      }
    }
    return nodes;
  }

  test::Folder folder_;
};

TEST_F(PotreePeer, ReadsTheSameNodesAsWeDo) {
  std::vector<PotreePoint> points = potree_hill(8000);
  for (PotreePoint& p : points) {
    for (std::uint16_t& c : p.color) c |= 256U;  // it takes single numbers below as of 8 bits
  }
  for (const bool packed : {false, true}) {
    for (const int levels : {2, 4}) {
      SCOPED_TRACE(fmt::format("packed {}, {} levels a chunk", packed, levels));
      potree_of(points, {.packed = packed, .levels = levels}).write(folder_);
      const auto store = io::open_potree(folder_.path(), {.scale = 1});
      const PeerNodes nodes = nodes_of_peer();
      ASSERT_EQ(nodes.size(), store->layout().nodes.size());
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::string name = io::potree::name_of(store->layout().nodes[i]);
        ASSERT_TRUE(nodes.contains(name)) << name;
        const std::vector<PotreePeerPoint>& expected = nodes.at(name);
        const PointCloud cloud = store->read(i);
        ASSERT_EQ(cloud.size(), expected.size()) << name;
        for (std::size_t k = 0; k < expected.size(); ++k) {
          ASSERT_LT((cloud.point(k) - expected[k].place).norm(), 2e-4) << "both round to floats";
          ASSERT_EQ(cloud.intensities[k], expected[k].intensity);
          const auto& [red, green, blue] = cloud.colors[k];
          // It divides 16 bits by 256, we by 257, as 65535 is 255.
          ASSERT_LE((expected[k].color - Eigen::Vector3d(red, green, blue)).cwiseAbs().maxCoeff(),
                    1);
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate
