// Round tools by name.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// What is thicker than the samples are apart is felt by its surface.
TEST(Tool, ALargeBallAndAThickStylusAreSampledOnTheirSurface) {
  const double spacing = 2.5e-3;
  const double radius = 8e-3;
  for (const double length : {0.0, 0.03}) {
    const Tool tool = Tool::from_text(length > 0 ? "capsule:30x8" : "ball:8", spacing);
    const auto outside = [&](const Vector3d& x) {
      return (x - Vector3d(0, 0, std::clamp(x.z(), -length, 0.0))).norm() - radius;
    };
    for (const Tool::Point& each : tool.samples()) {
      EXPECT_EQ(each.radius, 0);
      EXPECT_NEAR(outside(each.position), 0, 1e-15);
    }
    for (double z = -1; z <= 1; z += 0.05) {  // of the surface, everywhere
      for (double angle = 0; angle < 2 * std::numbers::pi; angle += 0.1) {
        const Vector3d out(std::cos(angle), std::sin(angle), 0);
        const Vector3d up = std::sqrt(std::max(0.0, 1 - z * z)) * out + z * Vector3d::UnitZ();
        EXPECT_LT(nearest(tool, radius * up - (z < 0 ? length : 0) * Vector3d::UnitZ()),
                  0.75 * spacing);
        EXPECT_LT(nearest(tool, radius * out - 0.5 * (1 + z) * length * Vector3d::UnitZ()),
                  0.75 * spacing);
      }
    }
  }
  EXPECT_EQ(Tool::from_text("ball:1.5", spacing).samples().size(), 1u);
  EXPECT_GT(Tool::from_text("capsule:30x1.5", spacing).samples().front().radius, 0);
}

}  // namespace
}  // namespace palpate::test
