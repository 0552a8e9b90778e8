#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>

#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sensor/bag_recorder.hpp"
#include "sensor/fake_camera.hpp"

namespace palpate::sensor {
namespace {

using bag::kNoon;
using bag::kSecond;
using bag::McapWriter;
using testing::AllOf;
using testing::HasSubstr;
using Status = DepthCamera::Status;

TEST_F(BagCamera, GivesImagesInMetresByTheirStamps) {
  record(3);
  const auto camera = open_camera(name_);
  EXPECT_EQ(camera->info().name, name_);
  EXPECT_NEAR(camera->info().rate, 10, 1e-9);
  EXPECT_FALSE(camera->info().paces);
  DepthFrame frame;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(camera->read(frame, 0), Status::frame) << camera->reason();
    EXPECT_NEAR(frame.stamp, 0.1 * i, 1e-6);
    EXPECT_EQ(frame.depth.front(), 1 + static_cast<float>(i));
    EXPECT_EQ(frame.camera.pinhole.fx, 4);
    EXPECT_FALSE(frame.T_world_sensor);
  }
  EXPECT_EQ(camera->read(frame, 0), Status::ended);
  EXPECT_EQ(camera->read(frame, 0), Status::ended);
}

TEST_F(BagCamera, BeginsAgainAndLoops) {
  record(3);
  const auto camera = open_camera(name_, {.loop = true});
  DepthFrame frame;
  ASSERT_EQ(camera->read(frame, 0), Status::frame);
  camera->begin(5);
  for (int i = 0; i < 7; ++i) {
    ASSERT_EQ(camera->read(frame, 0), Status::frame);
    EXPECT_NEAR(frame.stamp, 5 + 0.1 * i, 1e-6);
    EXPECT_EQ(frame.depth.front(), 1 + static_cast<float>(i % 3));
  }
}

TEST_F(BagCamera, KeepsTheRecordingsPace) {
  record(2);
  ManualClock clock;
  clock.set(7);
  const auto camera = open_camera(name_, {.clock = &clock});
  EXPECT_TRUE(camera->info().paces);
  DepthFrame frame;
  ASSERT_EQ(camera->read(frame, 0), Status::frame);
  EXPECT_EQ(frame.stamp, 7);
  EXPECT_EQ(camera->read(frame, 0), Status::waiting);
  clock.set(7.2);
  ASSERT_EQ(camera->read(frame, 0), Status::frame);
  EXPECT_NEAR(frame.stamp, 7.1, 1e-6);
  EXPECT_EQ(camera->read(frame, 0), Status::ended);
}

TEST_F(BagCamera, TakesTheTimeOfRecordingWhereStampsStandStillOrJump) {
  {
    BagRecorder recorder(path_);
    recorder.info(0);
    const std::array<std::uint64_t, 5> stamps = {5, 5, 3600 * kSecond, 0, 100 * kMillisecond};
    for (std::size_t i = 0; i < stamps.size(); ++i)
      recorder.image(i * 100 * kMillisecond, 1, stamps[i]);
  }
  const auto camera = open_camera(name_);
  DepthFrame frame;
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(camera->read(frame, 0), Status::frame);
    EXPECT_NEAR(frame.stamp, 0.1 * i, 1e-6);
  }
}

TEST_F(BagCamera, PlacesImagesByTransformsThatComeAfterThem) {
  {
    BagRecorder recorder(path_);
    for (std::uint64_t i = 0; i < 10; ++i) {
      const std::uint64_t time = i * 100 * kMillisecond;
      recorder.image(time, 1);
      recorder.info(time);
      // What the robot was doing is recorded 60 ms late; from the eighth on 250 ms.
      const std::uint64_t late = (i < 7 ? 60 : 250) * kMillisecond;
      recorder.transform(recorder.tf, time + late, time, "odom", "base", static_cast<double>(i));
    }
    recorder.transform(recorder.still, 2 * kSecond, 0, "base", "camera", 0.5);
  }
  const auto camera = open_camera(name_ + ",frame=odom", {.loop = true});
  DepthFrame frame;
  for (int i = 0; i < 20; ++i) {
    const Status status = camera->read(frame, 0);
    if (i % 10 < 7) {
      ASSERT_EQ(status, Status::frame) << i << camera->reason();
      EXPECT_NEAR(frame.T_world_sensor->translation().x(), i % 10 + 0.5, 1e-9);
    } else {
      EXPECT_EQ(status, Status::unposed) << i;
      EXPECT_THAT(camera->reason(), HasSubstr("where base is in odom"));
    }
  }
}

TEST_F(BagCamera, LeavesOutImagesInAnotherFrameThanTheFirst) {
  {
    BagRecorder recorder(path_);
    recorder.info(0);
    recorder.image(0, 1);
    message::Image other = message::image_of(frame_at(0, 2));
    other.header = header_at(kNoon + 100 * kMillisecond);
    other.header.frame_id = "gripper";
    recorder.put(recorder.images, other, 100 * kMillisecond);
    recorder.image(200 * kMillisecond, 3);
  }
  const auto camera = open_camera(name_);
  DepthFrame frame;
  EXPECT_EQ(camera->read(frame, 0), Status::frame);
  EXPECT_EQ(camera->read(frame, 0), Status::unposed);
  EXPECT_THAT(camera->reason(),
              AllOf(HasSubstr("\"gripper\""), HasSubstr("\"camera\""), HasSubstr(",frame=FRAME")));
  EXPECT_EQ(camera->read(frame, 0), Status::frame);
  EXPECT_EQ(frame.depth.front(), 3);
}

TEST_F(BagCamera, FindsTheOneTopicOfDepthAmongOthers) {
  {
    BagRecorder recorder(path_);
    const auto colors = recorder.writer.add_topic<message::Image>("/cam/color");
    message::Image color;
    color.encoding = "rgb8";
    const auto clouds = recorder.writer.add_topic<message::PointCloud2>("/cam/points");
    PointCloud cloud;
    cloud.positions = {{1, 2, 3}, {4, 5, 6}};
    recorder.put(colors, color, 0);
    recorder.put(clouds, message::message_of(cloud), 0);
    recorder.info(0);
    recorder.image(0, 2);
  }
  DepthFrame frame;
  ASSERT_EQ(open_camera(name_)->read(frame, 0), Status::frame);
  EXPECT_EQ(frame.depth.front(), 2);
  ASSERT_EQ(open_camera(name_ + ":/cam/points")->read(frame, 0), Status::frame);
  ASSERT_TRUE(frame.cloud);
  EXPECT_EQ(frame.cloud->positions.size(), 2U);
  const auto color = open_camera(name_ + ":/cam/color");
  EXPECT_EQ(color->read(frame, 0), Status::damaged);
  EXPECT_THAT(color->reason(), HasSubstr("rgb8"));
  EXPECT_THAT(refusal(name_ + ":/cam/dept"),
              AllOf(HasSubstr("/cam/dept;"), HasSubstr("fits: /cam/image, /cam/points")));
}

TEST_F(BagCamera, AsksWhichOfSeveralTopics) {
  {
    BagRecorder recorder(path_);
    const auto second = recorder.writer.add_topic<message::Image>("/other/image");
    recorder.image(0, 2);
    recorder.put(second, message::image_of(frame_at(0)), 0);
  }
  EXPECT_THAT(refusal(name_), HasSubstr("/cam/image, /other/image"));
}

TEST_F(BagCamera, SaysWhatABagLacks) {
  EXPECT_THAT(refusal("bag:" + folder_ / "absent.mcap"), HasSubstr("absent.mcap"));
  { McapWriter writer(path_); }
  EXPECT_THAT(refusal(name_), AllOf(HasSubstr(path_), HasSubstr("neither depth images")));
  {
    McapWriter writer(path_);
    const auto lidar =
        writer.add_channel({"/livox/lidar", {"livox_ros_driver2/msg/CustomMsg", "ros2msg", ""}});
    constexpr std::array<std::uint8_t, 4> kPoints{};
    writer.write(lidar, {0, 0}, bag::View(kPoints));
  }
  EXPECT_THAT(refusal(name_),
              HasSubstr("/livox/lidar (livox_ros_driver2/msg/CustomMsg, cdr) is not"));
  {
    BagRecorder recorder(path_);
    recorder.image(0, 1);
  }
  EXPECT_THAT(refusal(name_), AllOf(HasSubstr("/cam/camera_info"), HasSubstr("no CameraInfo")));
  {
    BagRecorder recorder(path_);
    recorder.image(0, 1);
    recorder.info(0, "equidistant");
  }
  EXPECT_THAT(refusal(name_), HasSubstr("'equidistant'"));
  EXPECT_THAT(refusal(name_ + ",frame="), HasSubstr("frame=FRAME"));
}

TEST_F(BagCamera, LeavesOutWhatIsDamaged) {
  {
    BagRecorder recorder(path_);
    recorder.info(0);
    recorder.image(0, 1);
    recorder.writer.write(recorder.images, {kNoon + 1, kNoon + 1}, bag::Bytes{0, 1, 0, 0, 7});
    recorder.writer.write(recorder.infos, {kNoon + 1, kNoon + 1}, bag::Bytes{});
    recorder.image(200 * kMillisecond, 2);
  }
  const auto camera = open_camera(name_);
  DepthFrame frame;
  EXPECT_EQ(camera->read(frame, 0), Status::frame);
  EXPECT_EQ(camera->read(frame, 0), Status::damaged);
  EXPECT_THAT(camera->reason(), HasSubstr("damaged"));
  EXPECT_EQ(camera->read(frame, 0), Status::frame);
  EXPECT_NEAR(frame.stamp, 0.2, 1e-6);
  EXPECT_EQ(camera->read(frame, 0), Status::ended);
}

TEST_F(BagCamera, PlaysWhatIsThereOfAFileThatWasCut) {
  {
    BagRecorder recorder(path_);
    recorder.info(0);
    for (std::uint64_t i = 0; i < 20; ++i) {
      recorder.image(i * 100 * kMillisecond, 1);
      if (i % 5 == 4) recorder.writer.advance(kNoon + (i + 20) * 100 * kMillisecond);
    }
  }
  std::filesystem::resize_file(path_, bag::McapReader(path_).contents().chunks.at(2).offset + 100);
  const auto camera = open_camera(name_);
  DepthFrame frame;
  int frames = 0;
  int damaged = 0;
  for (Status status = camera->read(frame, 0); status != Status::ended;
       status = camera->read(frame, 0)) {
    frames += status == Status::frame ? 1 : 0;
    if (status != Status::damaged) continue;
    ++damaged;
    EXPECT_THAT(camera->reason(), HasSubstr(path_));
  }
  EXPECT_EQ(frames, 10);
  EXPECT_GE(damaged, 1);
}

TEST_F(BagCamera, TakesFoldersAndOddNames) {
  record(1);
  DepthFrame frame;
  EXPECT_EQ(open_camera("bag:" + folder_.path().string())->read(frame, 0), Status::frame);
  const std::string odd = folder_ / "a:b,frame=c.mcap";
  std::filesystem::copy_file(path_, odd);
  EXPECT_EQ(open_camera("bag:" + odd)->read(frame, 0), Status::frame);
  EXPECT_EQ(open_camera("bag:" + odd + ":/cam/image")->read(frame, 0), Status::frame);
  EXPECT_THAT(refusal("bag:" + folder_.path().string()), HasSubstr("several MCAP files"));
  EXPECT_TRUE(open_camera(name_, {.loop = true})->info().repeats);
  EXPECT_FALSE(open_camera(name_)->info().repeats);
}

}  // namespace
}  // namespace palpate::sensor
