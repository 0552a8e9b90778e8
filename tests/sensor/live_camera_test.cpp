#include "sensor/live_camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"
#include "sensor/fake_camera.hpp"

namespace palpate::sensor {
namespace {

using testing::HasSubstr;

// What a device does, and how often it was opened.
struct Device {
  bool absent = false;
  bool lost = false;
  DepthCamera::Status status = DepthCamera::Status::frame;
  double time = 0;
  int opened = 0;
};

class DeviceConnection final : public Connection {
 public:
  explicit DeviceConnection(Device& device) : device_(device) {
    if (device.absent) throw Error("it is not there");
    ++device.opened;
  }
  [[nodiscard]] DepthCamera::Status fetch(DepthFrame& frame, double& device_time,
                                          double /*timeout*/) override {
    if (device_.lost) throw Error("it is lost");
    frame.depth = {1};
    device_time = device_.time;
    return device_.status;
  }
  [[nodiscard]] std::string damage() const override { return "it is torn"; }

 private:
  Device& device_;
};

class LiveCameraTest : public testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<LiveCamera> open(bool paces = true,
                                                 Lost lost = Lost::opened_again) {
    return std::make_unique<LiveCamera>(
        CameraInfo{.name = "device", .rate = 10, .paces = paces},
        [this] { return std::make_unique<DeviceConnection>(device_); }, "Shake it.", &clock_, lost);
  }
  // The stamp of the next frame.
  double stamp(LiveCamera& camera, double now, double device_time) {
    clock_.set(now);
    device_.time = device_time;
    EXPECT_EQ(camera.read(frame_, 0), DepthCamera::Status::frame);
    return frame_.stamp;
  }

  Device device_;
  ManualClock clock_;
  DepthFrame frame_;
};

TEST_F(LiveCameraTest, ThrowsWhenItCannotBeOpened) {
  device_.absent = true;
  EXPECT_THROW((void)open(), Error);
}

TEST_F(LiveCameraTest, OpensALostDeviceAgain) {
  const auto camera = open();
  device_.lost = true;
  device_.absent = true;
  EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::failed);
  EXPECT_EQ(camera->reason(), "it is lost");
  EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::failed);
  EXPECT_EQ(camera->reason(), "it is not there");
  device_.lost = false;
  device_.absent = false;
  EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::frame);
  EXPECT_EQ(camera->reason(), "");
  EXPECT_EQ(device_.opened, 2);
}

TEST_F(LiveCameraTest, OpensASilentDeviceAgain) {
  const auto camera = open();
  device_.status = DepthCamera::Status::waiting;
  clock_.set(2.9);
  EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::waiting);
  clock_.set(3.1);
  EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::failed);
  EXPECT_EQ(camera->reason(), "device: open, but silent for 3.1 s. Shake it.");
  EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::waiting)
      << "a new start has its own time";
  EXPECT_EQ(device_.opened, 2);
}

TEST_F(LiveCameraTest, LeavesDamagedFramesOutAndStaysOpen) {
  for (const Lost lost : {Lost::opened_again, Lost::ended}) {
    device_ = {};
    clock_.set(0);
    const auto camera = open(true, lost);
    for (int i = 1; i <= 10; ++i) {
      clock_.set(i);
      device_.status = DepthCamera::Status::damaged;
      EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::damaged);
      EXPECT_EQ(camera->reason(), "it is torn");
    }
    device_.status = DepthCamera::Status::waiting;
    EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::waiting) << "damaged, but not silent";
    device_.status = DepthCamera::Status::frame;
    EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::frame);
    EXPECT_EQ(camera->reason(), "");
    EXPECT_EQ(device_.opened, 1);
  }
}

TEST_F(LiveCameraTest, EndsALostRecording) {
  const auto camera = open(true, Lost::ended);
  device_.lost = true;
  EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::failed);
  EXPECT_EQ(camera->reason(), "it is lost");
  device_.lost = false;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::ended);
  EXPECT_EQ(device_.opened, 1) << "it would play from its beginning";
}

TEST_F(LiveCameraTest, BeginsARecordingAgainAndNoDevice) {
  const auto recording = open(false, Lost::ended);
  EXPECT_DOUBLE_EQ(stamp(*recording, 5, 7.0), 0);
  EXPECT_DOUBLE_EQ(stamp(*recording, 5, 7.5), 0.5);
  recording->begin(3);
  EXPECT_EQ(device_.opened, 2) << "opened again, it plays from its beginning";
  EXPECT_DOUBLE_EQ(stamp(*recording, 6, 7.0), 3);
  EXPECT_DOUBLE_EQ(stamp(*recording, 6, 7.5), 3.5);
  const auto device = open();
  device->begin(3);
  EXPECT_EQ(device_.opened, 3);
}

TEST_F(LiveCameraTest, WaitsForARecordingThatIsSilent) {
  const auto camera = open(true, Lost::ended);
  device_.status = DepthCamera::Status::waiting;
  for (const double now : {4.0, 8.0}) {
    clock_.set(now);
    EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::failed);
    EXPECT_EQ(camera->reason(), "device: open, but silent for 4 s. Shake it.");
    EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::waiting);
  }
  device_.status = DepthCamera::Status::frame;
  EXPECT_EQ(camera->read(frame_, 0), DepthCamera::Status::frame);
  EXPECT_EQ(device_.opened, 1);
}

TEST_F(LiveCameraTest, BringsStampsToTheHostsClock) {
  const auto camera = open();
  EXPECT_DOUBLE_EQ(stamp(*camera, 100.050, 7.000), 100.050);
  EXPECT_DOUBLE_EQ(stamp(*camera, 100.110, 7.100), 100.110) << "the quickest way so far";
  EXPECT_NEAR(stamp(*camera, 100.240, 7.200), 100.210, 1e-4) << "was late, by the device's clock";
  EXPECT_NEAR(stamp(*camera, 100.310, 7.300), 100.310, 1e-4);
}

TEST_F(LiveCameraTest, FollowsClocksThatDrift) {
  const auto camera = open();
  double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double now = 0.1 * i;
    worst = std::max(worst, std::abs(stamp(*camera, now, now * (1 - 1e-4)) - now));
  }
  EXPECT_LT(worst, 1e-4);
}

TEST_F(LiveCameraTest, BeginsAnewWhenTheDevicesClockDoes) {
  const auto camera = open();
  (void)stamp(*camera, 100, 500);
  EXPECT_DOUBLE_EQ(stamp(*camera, 100.1, 0), 100.1);
  EXPECT_DOUBLE_EQ(stamp(*camera, 100.2, 60), 100.2);
}

TEST_F(LiveCameraTest, CountsTheTimeOfRecordingsThatAreReadAsFastAsAsked) {
  const auto camera = open(false);
  EXPECT_DOUBLE_EQ(stamp(*camera, 5, 7.0), 0);
  EXPECT_DOUBLE_EQ(stamp(*camera, 5, 7.25), 0.25);
  EXPECT_DOUBLE_EQ(stamp(*camera, 9, 7.0), 0.35) << "began again";
  EXPECT_DOUBLE_EQ(stamp(*camera, 9, 7.25), 0.6);
}

TEST(KinectDepth, HasTheReferencePlaneAndTheEnds) {
  EXPECT_NEAR(kinect_metres(802), 1.2 * 0.075 / (0.075 - 0.125 * 1.042e-3), 1e-6);
  EXPECT_EQ(kinect_metres(2047), 0.0F);
  EXPECT_EQ(kinect_metres(1090), 0.0F) << "beyond infinity";
  EXPECT_EQ(kinect_metres(65535), 0.0F);
  EXPECT_GT(kinect_metres(0), 0.2F);
  for (std::uint16_t raw = 1; raw < 1050; ++raw) {
    EXPECT_GT(kinect_metres(raw), kinect_metres(static_cast<std::uint16_t>(raw - 1)));
  }
}

}  // namespace
}  // namespace palpate::sensor
