// A remote camera over real sockets, with a clock that the tests hold.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <optional>
#include <thread>

#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sensor/fake_camera.hpp"
#include "sensor/remote_sender.hpp"
#include "support/contains.hpp"
#include "support/folder.hpp"

namespace palpate::sensor {
namespace {

using enum DepthCamera::Status;
using test::contains;
using test::RemoteFrame;
using test::RemoteSender;

constexpr double kPatience = 60;  // s; nothing takes so long

RemoteFrame frame_of(std::uint16_t millimetres) {
  RemoteFrame frame;
  frame.steps.assign(48, millimetres);
  return frame;
}

class RemoteCameraTest : public testing::Test {
 protected:
  [[nodiscard]] std::string path() const { return folder_ / "camera"; }
  [[nodiscard]] std::unique_ptr<DepthCamera> open() const {
    return open_camera("remote:" + path(), {.clock = &clock_});
  }
  // What has come is taken, nothing is waited for.
  DepthCamera::Status look() { return camera_->read(frame_, 0); }
  void expect_millimetres(int wanted) {
    ASSERT_EQ(look(), frame) << camera_->reason();
    EXPECT_EQ(frame_.depth, std::vector<float>(48, static_cast<float>(1e-3 * wanted)));
    EXPECT_EQ(camera_->reason(), "");
  }

  test::Folder folder_;
  ManualClock clock_;
  std::unique_ptr<DepthCamera> camera_ = open();
  DepthFrame frame_;
};

TEST_F(RemoteCameraTest, GivesTheFrameThatAProgramSends) {
  EXPECT_EQ(camera_->info().name, "remote:" + path());
  EXPECT_TRUE(camera_->info().paces);
  clock_.set(50);
  const RemoteSender sender(path());
  RemoteFrame sent = frame_of(700);
  sent.flags = 1;
  sent.pose = {1, 2, 3, 0, 0, 0, 1};
  sent.steps[5] = 812;
  ASSERT_TRUE(sender.send(sent));
  frame_.colors.resize(48);
  ASSERT_EQ(look(), frame) << camera_->reason();
  EXPECT_EQ(frame_.camera.width, 8);
  EXPECT_EQ(frame_.camera.height, 6);
  EXPECT_EQ(frame_.camera.pinhole.fy, 8.5);
  EXPECT_EQ(frame_.depth[4], 0.7F);
  EXPECT_EQ(frame_.depth[5], 0.812F);
  EXPECT_EQ(frame_.stamp, 50);
  EXPECT_TRUE(frame_.colors.empty());
  ASSERT_TRUE(frame_.T_world_sensor);
  EXPECT_EQ(frame_.T_world_sensor->translation(), Eigen::Vector3d(1, 2, 3));
  ASSERT_TRUE(sender.send(frame_of(701)));
  expect_millimetres(701);
  EXPECT_FALSE(frame_.T_world_sensor) << "of the frame before";
  EXPECT_EQ(look(), waiting);
}

TEST_F(RemoteCameraTest, SaysWhomItWaitsFor) {
  EXPECT_TRUE(camera_->info().awaits_sender);
  EXPECT_EQ(look(), waiting);
  EXPECT_TRUE(contains(camera_->reason(), "no program is connected to '" + path()));
  const RemoteSender sender(path());
  EXPECT_EQ(look(), waiting);
  EXPECT_TRUE(contains(camera_->reason(), "sends no frame")) << camera_->reason();
}

TEST_F(RemoteCameraTest, WaitsForAFrameThatIsLargerThanAnyQueue) {
  RemoteFrame sent;
  sent.width = 1280;
  sent.height = 960;
  sent.steps.resize(std::size_t{1280} * 960);
  for (std::size_t i = 0; i < sent.steps.size(); ++i) {
    sent.steps[i] = static_cast<std::uint16_t>(1 + i % 65'000);
  }
  const std::jthread program([&] { EXPECT_TRUE(RemoteSender(path()).send(sent)); });
  ASSERT_EQ(camera_->read(frame_, kPatience), frame) << camera_->reason();
  ASSERT_EQ(frame_.depth.size(), sent.steps.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < sent.steps.size(); ++i) {
    wrong += frame_.depth[i] == static_cast<float>(1e-3 * sent.steps[i]) ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0u);
}

TEST_F(RemoteCameraTest, TakesTheNewestOfWhatWaits) {
  const RemoteSender sender(path());
  for (const std::uint16_t z : {700, 701, 702}) ASSERT_TRUE(sender.send(frame_of(z)));
  expect_millimetres(702);
  EXPECT_EQ(look(), waiting);
}

TEST_F(RemoteCameraTest, LooksForABoundedTimeThoughFramesDoNotEnd) {
  std::atomic<bool> over{false};
  const std::jthread program([&] {
    const RemoteSender sender(path());
    while (!over && sender.send(frame_of(700))) continue;
  });
  for (int i = 0; i < 20; ++i) EXPECT_EQ(camera_->read(frame_, kPatience), frame);
  over = true;
  camera_.reset();
}

TEST_F(RemoteCameraTest, KeepsWhatIsThereOfAFrameUntilTheRestComes) {
  const RemoteSender sender(path());
  const std::vector<std::byte> bytes = frame_of(700).bytes();
  const std::span all(bytes);
  for (const std::size_t end : {1u, 159u, 160u, 161u, 255u}) {
    const std::size_t begin = end == 1 ? 0 : end == 159 ? 1 : end == 255 ? 161 : end - 1;
    ASSERT_TRUE(sender.send(all.subspan(begin, end - begin)));
    EXPECT_EQ(look(), waiting) << end;
  }
  ASSERT_TRUE(sender.send(all.subspan(255)));
  expect_millimetres(700);
}

TEST_F(RemoteCameraTest, PartsFromAProgramThatSendsGarbageAndTellsBoth) {
  {
    const RemoteSender sender(path());
    RemoteFrame bad = frame_of(700);
    bad.lens[0] = std::nan("");
    ASSERT_TRUE(sender.send(frame_of(699)));
    ASSERT_TRUE(sender.send(bad));
    ASSERT_TRUE(sender.send(frame_of(701)));
    expect_millimetres(699);
    EXPECT_EQ(look(), damaged);
    EXPECT_EQ(camera_->reason(), "fx is nan; send the focal length in pixels");
    EXPECT_EQ(sender.last_words(), "fx is nan; send the focal length in pixels\n");
    EXPECT_EQ(look(), waiting) << "it is told once, and nothing that follows is read";
  }
  const RemoteSender next(path());
  ASSERT_TRUE(next.send(frame_of(702)));
  expect_millimetres(702);
}

TEST_F(RemoteCameraTest, ServesOneProgramAtATime) {
  RemoteSender first(path());
  ASSERT_TRUE(first.send(frame_of(700)));
  expect_millimetres(700);
  const RemoteSender second(path());
  static_cast<void>(second.send(frame_of(900)));
  EXPECT_EQ(look(), waiting);
  EXPECT_EQ(second.last_words(), "another program is this camera; stop that one\n");
  ASSERT_TRUE(first.send(frame_of(701)));
  expect_millimetres(701);
  ASSERT_TRUE(first.send(frame_of(702)));
  first.leave();
  const RemoteSender third(path());
  expect_millimetres(702);
  ASSERT_TRUE(third.send(frame_of(703)));
  expect_millimetres(703);
}

TEST_F(RemoteCameraTest, ServesItsProgramThoughNoOtherCanBeLetIn) {
  const RemoteSender first(path());
  ASSERT_TRUE(first.send(frame_of(700)));
  expect_millimetres(700);
  const RemoteSender second(path());
  const int next = ::dup(0);  // what a file that is opened now would be
  ::close(next);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit full{static_cast<rlim_t>(next), before.rlim_max};
  ASSERT_TRUE(first.send(frame_of(701)));
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &full), 0);
  const DepthCamera::Status served = look();
  const DepthCamera::Status then = look();
  const std::string why = camera_->reason();
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(served, frame);
  EXPECT_EQ(then, failed);
  EXPECT_TRUE(contains(why, "no program can connect")) << why;
  EXPECT_EQ(look(), waiting);
  EXPECT_EQ(second.last_words(), "another program is this camera; stop that one\n");
}

TEST_F(RemoteCameraTest, AProgramThatDiesInTheMiddleOfAFrameLeavesNothingOfIt) {
  RemoteSender sender(path());
  const std::vector<std::byte> bytes = frame_of(700).bytes();
  ASSERT_TRUE(sender.send(std::span(bytes).first(200)));
  EXPECT_EQ(look(), waiting);
  sender.leave();
  EXPECT_EQ(look(), damaged);
  EXPECT_EQ(camera_->reason(), "a program left after 200 bytes of a frame");
  EXPECT_EQ(look(), waiting);
  const RemoteSender next(path());
  ASSERT_TRUE(next.send(frame_of(701)));
  expect_millimetres(701);
}

TEST_F(RemoteCameraTest, GoesOnWithTheSameCameraAlone) {
  {
    const RemoteSender sender(path());
    ASSERT_TRUE(sender.send(frame_of(700)));
    expect_millimetres(700);
  }
  const auto expect_refusal = [&](const RemoteFrame& sent, const char* was) {
    const RemoteSender sender(path());
    ASSERT_TRUE(sender.send(sent));
    EXPECT_EQ(look(), damaged);
    EXPECT_TRUE(contains(camera_->reason(), was)) << camera_->reason();
    EXPECT_TRUE(contains(camera_->reason(), "but was 8 x 6 pixels, fx 8, ")) << camera_->reason();
    EXPECT_EQ(sender.last_words(), camera_->reason() + "\n");
  };
  RemoteFrame other = frame_of(700);
  other.lens[0] = 8.0000000000000018;
  expect_refusal(other, "fx 8.000000000000002");
  other = frame_of(700);
  other.distortion[4] = 1e-9;
  expect_refusal(other, "1e-09, but");
  other = frame_of(700);
  std::swap(other.width, other.height);
  expect_refusal(other, "is 6 x 8 pixels");
  const RemoteSender sender(path());
  ASSERT_TRUE(sender.send(frame_of(701)));
  expect_millimetres(701);
}

TEST_F(RemoteCameraTest, BringsStampsToItsClock) {
  const auto stamp = [&](const RemoteSender& sender, double now, std::optional<double> told) {
    clock_.set(now);
    RemoteFrame sent = frame_of(700);
    sent.flags = told ? 2 : 0;
    sent.stamp = told.value_or(0);
    EXPECT_TRUE(sender.send(sent));
    EXPECT_EQ(look(), frame) << camera_->reason();
    return frame_.stamp;
  };
  {
    const RemoteSender sender(path());
    EXPECT_DOUBLE_EQ(stamp(sender, 100.05, 7.00), 100.05);
    EXPECT_DOUBLE_EQ(stamp(sender, 100.11, 7.10), 100.11) << "the quickest way so far";
    EXPECT_NEAR(stamp(sender, 100.24, 7.20), 100.21, 1e-4) << "was late, by its clock";
    EXPECT_DOUBLE_EQ(stamp(sender, 100.3, {}), 100.3);
  }
  const RemoteSender next(path());
  EXPECT_DOUBLE_EQ(stamp(next, 100.5, 7.30), 100.5) << "a program's clock is its own";
}

TEST_F(RemoteCameraTest, HasAPlaceOfItsOwnWhereTheSystemHasOne) {
  const char* variable = std::getenv("XDG_RUNTIME_DIR");
  const std::optional<std::string> before =
      variable == nullptr ? std::nullopt : std::optional<std::string>(variable);
  ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
  {
    const auto camera = open_camera("remote");
    EXPECT_TRUE(RemoteSender(folder_ / "palpate-camera").connected());
    EXPECT_THROW((void)open_camera("remote"), Error) << "one has it";
  }
  EXPECT_FALSE(RemoteSender(folder_ / "palpate-camera").connected());
  ::unsetenv("XDG_RUNTIME_DIR");
  EXPECT_THROW((void)open_camera("remote"), Error);
  if (before) ::setenv("XDG_RUNTIME_DIR", before->c_str(), 1);
}

}  // namespace
}  // namespace palpate::sensor
