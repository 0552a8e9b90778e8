// A tool is made again of its own samples, as recordings hold them.
#include <gtest/gtest.h>

#include "palpate/tool/tool.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// Grids have many samples at one coordinate, which any order divides.
TEST(ToolTree, SamplesOfAToolMakeTheSameToolAgain) {
  const Vector3d axis = Vector3d(3, -1, 2).normalized();
  const Tool box = Tool::box({0.04, 0.06, 0.02}, 4e-3);
  const std::vector<Tool::Point> turned(box.samples().rbegin(), box.samples().rend());
  for (const Tool& tool :
       {box, Tool::cylinder(0.06, 0.02, 4e-3), Tool::gripper({6e-3, 0.012, 0.04}, 2e-3),
        Tool::capsule(0.08, 3e-3, 4e-3), Tool(turned, axis)}) {
    const Tool again({tool.samples().begin(), tool.samples().end()}, tool.axis());
    EXPECT_EQ(again.axis(), tool.axis());
    EXPECT_EQ(again.gyration(), tool.gyration());
    ASSERT_EQ(again.nodes().size(), tool.nodes().size());
    for (std::size_t i = 0; i < tool.nodes().size(); ++i) {
      EXPECT_EQ(again.nodes()[i].center, tool.nodes()[i].center);
      EXPECT_EQ(again.nodes()[i].radius, tool.nodes()[i].radius);
      EXPECT_EQ(again.nodes()[i].end, tool.nodes()[i].end);
    }
    for (std::size_t i = 0; i < tool.samples().size(); ++i) {
      EXPECT_EQ(again.samples()[i].position, tool.samples()[i].position);
    }
  }
}

}  // namespace
}  // namespace palpate::test
