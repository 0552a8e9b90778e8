// Frames of real sensors whose poses are known are moved away and found back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "palpate/align/align.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::vector<DepthFrame> frames_of(const std::string& folder) {
  const auto camera = open_camera("sequence:" + folder, {});
  std::vector<DepthFrame> frames;
  for (DepthFrame frame; camera->read(frame, 1) == DepthCamera::Status::frame;)
    frames.push_back(frame);
  return frames;
}

// Up to 10 cm and 10 degrees, times `scale`.
Isometry3d moved(std::mt19937& random, double scale) {
  std::uniform_real_distribution<double> any(-1, 1);
  const Vector3d axis = Vector3d(any(random), any(random), any(random)).normalized();
  Isometry3d pose(Eigen::AngleAxisd(scale * any(random) * 0.1745, axis));
  pose.translation() = 0.1 * scale * any(random) * axis.unitOrthogonal();
  return pose;
}

RoughSource seen(DepthFrame frame, const Isometry3d& rough) {
  Source source("frame", {});
  SourceOptions options;
  options.depth.farthest = 4;  // stray depths lie beyond
  source.change(options);
  frame.T_world_sensor = rough;
  source.set(frame);
  return {"frame", source.points()};
}

// Where the second frame belongs, after being moved away by `seed`.
Isometry3d found(const DepthFrame& first, const DepthFrame& second, unsigned seed,
                 double scale = 1) {
  std::mt19937 random(seed);
  const Isometry3d rough = *second.T_world_sensor * moved(random, scale);
  const auto aligned = align({seen(first, *first.T_world_sensor), seen(second, rough)});
  return aligned[1].T_aligned_rough * rough;
}

// In the middle of what is seen, 0.6 m to 2 m away, places are off by less than 3 mm.
void expect_same(const Isometry3d& a, const Isometry3d& b, double depth) {
  const Vector3d middle(0, 0, depth);
  EXPECT_LT((a * middle - b * middle).norm(), 3e-3);
  EXPECT_LT(Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle(), 0.5 * 0.01745);
}

TEST(RecordedAlign, FindsFramesOfARoomBack) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  const auto frames = frames_of(std::string(data) + "/redwood_open3d_mit");
  ASSERT_GT(frames.size(), 1u);
  for (unsigned seed = 1; seed < frames.size(); ++seed) {
    expect_same(found(frames[0], frames[seed], seed), *frames[seed].T_world_sensor, 2);
  }
}

// The poses that the robot's arm told leave surfaces 3.5 mm apart and are off by up to a degree:
// what counts is that every rough pose leads to one answer. From farther away than this, what
// repeats on a shelf is found now and then.
TEST(RecordedAlign, FindsViewsOfAShelfBack) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  const auto frames = frames_of(std::string(data) + "/multiview_shelf_apc");
  ASSERT_GT(frames.size(), 1u);
  for (std::size_t i = 0; i + 1 < frames.size(); i += 4) {
    const auto stood = align({seen(frames[i], *frames[i].T_world_sensor),
                              seen(frames[i + 1], *frames[i + 1].T_world_sensor)});
    const Isometry3d best = stood[1].T_aligned_rough * *frames[i + 1].T_world_sensor;
    EXPECT_LT(stood[1].after.residual, std::min(2.5e-3, stood[1].before.residual));
    for (unsigned seed = 1; seed < 3; ++seed) {
      expect_same(found(frames[i], frames[i + 1], seed, 0.3), best, 0.6);
    }
  }
}

}  // namespace
}  // namespace palpate
