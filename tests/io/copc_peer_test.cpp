// Octrees of COPC files, and the points of their nodes, are those that copc (npm) finds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "io/copc.hpp"
#include "io/copc_bytes.hpp"
#include "support/peer_test.hpp"

namespace palpate {
namespace {

std::string described(const io::Copc& copc) {
  const Eigen::Vector3d lower = copc.center.array() - copc.half_size;
  const Eigen::Vector3d upper = copc.center.array() + copc.half_size;
  std::string text = fmt::format("{} {} {} {} {} {} {}\n", lower.x(), lower.y(), lower.z(),
                                 upper.x(), upper.y(), upper.z(), copc.spacing);
  for (const io::StoredNode& node : copc.nodes) {
    const auto& [x, y, z] = node.node.cell;
    text += fmt::format("{} {} {} {} {} {} {}\n", node.node.level, x, y, z, node.offset, node.bytes,
                        node.node.points);
  }
  return text;
}

class CopcPeer : public test::PeerTest {
 protected:
  CopcPeer() : PeerTest("copc") {}

  void expect_same(const std::string& bytes) const {
    const ReadOptions options;
    const io::Input input{std::as_bytes(std::span(bytes)), "a.copc.laz", options};
    const io::LasHeader header = io::read_las_header(input);
    const std::optional<io::Copc> copc = io::read_copc(input, header, io::parts_of(input.bytes));
    ASSERT_TRUE(copc);
    folder_.write("a.copc.laz", bytes);
    ASSERT_EQ(run("copc.mjs", folder_ / "a.copc.laz"), described(*copc));
    const std::string records = folder_.read("a.copc.laz.records");
    ASSERT_EQ(records.size(), header.points * header.record_size);
    const std::byte* record = std::as_bytes(std::span(records)).data();
    for (const io::StoredNode& node : copc->nodes) {
      const std::vector<io::LasPoint> points =
          io::decode_node(input, header, input.bytes.subspan(node.offset, node.bytes), node);
      ASSERT_EQ(points.size(), node.node.points);
      for (const io::LasPoint& point : points) {
        const io::LasPoint theirs = io::las_point(header, record);
        ASSERT_EQ(point.number, theirs.number);
        ASSERT_EQ(point.intensity, theirs.intensity);
        ASSERT_EQ(point.color, theirs.color);
        ASSERT_EQ(point.withheld, theirs.withheld);
        record += header.record_size;
      }
    }
  }
};

TEST_F(CopcPeer, FindsTheNodesOfARealFileAsWeDo) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA names no folder with the real data";
  std::ifstream file(std::filesystem::path(data) / "pdal_small/lone-star.copc.laz",
                     std::ios::binary);
  expect_same({std::istreambuf_iterator<char>(file), {}});
}

TEST_F(CopcPeer, FindsTheNodesOfOurEncoderAsWeDo) {
  for (const int format : {6, 7, 8}) expect_same(copc_bytes({}, format));
}

}  // namespace
}  // namespace palpate
