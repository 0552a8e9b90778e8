// Real sequences play through, and their poses make the views agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "sensor/sequence.hpp"

namespace palpate {
namespace {

struct Expected {
  const char* folder;
  std::size_t frames;
  bool posed;
};

constexpr Expected kSequences[] = {
    {"realsense_makerspace_mit", 120, false},
    {"redwood_open3d_mit", 5, true},
    {"multiview_shelf_apc", 15, true},
};

class SequenceData : public testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    const char* data = std::getenv("PALPATE_DATA");
    if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
    sequence_ = read_sequence(std::filesystem::path(data) / GetParam().folder);
  }

  Sequence sequence_;
};

std::vector<DepthFrame> play(const Sequence& sequence) {
  const auto camera = open_sequence(sequence);
  std::vector<DepthFrame> frames(1);
  while (camera->read(frames.back(), 0) == DepthCamera::Status::frame) frames.emplace_back();
  EXPECT_EQ(camera->reason(), "");
  frames.pop_back();
  return frames;
}

TEST_P(SequenceData, PlaysThrough) {
  const std::vector<DepthFrame> frames = play(sequence_);
  EXPECT_EQ(frames.size(), GetParam().frames);
  for (const DepthFrame& frame : frames) {
    EXPECT_EQ(frame.depth.size(), 640u * 480u);
    EXPECT_EQ(frame.T_world_sensor.has_value(), GetParam().posed);
    const auto measured = std::ranges::count_if(frame.depth, [](float z) { return z > 0; });
    EXPECT_GT(measured, 640 * 480 / 20) << "pixels with a depth";
  }
}

// Middle of how far `to` is from showing what `from` saw, m, if the camera went so between them.
double disagreement(const DepthFrame& from, const DepthFrame& to,
                    const Eigen::Isometry3d& T_to_from) {
  const Pinhole& p = from.camera.pinhole;
  std::vector<double> errors;
  for (int i = 0; i < from.camera.width * from.camera.height; i += 37) {
    const double z = from.depth[static_cast<std::size_t>(i)];
    if (z <= 0 || z > 3) continue;
    const double u = i % from.camera.width;
    const double v = i / from.camera.width;
    const Eigen::Vector3d q =
        T_to_from * Eigen::Vector3d((u - p.cx) * z / p.fx, (v - p.cy) * z / p.fy, z);
    const double column = std::round(p.fx * q.x() / q.z() + p.cx);
    const double row = std::round(p.fy * q.y() / q.z() + p.cy);
    if (q.z() <= 0 || column < 0 || column > 639 || row < 0 || row > 479) continue;
    const double seen = to.depth[static_cast<std::size_t>(row * 640 + column)];
    if (seen > 0) errors.push_back(std::abs(seen - q.z()));
  }
  EXPECT_GT(errors.size(), 500u);
  if (errors.empty()) return 1e9;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

TEST_P(SequenceData, PosedViewsAgree) {
  if (!GetParam().posed) GTEST_SKIP() << "this sequence has no poses";
  const std::vector<DepthFrame> frames = play(sequence_);
  ASSERT_GT(frames.size(), 1u);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const DepthFrame& from = frames[i - 1];
    const DepthFrame& to = frames[i];
    const Eigen::Isometry3d motion = to.T_world_sensor->inverse() * *from.T_world_sensor;
    const double error = disagreement(from, to, motion);
    EXPECT_LT(error, 0.01) << "m between views " << i - 1 << " and " << i;
    EXPECT_LT(error, 0.7 * disagreement(from, to, Eigen::Isometry3d::Identity()))
        << "no better than without poses";
  }
}

INSTANTIATE_TEST_SUITE_P(Real, SequenceData, testing::ValuesIn(kSequences),
                         [](const auto& test) { return std::string(test.param.folder); });

}  // namespace
}  // namespace palpate
