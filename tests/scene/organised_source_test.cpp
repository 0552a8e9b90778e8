// Organised clouds are felt as the depth frames that they were made of.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "palpate/contact/proxy.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/io/files.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/organised_clouds.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::organised_cloud;
using test::organised_frame;

constexpr double kPress = 4e-3;  // m

// Forces while a hand comes along the camera's rays, presses and slides across, in the camera's
// axes.
std::vector<Vector3d> felt(Scene& scene, const DepthFrame& frame, const Eigen::Isometry3d& T) {
  SceneField field(scene);
  std::vector<Vector3d> forces;
  const Pinhole& p = frame.camera.pinhole;
  const int width = frame.camera.width;
  for (const double share : {0.3, 0.45, 0.6, 0.7}) {
    const int v = static_cast<int>(share * frame.camera.height);
    const int u = static_cast<int>(share * width);
    const auto z = static_cast<double>(frame.depth[static_cast<std::size_t>(v * width + u)]);
    if (z <= 0) continue;
    const Vector3d at((u - p.cx) / p.fx * z, (v - p.cy) / p.fy * z, z);
    Proxy proxy;
    for (int tick = 0; tick < 400; ++tick) {
      const double deep = std::min(kPress, -20e-3 + 1e-4 * tick);
      const double aside = 5e-5 * std::max(0, tick - 240);
      const Vector3d hand = T * (at + Vector3d(aside, 0, deep));
      field.update(1 + 1e-3 * tick, hand, proxy);
      forces.emplace_back(T.linear().transpose() * proxy.step(field, hand, 1e-3).force);
    }
  }
  return forces;
}

double largest(const std::vector<Vector3d>& forces) {
  double most = 0;
  for (const Vector3d& force : forces) most = std::max(most, force.norm());
  return most;
}

double largest_difference(const std::vector<Vector3d>& one, const std::vector<Vector3d>& other) {
  double most = one.size() == other.size() ? 0 : INFINITY;
  for (std::size_t i = 0; i < one.size() && i < other.size(); ++i) {
    most = std::max(most, (one[i] - other[i]).norm());
  }
  return most;
}

// A recording of one frame is read so.
Source& add_recording(Scene& scene, const DepthFrame& frame) {
  Source& source = scene.add("recording", {.policy = {.fit_everywhere = true}});
  source.push(frame, [] { return 0.0; });
  source.keep();
  return source;
}

Eigen::Isometry3d elsewhere() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Vector3d(1, -2, 0.5));
  T.rotate(Eigen::AngleAxisd(2.2, Vector3d(1, 2, -1).normalized()));
  return T;
}

TEST(OrganisedSource, ACloudFeelsAsItsFrameDoes) {
  const DepthFrame frame = organised_frame();
  Scene recorded;
  add_recording(recorded, frame);
  Scene still;
  const Source& source = still.add("cloud", organised_cloud(frame));
  EXPECT_GT(source.state().depth, 0.5);
  EXPECT_GT(source.state().points, 3000u);
  const auto expected = felt(recorded, frame, Eigen::Isometry3d::Identity());
  const auto found = felt(still, frame, Eigen::Isometry3d::Identity());
  ASSERT_GT(largest(expected), 1.0);
  EXPECT_LT(largest_difference(found, expected), 1e-4);
}

TEST(OrganisedSource, WhereverTheCameraAndTheCloudStand) {
  const DepthFrame frame = organised_frame();
  Scene recorded;
  add_recording(recorded, frame);
  Scene still;
  const Eigen::Isometry3d pose = elsewhere().inverse() * Eigen::AngleAxisd(1, Vector3d::UnitY());
  still.add("cloud", organised_cloud(frame, elsewhere()), {.T_world_sensor = pose});
  const auto expected = felt(recorded, frame, Eigen::Isometry3d::Identity());
  const auto found = felt(still, frame, pose * elsewhere());
  EXPECT_LT(largest_difference(found, expected), 5e-3) << "floats in a turned frame";
}

TEST(OrganisedSource, AFrameThatStandsStillIsFittedWhole) {
  const DepthFrame frame = organised_frame();
  Scene recorded;
  add_recording(recorded, frame);
  Scene still;
  Source& source = still.add("image", {.policy = {.policy = Policy::replace}});
  source.set(frame);
  EXPECT_EQ(source.state().frames, 1u);
  EXPECT_TRUE(std::isinf(source.state().silent_from));
  const auto none = Eigen::Isometry3d::Identity();
  EXPECT_EQ(felt(still, frame, none), felt(recorded, frame, none));
}

TEST(OrganisedSource, LoosePointsAreThereForTheAsking) {
  const PointCloud cloud = organised_cloud(organised_frame());
  PointCloud loose = cloud;
  loose.width = loose.height = 0;
  loose.pixels.clear();
  PointCloud millimetres = cloud;
  for (Eigen::Vector3f& p : millimetres.positions) p *= 1000;
  Scene scene;
  const std::size_t expected = scene.add("loose", loose).points()->size();
  const auto points = [&](const char* name, const PointCloud& given, const SourceOptions& options) {
    const Source& source = scene.add(name, given, options);
    EXPECT_EQ(source.state().depth, 0) << name;
    return source.points()->size();
  };
  EXPECT_EQ(points("asked", cloud, {.organised = false}), expected);
  EXPECT_EQ(points("voxel", cloud, {.prepare = {.voxel = 0.0}}),
            points("voxel too", loose, {.prepare = {.voxel = 0.0}}));
  EXPECT_EQ(points("out of range", millimetres, {}), expected);
  EXPECT_NE(scene.add("image", cloud).points()->size(), expected);
}

TEST(OrganisedSource, ASourceGoesFromFramesToLoosePointsAndBack) {
  const PointCloud cloud = organised_cloud(organised_frame());
  Scene scene;
  Source& source = scene.add("cloud", cloud);
  const std::size_t blocks = source.points()->size();
  SourceOptions options = source.options();
  options.organised = false;
  source.change(options);
  source.set(cloud);
  EXPECT_EQ(source.state().depth, 0);
  EXPECT_NE(source.points()->size(), blocks);
  options.organised = true;
  source.change(options);
  source.set(cloud);
  EXPECT_EQ(source.points()->size(), blocks);
}

class OrganisedData : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("PALPATE_DATA");
    if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
    folder_ = std::filesystem::path(data) / "pcl_tabletop";
  }

  std::filesystem::path folder_;
};

TEST_F(OrganisedData, RealFilesHaveTheCamerasThatMadeThem) {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.path().extension() != ".pcd") continue;
    const PointCloud cloud = read_cloud(entry.path());
    const OrganisedFrame frame = depth_frame_of(cloud);
    EXPECT_EQ(frame.frame.has_value(), cloud.width > 0) << entry.path() << frame.residual;
    if (!frame.frame) continue;
    ++found;
    const bool stereo = entry.path().filename().string().find("stereo") != std::string::npos;
    EXPECT_LT(frame.residual, stereo ? 5e-3 : 5e-5) << entry.path();
    const Pinhole& p = frame.frame->camera.pinhole;
    EXPECT_NEAR(p.fx, stereo ? 964.359 : 525, 1e-3) << entry.path();
    EXPECT_NEAR(p.fy, stereo ? 964.359 : 525, 1e-3) << entry.path();
    const auto measured = std::ranges::count_if(frame.frame->depth, [](float z) { return z > 0; });
    EXPECT_GE(measured, 0.97 * static_cast<double>(cloud.size())) << entry.path();
    RecordProperty(entry.path().filename().string(), std::to_string(frame.residual));
  }
  EXPECT_EQ(found, 12);
}

TEST_F(OrganisedData, ARealCloudFeelsAsItsFrameDoes) {
  for (const char* name : {"osd_test7.pcd", "milk_cartoon_all_small_clorox.pcd"}) {
    const PointCloud cloud = read_cloud(folder_ / name);
    const DepthFrame frame = *depth_frame_of(cloud).frame;
    const Eigen::Isometry3d T = frame.T_world_sensor.value_or(Eigen::Isometry3d::Identity());
    Scene recorded;
    add_recording(recorded, frame);
    Scene still;
    const Source& source = still.add("cloud", cloud);
    EXPECT_LT(source.points()->radius, 10e-3) << "loose points of the same files have 30 and more";
    const auto expected = felt(recorded, frame, T);
    ASSERT_GT(largest(expected), 1.0);
    EXPECT_LT(largest_difference(felt(still, frame, T), expected), 1e-4) << name;
  }
}

}  // namespace
}  // namespace palpate
