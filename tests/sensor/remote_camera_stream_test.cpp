// What a remote camera sends, through a stream and as a surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"
#include "sensor/fake_camera.hpp"
#include "sensor/remote_sender.hpp"
#include "support/contains.hpp"
#include "support/folder.hpp"
#include "support/stream_run.hpp"

namespace palpate::sensor {
namespace {

using test::contains;
using test::RemoteFrame;
using test::RemoteSender;

RemoteFrame wall(std::uint16_t millimetres) {
  RemoteFrame frame;
  frame.steps.assign(48, millimetres);
  return frame;
}

TEST(RemoteCameraStream, TellsWhatCameAndGoesOn) {
  const test::Folder folder;
  const std::string path = folder / "camera";
  ManualClock clock;
  const auto camera = open_camera("remote:" + path, {.clock = &clock});
  std::atomic<int> taken{0};
  const Stream stream(*camera, "table",
                      [&](const DepthFrame&, const Source::StartTime& start) {
                        (void)start();
                        ++taken;
                      },
                      clock, {.stall = 0.5});
  std::optional<RemoteSender> sender(path);
  ASSERT_TRUE(sender->send(wall(700)));
  ASSERT_TRUE(eventually([&] { return taken == 1; }));
  sender.reset();
  const auto tells = [&](const char* words) {
    return eventually([&] { return contains(stream.state().problem, words); });
  };
  // Time stands still until the stream's thread has looked once more.
  clock.set(0.4);
  RemoteFrame bad = wall(700);
  bad.version = 9;
  EXPECT_TRUE(RemoteSender(path).send(bad));
  EXPECT_TRUE(tells("the version is 9; send version 1")) << stream.state().problem;
  EXPECT_EQ(stream.state().drops.garbage, 1u);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::running);
  clock.set(1);
  EXPECT_TRUE(eventually([&] { return stream.state().phase == StreamState::Phase::stalled; }));
  sender.emplace(path);
  clock.set(1.1);
  ASSERT_TRUE(sender->send(wall(701)));
  EXPECT_TRUE(eventually([&] { return taken == 2; }));
  EXPECT_EQ(stream.state().phase, StreamState::Phase::running);
  EXPECT_EQ(stream.state().failures, 0u);
}

// A plane 0.7 m ahead; a hand 3 mm behind it is pushed back towards the camera.
TEST(RemoteCameraStream, IsFeltWhereItWasSent) {
  const test::Folder folder;
  const auto camera = open_camera("remote:" + folder / "camera");
  RemoteFrame sent;
  sent.flags = 1;
  sent.width = 80;
  sent.height = 60;
  sent.lens = {187.5, 187.5, 39.5, 29.5};
  sent.unit = 1e-4;
  sent.steps.assign(80 * 60, 7000);
  sent.pose = {0.1, 0, 0, 0, std::sqrt(0.5), 0, std::sqrt(0.5)};  // it looks along the world's x
  const RemoteSender sender(folder / "camera");
  ASSERT_TRUE(sender.send(sent));
  DepthFrame frame;
  ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
  Scene scene;
  SourceOptions options;
  options.policy.fit_everywhere = true;
  options.policy.silence = 60;
  Source& source = scene.add("wall", options);
  source.push(frame, [] { return 0.0; });
  test::StreamRun run(scene);
  Contact last;
  run.until(
      1.5, [](double t) { return Eigen::Vector3d(0.79 + std::min(0.013, 0.02 * t), 0, 0); },
      [&](double, const Contact& contact) { last = contact; });
  EXPECT_NEAR(last.force.x(), -500 * 3e-3, 0.03);
  EXPECT_LT(last.force.tail<2>().norm(), 0.02);
}

}  // namespace
}  // namespace palpate::sensor
