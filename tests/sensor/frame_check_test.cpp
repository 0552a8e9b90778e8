#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sensor/fake_camera.hpp"
#include "sensor/stream_statistics.hpp"

namespace palpate::sensor {
namespace {

constexpr double kEver = std::numeric_limits<double>::infinity();

std::uint64_t StreamState::Drops::*cause(FrameCheck& check, const DepthFrame& frame,
                                         double latest = kEver) {
  const auto objection = check.examine(frame, latest);
  if (!objection) return nullptr;
  EXPECT_FALSE(objection->words.empty());
  return objection->cause;
}

TEST(FrameCheck, LetsGoodFramesPass) {
  FrameCheck check(false);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(cause(check, frame_at(i, 1 + 0.1F * static_cast<float>(i))), nullptr) << i;
  }
}

TEST(FrameCheck, FindsWhatContradictsItself) {
  FrameCheck check(false);
  DepthFrame frame = frame_at(1);
  frame.depth.pop_back();
  EXPECT_EQ(cause(check, frame), &StreamState::Drops::garbage);
  frame = frame_at(1);
  frame.colors.resize(3);
  EXPECT_EQ(cause(check, frame), &StreamState::Drops::garbage);
  frame = frame_at(1);
  frame.camera.pinhole.fx = 0;
  EXPECT_EQ(cause(check, frame), &StreamState::Drops::garbage);
  frame.camera.pinhole.fx = std::nan("");
  EXPECT_EQ(cause(check, frame), &StreamState::Drops::garbage);
  frame = frame_at(1);
  frame.camera.width = -4;
  EXPECT_EQ(cause(check, frame), &StreamState::Drops::garbage);
  frame = frame_at(1);
  frame.T_world_sensor = Eigen::Isometry3d::Identity();
  frame.T_world_sensor->translation().x() = std::nan("");
  EXPECT_EQ(cause(check, frame), &StreamState::Drops::garbage);
  EXPECT_EQ(cause(check, DepthFrame{}), &StreamState::Drops::garbage);
}

TEST(FrameCheck, FindsStampsThatDoNotGrow) {
  FrameCheck check(false);
  EXPECT_EQ(cause(check, frame_at(1, 1)), nullptr);
  EXPECT_EQ(cause(check, frame_at(1, 2)), &StreamState::Drops::late);
  EXPECT_EQ(cause(check, frame_at(0.5, 2)), &StreamState::Drops::late);
  EXPECT_EQ(cause(check, frame_at(std::nan(""), 2)), &StreamState::Drops::late);
  EXPECT_EQ(cause(check, frame_at(9, 2), 5), &StreamState::Drops::late);
  EXPECT_EQ(cause(check, frame_at(2, 2), 5), nullptr) << "a stamp from the future was remembered";
}

TEST(FrameCheck, FindsPicturesWithoutDepth) {
  FrameCheck check(false);
  EXPECT_EQ(cause(check, frame_at(1, 0)), &StreamState::Drops::empty);
  EXPECT_EQ(cause(check, frame_at(2, std::nanf(""))), &StreamState::Drops::empty);
  DepthFrame frame = frame_at(3, 0);
  frame.depth.back() = 1;
  EXPECT_EQ(cause(check, frame), nullptr);
}

TEST(FrameCheck, FindsRepeatsAndNoOtherPicture) {
  FrameCheck check(false);
  DepthFrame frame = frame_at(1, 1, 5, 5);
  EXPECT_EQ(cause(check, frame), nullptr);
  frame.stamp = 2;
  EXPECT_EQ(cause(check, frame), &StreamState::Drops::repeated);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    frame.stamp += 1;
    frame.depth[i] = std::nextafter(frame.depth[i], 2.0F);
    EXPECT_EQ(cause(check, frame), nullptr) << "pixel " << i << " changed";
  }
  std::swap(frame.depth.front(), frame.depth[8] = 3);
  frame.stamp += 1;
  EXPECT_EQ(cause(check, frame), nullptr) << "two pixels changed places";
}

TEST(FrameCheck, AllowsRepeatsWhereTold) {
  FrameCheck check(true);
  EXPECT_EQ(cause(check, frame_at(1)), nullptr);
  EXPECT_EQ(cause(check, frame_at(2)), nullptr);
}

TEST(FrameCheck, BelievesAnotherSizeOnceItLasts) {
  FrameCheck check(true);
  EXPECT_EQ(cause(check, frame_at(1)), nullptr);
  EXPECT_EQ(cause(check, frame_at(2, 1, 8, 6)), &StreamState::Drops::resized);
  EXPECT_EQ(cause(check, frame_at(3)), nullptr) << "one odd frame";
  EXPECT_EQ(cause(check, frame_at(4, 1, 8, 6)), &StreamState::Drops::resized);
  EXPECT_EQ(cause(check, frame_at(5, 1, 8, 6)), &StreamState::Drops::resized);
  EXPECT_EQ(check.size_changes(), 0u);
  EXPECT_EQ(cause(check, frame_at(6, 1, 8, 6)), nullptr);
  EXPECT_EQ(check.size_changes(), 1u);
  EXPECT_EQ(cause(check, frame_at(7)), &StreamState::Drops::resized);
}

}  // namespace
}  // namespace palpate::sensor
