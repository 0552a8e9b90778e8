// Nodes whose images are none. Nothing of them crashes palpate or fills its memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "dds/hostile.hpp"
#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "palpate/device/hardware.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "support/effort.hpp"

namespace palpate::hostile {
namespace {

using namespace message;
using Status = DepthCamera::Status;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

Image small_image() {
  DepthFrame frame;
  frame.camera = {.width = 4, .height = 3, .pinhole = {}, .distortion = {}};
  frame.depth.assign(12, 1.5F);
  Image image = image_of(frame);
  image.header = {to_time(system_now()), "camera"};
  return image;
}

// A node that sends any bytes as images, and a camera that takes them.
class HostileImages : public testing::Test {
 protected:
  void send(const Bytes& bytes) {
    message::CameraInfo info =
        info_of({.width = 4, .height = 3, .pinhole = {5, 5, 2, 1.5}, .distortion = {}});
    infos_.write(info);
    images_.write(bytes);
  }

  // The camera's next answer to `bytes`, sent until it has one; frames are of what was sent before.
  Status answer_to(const Bytes& bytes) {
    Status status = Status::waiting;
    before_long([&] {
      send(bytes);
      status = camera_->read(frame_, 0.05);
      return status != Status::waiting && status != Status::frame;
    });
    return status;
  }

  bool sees_a_frame() {
    return before_long([&] {
      send(bytes_of(small_image()));
      return camera_->read(frame_, 0.05) == Status::frame;
    });
  }

  dds::Participant participant_{own_domain()};
  dds::RawWriter images_{participant_, {"/cam/image", Image::kName, Image::kHash}, {.depth = 2}};
  dds::Writer<message::CameraInfo> infos_{participant_, "/cam/camera_info", {.reliable = true}};
  SteadyClock clock_;
  std::unique_ptr<DepthCamera> camera_ = open_camera("ros:/cam/image", {.clock = &clock_});
  DepthFrame frame_;
};

TEST_F(HostileImages, ThatAreDamagedAreToldAndLeftOut) {
  ASSERT_TRUE(sees_a_frame()) << camera_->reason();
  const auto spoiled = [](auto&& spoil) {
    Image image = small_image();
    spoil(image);
    return bytes_of(image);
  };
  const Bytes whole = bytes_of(small_image());
  std::vector<Bytes> damaged = {{},
                                {0, 1, 0, 0},
                                {0, 9, 0, 0, 1, 2, 3, 4},
                                Bytes(whole.begin(), whole.begin() + 40),
                                Bytes(whole.begin(), whole.end() - 20),
                                spoiled([](Image& image) { image.step = 0; }),
                                spoiled([](Image& image) { image.step = 0x80000000U; }),
                                spoiled([](Image& image) { image.width = 0x80000000U; }),
                                spoiled([](Image& image) { image.height = 0xffffffffU; }),
                                spoiled([](Image& image) { image.encoding = "16UC1\xff"; }),
                                spoiled([](Image& image) { image.data.clear(); })};
  Bytes length = whole;  // of the frame's name: 2^31 and more
  for (std::size_t i = 12; i < 16; ++i) length.at(i) = 0xff;
  damaged.push_back(length);
  for (const Bytes& bytes : damaged) {
    EXPECT_EQ(answer_to(bytes), Status::damaged) << testing::PrintToString(bytes);
    EXPECT_FALSE(camera_->reason().empty());
  }
  EXPECT_TRUE(sees_a_frame()) << camera_->reason();
}

TEST_F(HostileImages, WithStampsThatJumpAreTakenAsTheyCome) {
  for (const double stamp : {0.0, 1e9, system_now() - 3600, system_now() + 3600, 2147483646.0}) {
    Image image = small_image();
    image.header.stamp = to_time(stamp);
    const double begin = clock_.now();
    ASSERT_TRUE(before_long([&] {
      send(bytes_of(image));
      return camera_->read(frame_, 0.05) == Status::frame;
    }));
    EXPECT_GE(frame_.stamp, begin - 1) << stamp;
    EXPECT_LE(frame_.stamp, clock_.now()) << stamp;
  }
}

TEST_F(HostileImages, TenThousandASecondFillNoMemory) {
  if (test::is_slow_build()) GTEST_SKIP() << "sanitizers keep what was freed";
  ASSERT_TRUE(sees_a_frame()) << camera_->reason();
  Image image = small_image();
  image.data.resize(40'000);
  const Bytes bytes = bytes_of(image);
  const double before = memory();
  std::atomic<bool> done = false;
  std::thread flood([&] {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 20'000; ++i) {
      images_.write(bytes);
      std::this_thread::sleep_until(start + std::chrono::microseconds(100) * i);
    }
    done = true;
  });
  int frames = 0;
  while (!done) {
    frames += camera_->read(frame_, 0.05) == Status::frame ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(33));  // what the filter takes
  }
  flood.join();
  EXPECT_GT(frames, 10);
  EXPECT_LT(memory() - before, kMostMemory);
}

TEST(HostileNode, WhoseCloudsAndPosesAreNoneIsToldOf) {
  const dds::Participant participant(own_domain());
  dds::Writer<PointCloud2> clouds(participant, "/hostile/points", {.depth = 2});
  dds::Writer<TFMessage> frames(participant, "/tf", {.reliable = true, .depth = 10});
  const auto camera = open_camera("ros:/hostile/points,frame=world");
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}};
  const auto becomes = [&](Status wanted, auto&& spoil) {
    DepthFrame frame;
    return before_long([&] {
      PointCloud2 message = message_of(cloud);
      message.header = {to_time(system_now()), "camera"};
      spoil(message);
      frames.write({{{{message.header.stamp, "world"}, "camera", {{kNoNumber, 0, 0}, {}}}}});
      clouds.write(message);
      return camera->read(frame, 0.05) == wanted && !camera->reason().empty();
    });
  };
  EXPECT_TRUE(becomes(Status::damaged, [](PointCloud2& message) { message.point_step = 0; }));
  EXPECT_TRUE(becomes(Status::damaged, [](PointCloud2& message) { message.width = 1U << 31U; }));
  EXPECT_TRUE(becomes(Status::unposed, [](PointCloud2& message) {
    std::ranges::fill(message.data, std::uint8_t{0xff});  // all not numbers: an empty cloud
  }));
  EXPECT_TRUE(becomes(Status::unposed, [](PointCloud2&) {})) << "a transform that is none";
}

TEST(HostileNode, WithAnotherTypeUnderTheTopicsNameIsNotHeard) {
  const dds::Participant participant(own_domain());
  dds::Writer<PoseStamped> wrong(participant, "/typed/image", {.reliable = true});
  const auto camera = open_camera("ros:/typed/image");
  DepthFrame frame;
  EXPECT_TRUE(before_long([&] {
    wrong.write(PoseStamped{});
    EXPECT_EQ(camera->read(frame, 0.01), Status::waiting);
    return camera->reason().find("geometry_msgs/PoseStamped") != std::string::npos;
  })) << camera->reason();
  dds::Writer<Image> poses(participant, "/typed/pose", {.reliable = true});
  const dds::Reader<WrenchStamped> wrenches(participant, "/typed/wrench", {});
  SteadyClock clock;
  EXPECT_THAT(
      [&] {
        static_cast<void>(open_device("ros:generic,pose=/typed/pose,wrench=/typed/wrench", clock));
      },
      testing::ThrowsMessage<std::exception>(testing::HasSubstr("no node publishes /typed/pose")));
}

}  // namespace
}  // namespace palpate::hostile
