// One depth image is one surface, whether it is read as a file or comes as the only frame of a
// recording.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;  // s
constexpr int kKept = 100;      // ticks, when the recording ends

/// A floor at z = 0, from 0.8 m away and 50 degrees above it.
DepthFrame image_of_a_floor(const std::string& noise) {
  SimulatedScene floor;
  floor.solids.emplace_back();
  SimulatedSetup setup{floor, {}};
  set_simulated(setup, "noise=" + noise);
  setup.camera.noise.seed = 11;
  const Vector3d eye(-0.5, 0, 0.6);
  Eigen::Matrix3d axes;
  axes.col(2) = -eye.normalized();
  axes.col(0) = axes.col(2).cross(Vector3d::UnitZ()).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  setup.camera.T_world_camera = Eigen::Translation3d(eye) * Eigen::Quaterniond(axes);
  SimulatedCamera camera(setup.scene, setup.camera);
  camera.begin(0);
  DepthFrame frame;
  EXPECT_EQ(camera.read(frame, 1), DepthCamera::Status::frame);
  return frame;
}

/// Forces on a hand that waits 30 mm above the floor for half a second and slides 3 mm below it.
std::vector<Vector3d> slide(Scene& scene, const DepthFrame* pushed) {
  Source& source = scene.source(0);
  SceneField field(scene);
  Proxy proxy({.stiffness = 500});
  std::vector<Vector3d> forces;
  for (int tick = 0; tick < 1500; ++tick) {
    const double now = tick * kTick;
    if (pushed != nullptr && tick == 1) source.push(*pushed, [] { return 0.02; });
    if (pushed != nullptr && tick == kKept) source.keep();
    const double height = std::max(-0.003, 0.03 - 0.033 * std::max(0.0, now - 0.5) / 0.2);
    const Vector3d hand(0.03 * std::max(0.0, now - 0.7) - 0.01, 0.01, height);
    field.update(now, hand, proxy);
    forces.push_back(proxy.step(field, hand, kTick).force);
  }
  return forces;
}

class SameImage : public testing::TestWithParam<std::string> {};

TEST_P(SameImage, IsTheSameSurfaceAsAFileAndAsTheOnlyFrameOfARecording) {
  const DepthFrame frame = image_of_a_floor(GetParam());
  Scene file;
  file.add("camera", SourceOptions{}).set(frame);
  Scene recording;
  recording.add("camera", SourceOptions{});
  const std::vector<Vector3d> of_file = slide(file, nullptr);
  const std::vector<Vector3d> of_recording = slide(recording, &frame);
  double most = 0;
  double apart = 0;
  for (std::size_t i = 0; i < of_file.size(); ++i) {
    most = std::max(most, of_file[i].norm());
    apart = std::max(apart, (of_file[i] - of_recording[i]).norm());
  }
  EXPECT_GT(most, 1);
  EXPECT_LT(apart, 0.02) << "N: a degree of 1.5 N is 0.026 N";
}

INSTANTIATE_TEST_SUITE_P(OfEachNoise, SameImage, testing::Values("a", "b", "c", "stereo", "tof"),
                         [](const auto& of) { return of.param; });

}  // namespace
}  // namespace palpate::test
