#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

#include "dds/endpoint.hpp"
#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate {
namespace {

using namespace message;

// A node with a camera, in a domain of the test's own.
struct Node {
  Node() : participant((set_domain(), dds::environment_options())) {}

  static void set_domain() {
    setenv("ROS_DOMAIN_ID", std::to_string(100 + getpid() % 100).c_str(), 1);
  }

  void send(const Header& header, const std::string& encoding = "32FC1") {
    message::CameraInfo info =
        info_of({.width = 4, .height = 3, .pinhole = {5, 5, 2, 1.5}, .distortion = {}});
    info.header = header;
    infos.write(info);
    DepthFrame frame;
    frame.camera = {.width = 4, .height = 3, .pinhole = {}, .distortion = {}};
    frame.depth.assign(12, 1.5F);
    Image image = image_of(frame);
    image.header = header;
    image.encoding = encoding;
    images.write(image);
  }

  dds::Participant participant;
  dds::Writer<Image> images{participant, "/cam/image", {.reliable = true}};
  dds::Writer<message::CameraInfo> infos{participant, "/cam/camera_info", {.reliable = true}};
  dds::Writer<PointCloud2> clouds{participant, "/points", {.reliable = true}};
  dds::Writer<TFMessage> frames{participant, "/tf", {.reliable = true, .depth = 10}};
};

Header now(const std::string& frame = "camera") {
  return {to_time(system_now()), frame};
}

// The first answer that is not `waiting`, while `send` is called.
DepthCamera::Status answer(DepthCamera& camera, DepthFrame& frame,
                           const std::function<void()>& send) {
  for (int i = 0; i < 200; ++i) {
    send();
    const DepthCamera::Status status = camera.read(frame, 0.05);
    if (status != DepthCamera::Status::waiting) return status;
  }
  return DepthCamera::Status::waiting;
}

// The first frame.
bool gets_frame(DepthCamera& camera, DepthFrame& frame, const std::function<void()>& send) {
  for (int i = 0; i < 200; ++i) {
    if (answer(camera, frame, send) == DepthCamera::Status::frame) return true;
  }
  return false;
}

TEST(RosCamera, GivesFramesInMetresOnTheStreamsClock) {
  Node node;
  SteadyClock clock;
  const auto camera = open_camera("ros:/cam/image", {.clock = &clock});
  DepthFrame frame;
  const double begin = clock.now();
  ASSERT_TRUE(gets_frame(*camera, frame, [&] { node.send(now()); })) << camera->reason();
  EXPECT_EQ(frame.camera.width, 4);
  EXPECT_EQ(frame.camera.pinhole.fx, 5);
  EXPECT_EQ(frame.depth.front(), 1.5F);
  EXPECT_FALSE(frame.T_world_sensor);
  EXPECT_LE(frame.stamp, clock.now());
  EXPECT_GT(frame.stamp, begin - 1) << "the clocks are read one after the other";
}

TEST(RosCamera, GivesFramesInTheUnitThatIsGiven) {
  Node node;
  const auto camera = open_camera("ros:/cam/image,unit=0.001");
  DepthFrame frame;
  ASSERT_TRUE(gets_frame(*camera, frame, [&] { node.send(now()); })) << camera->reason();
  EXPECT_FLOAT_EQ(frame.depth.front(), 0.0015F);
  EXPECT_THAT([] { static_cast<void>(open_camera("ros:/cam/image,unit=mm")); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("ros:/cam/image,unit=METRES")));
}

TEST(RosCamera, TakesTheTimeOfArrivalOfAnotherClocksStamps) {
  Node node;
  SteadyClock clock;
  const auto camera = open_camera("ros:/cam/image", {.clock = &clock});
  DepthFrame frame;
  const double begin = clock.now();
  ASSERT_TRUE(gets_frame(*camera, frame, [&] { node.send({{77, 0}, "camera"}); }));
  EXPECT_GE(frame.stamp, begin);
}

TEST(RosCamera, SaysWhatItWaitsForOrCannotUse) {
  Node node;
  const auto nobody = open_camera("ros:/nobody/image");
  DepthFrame frame;
  EXPECT_EQ(nobody->read(frame, 0.01), DepthCamera::Status::waiting);
  EXPECT_THAT(nobody->reason(), testing::HasSubstr("no node publishes /nobody/image"));
  const auto camera = open_camera("ros:/cam/image");
  EXPECT_EQ(answer(*camera, frame, [&] { node.send(now(), "rgb8"); }),
            DepthCamera::Status::damaged);
  EXPECT_THAT(camera->reason(),
              testing::AnyOf(testing::HasSubstr("rgb8"), testing::HasSubstr("CameraInfo")));
  EXPECT_THROW(static_cast<void>(open_camera("ros:cam")), std::exception);
  EXPECT_THROW(static_cast<void>(open_camera("ros:/cam/image,frame=")), std::exception);
}

TEST(RosCamera, PlacesFramesByTheirTransform) {
  Node node;
  const auto camera = open_camera("ros:/cam/image,frame=world");
  DepthFrame frame;
  bool placed = false;
  const auto send = [&] {
    const Header header = now();
    if (placed) {
      node.frames.write({{{{header.stamp, "world"}, "camera", {{1, 2, 3}, {}}}}});
    }
    node.send(header);
  };
  DepthCamera::Status status = DepthCamera::Status::waiting;
  for (int i = 0; i < 100 && status != DepthCamera::Status::unposed; ++i)
    status = answer(*camera, frame, send);
  EXPECT_EQ(status, DepthCamera::Status::unposed);
  EXPECT_THAT(camera->reason(), testing::HasSubstr("/tf"));
  placed = true;
  ASSERT_TRUE(gets_frame(*camera, frame, send)) << camera->reason();
  EXPECT_EQ(frame.T_world_sensor->translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(RosCamera, GivesTheCloudOfASensorThatDeliversPoints) {
  Node node;
  const auto camera = open_camera("ros:/points");
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}, {4, 5, 6}};
  DepthFrame frame;
  ASSERT_TRUE(gets_frame(*camera, frame, [&] {
    PointCloud2 message = message_of(cloud);
    message.header = now();
    node.clouds.write(message);
  })) << camera->reason();
  ASSERT_TRUE(frame.cloud);
  EXPECT_EQ(frame.cloud->positions, cloud.positions);
}

}  // namespace
}  // namespace palpate
