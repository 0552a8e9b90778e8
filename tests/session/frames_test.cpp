// Points of a recorded frame.
#include "session/frames.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate::session {
namespace {

DepthFrame frame_of(int width, int height, std::size_t depths) {
  DepthFrame frame;
  frame.camera.width = width;
  frame.camera.height = height;
  frame.camera.pinhole = {2, 4, 0, 1};
  frame.depth.assign(depths, 2);
  return frame;
}

TEST(Frames, APointAPixelThatWasMeasured) {
  DepthFrame frame = frame_of(3, 2, 6);
  frame.depth[1] = 0;
  const PointCloud cloud = cloud_of(frame);
  EXPECT_EQ(cloud.width, 3U);
  EXPECT_EQ(cloud.height, 2U);
  ASSERT_EQ(cloud.positions.size(), 5U);
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3f(2, -0.5F, 2)) << "of pixel 2";
  EXPECT_EQ(cloud.positions[4], Eigen::Vector3f(2, 0, 2)) << "of pixel 5";
  EXPECT_EQ(cloud.pixels[1], 2U);
}

TEST(Frames, ThoseWhoseDepthsAreNotThoseOfTheirPixelsAreRefused) {
  constexpr int kMost = std::numeric_limits<int>::max();
  for (const auto& [width, height] :
       {std::pair{0, 6}, {6, 0}, {0, 0}, {-2, -3}, {3, 3}, {4, 1}, {kMost, kMost}}) {
    try {
      (void)cloud_of(frame_of(width, height, 6));
      ADD_FAILURE() << width << " x " << height;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("pixels has 6 depths"), std::string::npos);
    }
  }
  EXPECT_THROW((void)cloud_of(frame_of(0, 0, 0)), Error);
}

}  // namespace
}  // namespace palpate::session
