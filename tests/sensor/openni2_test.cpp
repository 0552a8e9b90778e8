// OpenNI2 as it is installed: its dummy camera, and recordings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sensor/fake_camera.hpp"
#include "sensor/folder.hpp"
#include "sensor/live_camera.hpp"
#include "sensor/oni_file.hpp"
#include "sensor/openni2_library.hpp"

namespace palpate {
namespace {

using namespace sensor;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(const std::string& name) {
  try {
    (void)open_camera(name);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// Reads until something else than `waiting` comes.
DepthCamera::Status next(DepthCamera& camera, DepthFrame& frame) {
  for (int i = 0; i < 100; ++i) {
    const DepthCamera::Status status = camera.read(frame, 0.1);
    if (status != DepthCamera::Status::waiting) return status;
  }
  return DepthCamera::Status::waiting;
}

TEST(OpenNi2, SaysThatThereIsNoCameraOrFile) {
  EXPECT_THAT(refusal("openni2:/no/such/uri"), AllOf(HasSubstr("/no/such/uri"), HasSubstr("USB")));
  EXPECT_THAT(refusal("absent.oni"), HasSubstr("no such file"));
}

TEST(OpenNi2, RefusesGarbageForARecording) {
  const Folder folder;
  folder.write("a.oni", "garbage");
  folder.write("empty.oni", "");
  EXPECT_THAT(refusal((folder.path() / "a.oni").string()), HasSubstr("recording"));
  EXPECT_THAT(refusal((folder.path() / "empty.oni").string()), HasSubstr("recording"));
}

// What the dummy camera's first frame is like; empty: as it should be.
std::string dummy_frame() {
  ManualClock clock;
  clock.set(50);
  const auto camera = open_camera("openni2:Dummy", {.clock = &clock}).release();
  DepthFrame frame;
  if (next(*camera, frame) != DepthCamera::Status::frame) return "no frame: " + camera->reason();
  if (frame.camera.width != 320 || frame.camera.height != 240) return "its size";
  if (frame.depth.size() != 320u * 240u || frame.depth[100] != 2.0F) return "its depths";
  if (std::abs(frame.camera.pinhole.fx - 287.9) > 0.1) return "its nominal focal length";
  return frame.stamp == 50 ? "" : "its stamp";
}

// In a process of its own that does not close the camera: the dummy's thread outlives what it uses.
TEST(OpenNi2DeathTest, PlaysItsDummyCamera) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto play = [] {
    const std::string fault = dummy_frame();
    std::fputs(fault.c_str(), stderr);
    std::_Exit(fault.empty() ? 0 : 1);
  };
  EXPECT_EXIT(play(), testing::ExitedWithCode(0), "");
}

TEST(OpenNi2, ReportsRecordingsThatNeverPlay) {
  const Folder folder;
  folder.write("a.oni", OniFile(64, 48, 8, {.whole = false}).bytes());
  ManualClock clock;
  const auto camera = open_camera((folder.path() / "a.oni").string(), {.clock = &clock});
  DepthFrame frame;
  EXPECT_EQ(camera->read(frame, 0.1), DepthCamera::Status::waiting);
  clock.set(4);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::failed);
  EXPECT_THAT(camera->reason(), AllOf(HasSubstr("silent for 4 s"), HasSubstr("dummy device")));
}

TEST(OpenNi2, PlaysARecordingToItsEnd) {
  const Folder folder;
  folder.write("a.oni", OniFile(64, 48, 8).bytes());
  const auto camera = open_camera((folder.path() / "a.oni").string());
  EXPECT_FALSE(camera->info().paces);
  DepthFrame frame;
  int frames = 0;
  double stamp = -1;
  while (next(*camera, frame) == DepthCamera::Status::frame) {
    ++frames;
    EXPECT_EQ(frame.depth.at(7), static_cast<float>(1e-3 * (1000 + frames)));
    EXPECT_EQ(frame.depth[0], 0.5F);
    EXPECT_GT(frame.stamp, stamp);
    stamp = frame.stamp;
  }
  EXPECT_EQ(frames, 8);
  EXPECT_NEAR(stamp, 7 / 30.0, 1e-3);
  EXPECT_NEAR(frame.camera.pinhole.fx, 32 / std::tan(0.5), 1e-6);
  EXPECT_NEAR(frame.camera.pinhole.cy, 24, 1e-9);
  EXPECT_EQ(next(*camera, frame), DepthCamera::Status::ended);
}

TEST(OpenNi2, LeavesADamagedFrameOutAndPlaysOn) {
  const Folder folder;
  folder.write("a.oni", OniFile(64, 48, 6, {.cut = 3}).bytes());
  const auto camera = open_camera((folder.path() / "a.oni").string());
  std::vector<DepthCamera::Status> came;
  DepthFrame frame;
  do {
    came.push_back(next(*camera, frame));
    if (came.back() == DepthCamera::Status::damaged) {
      EXPECT_THAT(camera->reason(), AllOf(HasSubstr("a.oni"), HasSubstr("damaged")));
    }
  } while (came.back() != DepthCamera::Status::ended && came.size() < 20);
  constexpr auto kGood = DepthCamera::Status::frame;
  EXPECT_THAT(came, ElementsAre(kGood, kGood, DepthCamera::Status::damaged, kGood, kGood, kGood,
                                DepthCamera::Status::ended));
}

// A frame that says all that it needs to.
OniFrame oni_frame(std::vector<OniDepthPixel>& depths, int width, int height) {
  depths.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 1500);
  OniFrame frame{};
  frame.data = depths.data();
  frame.width = width;
  frame.height = height;
  frame.stride = 2 * width;
  frame.dataSize = 2 * width * height;
  frame.videoMode.pixelFormat = ONI_PIXEL_FORMAT_DEPTH_1_MM;
  return frame;
}

TEST(OpenNi2Frame, IsWholeOrNot) {
  std::vector<OniDepthPixel> depths;
  const OniFrame good = oni_frame(depths, 4, 3);
  EXPECT_TRUE(is_whole(good));
  const auto with = [&](const std::function<void(OniFrame&)>& change) {
    OniFrame frame = good;
    change(frame);
    return is_whole(frame);
  };
  EXPECT_FALSE(with([](OniFrame& frame) { frame.data = nullptr; }));
  EXPECT_FALSE(with([](OniFrame& frame) { frame.dataSize -= 1; }));
  EXPECT_FALSE(with([](OniFrame& frame) { frame.stride -= 1; }));
  EXPECT_FALSE(with([](OniFrame& frame) { frame.width = 0; }));
  EXPECT_FALSE(with([](OniFrame& frame) { frame.height = -3; }));
  EXPECT_FALSE(
      with([](OniFrame& frame) { frame.videoMode.pixelFormat = ONI_PIXEL_FORMAT_RGB888; }));
  constexpr int kHuge = std::numeric_limits<int>::max();
  EXPECT_FALSE(with([](OniFrame& frame) { frame.stride = frame.height = kHuge; }));
  EXPECT_FALSE(with([](OniFrame& frame) { frame.width = kHuge; }));
}

TEST(OpenNi2Frame, HasItsRowsWhereItsStrideSays) {
  std::vector<OniDepthPixel> depths;
  OniFrame frame = oni_frame(depths, 4, 2);
  frame.width = 3;  // the fourth of a row belongs to nothing
  for (std::size_t i = 0; i < depths.size(); ++i) {
    depths[i] = static_cast<OniDepthPixel>(1000 * (i + 1));
  }
  std::vector<float> depth;
  copy_depth(frame, false, depth);
  EXPECT_THAT(depth, ElementsAre(1, 2, 3, 5, 6, 7));
  copy_depth(frame, true, depth);
  EXPECT_THAT(depth, ElementsAre(3, 2, 1, 7, 6, 5));
  frame.videoMode.pixelFormat = ONI_PIXEL_FORMAT_DEPTH_100_UM;
  copy_depth(frame, false, depth);
  EXPECT_FLOAT_EQ(depth.at(0), 0.1F);
}

TEST(OpenNi2, LoopsARecording) {
  const Folder folder;
  folder.write("a.oni", OniFile(64, 48, 4).bytes());
  const auto camera = open_camera((folder.path() / "a.oni").string(), {.loop = true});
  DepthFrame frame;
  double stamp = -1;
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(next(*camera, frame), DepthCamera::Status::frame) << i << camera->reason();
    EXPECT_GT(frame.stamp, stamp);
    stamp = frame.stamp;
  }
}

TEST(OpenNi2, TurnsMirroredRecordingsRound) {
  const Folder folder;
  folder.write("a.oni", OniFile(64, 48, 2, {.mirrored = true}).bytes());
  const auto camera = open_camera((folder.path() / "a.oni").string());
  DepthFrame frame;
  ASSERT_EQ(next(*camera, frame), DepthCamera::Status::frame);
  EXPECT_EQ(frame.depth[63], 0.5F);
  EXPECT_EQ(frame.depth[0], 1.001F);
}

TEST(OpenNi2, IsListed) {
  for (const DriverInfo& driver : list_cameras()) {
    if (driver.name != "openni2") continue;
    EXPECT_TRUE(driver.available) << driver.missing;
    return;
  }
  FAIL() << "no driver of that name";
}

}  // namespace
}  // namespace palpate
