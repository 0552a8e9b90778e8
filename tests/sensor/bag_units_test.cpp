// Bags whose depths are not what their type says, without points, or grey pictures.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "bag/bags.hpp"
#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sensor/fake_camera.hpp"
#include "sensor/stream_statistics.hpp"
#include "support/folder.hpp"

namespace palpate::sensor {
namespace {

using bag::kNoon;
using bag::kSecond;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Status = DepthCamera::Status;

message::Image grey(std::uint16_t value, const std::string& encoding) {
  message::Image image = message::image_of(frame_at(0));
  image.encoding = encoding;
  image.step = 2 * image.width;
  image.data.resize(std::size_t{2} * image.width * image.height);
  for (std::size_t i = 0; i < image.data.size(); i += 2) {
    std::memcpy(image.data.data() + i, &value, sizeof(value));
  }
  return image;
}

message::PointCloud2 cloud(std::vector<Eigen::Vector3f> points) {
  PointCloud cloud;
  cloud.positions = std::move(points);
  return message::message_of(cloud);
}

class BagUnits : public testing::Test {
 protected:
  // One message a tenth of a second, with a camera beside them.
  template <class T>
  void record(const std::vector<T>& messages, const std::string& topic = "/cam/image") {
    bag::McapWriter writer(path_);
    const auto infos = writer.add_topic<message::CameraInfo>("/cam/camera_info");
    writer.write(infos, {kNoon, kNoon}, message::info_of(frame_at(0).camera));
    const auto images = writer.add_topic<T>(topic);
    std::uint64_t time = kNoon;
    for (T message : messages) {
      message.header.stamp.sec = static_cast<std::int32_t>(time / kSecond);
      message.header.stamp.nanosec = static_cast<std::uint32_t>(time % kSecond);
      writer.write(images, {time, time}, message);
      time += kSecond / 10;
    }
  }

  [[nodiscard]] DepthFrame first(const std::string& options = "") const {
    DepthFrame frame;
    const auto camera = open_camera("bag:" + path_ + options);
    EXPECT_EQ(camera->read(frame, 0), Status::frame) << camera->reason();
    return frame;
  }

  [[nodiscard]] std::string refusal(const std::string& options = "") const {
    try {
      (void)open_camera("bag:" + path_ + options);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  test::Folder folder_;
  std::string path_ = folder_ / "run.mcap";
};

TEST_F(BagUnits, DepthsAreInTheUnitThatIsGiven) {
  record<message::Image>({grey(5000, "16UC1")});
  EXPECT_FLOAT_EQ(first().depth.front(), 5);
  EXPECT_FLOAT_EQ(first(",unit=0.0001").depth.front(), 0.5F);
  EXPECT_FLOAT_EQ(first(":/cam/image,unit=0.0001").depth.front(), 0.5F);
  std::mt19937 random(11);
  for (int i = 0; i < 10; ++i) {  // any unit in either form and order
    const double unit = std::pow(10, -6.0 * static_cast<double>(random()) / 4294967296.0);
    const std::string options = fmt::format(",unit={}", unit);
    EXPECT_FLOAT_EQ(first(options).depth.front(), static_cast<float>(5000 * unit)) << options;
  }
}

TEST_F(BagUnits, DepthsInMillimetresAsFloatAreMetresWhereThatIsSaid) {
  record<message::Image>({message::image_of(frame_at(0, 750))});
  EXPECT_FLOAT_EQ(first().depth.front(), 750);
  EXPECT_FLOAT_EQ(first(",unit=1e-3").depth.front(), 0.75F);
}

TEST_F(BagUnits, CloudsInMillimetresAreMetresWhereThatIsSaid) {
  record<message::PointCloud2>({cloud({{100, 200, 300}, {400, 500, 600}})}, "/cam/points");
  const PointCloud read = *first(":/cam/points,unit=0.001").cloud;
  EXPECT_LT((read.point(1) - Eigen::Vector3d(0.4, 0.5, 0.6)).norm(), 1e-6);
}

TEST_F(BagUnits, UnitThatIsNoneIsRefusedWithOneThatWorks) {
  record<message::Image>({grey(5000, "16UC1")});
  for (const char* none : {"0", "-1", "mm", "1e-12", "1000", "nan", ""}) {
    EXPECT_THAT(refusal(std::string(",unit=") + none),
                AllOf(HasSubstr("unit=" + std::string(none)), HasSubstr(",unit=METRES"),
                      HasSubstr("0.001 for millimetres")));
  }
  EXPECT_THAT(refusal(":/cam/image,units=0.1"),
              AllOf(HasSubstr("'units=0.1' is not an option"),
                    HasSubstr(path_ + ":/cam/image,unit=METRES")));
  EXPECT_THAT(refusal(",unit=0.001,frame="), HasSubstr("'frame=' is not an option"));
}

TEST_F(BagUnits, CloudWithoutPointsAmongOthersIsEmptyAndNotGarbage) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  record<message::PointCloud2>({cloud({{1, 2, 3}}), cloud({}), message::PointCloud2{},
                                cloud({{nan, nan, nan}}), cloud({{1, 2, 4}})},
                               "/cam/points");
  const auto camera = open_camera("bag:" + path_);
  FrameCheck check(false);
  DepthFrame frame;
  std::vector<std::uint64_t StreamState::Drops::*> causes;
  while (true) {
    const Status status = camera->read(frame, 0);
    if (status == Status::ended) break;
    ASSERT_EQ(status, Status::frame) << camera->reason();
    const auto objection = check.examine(frame, std::numeric_limits<double>::infinity());
    causes.push_back(objection ? objection->cause : nullptr);
  }
  const auto empty = &StreamState::Drops::empty;
  EXPECT_EQ(causes, (decltype(causes){nullptr, empty, empty, empty, nullptr}));
}

TEST_F(BagUnits, GreyPicturesThatMayBeDepthAreListedAndNotTakenUnasked) {
  record<message::Image>({grey(1500, "mono16")}, "/cam/ir");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("/cam/ir (grey of 16 bits"), Not(HasSubstr("neither"))));
  EXPECT_FLOAT_EQ(first(":/cam/ir").depth.front(), 1.5F);
}

TEST_F(BagUnits, DepthIsTakenBesideGreyPictures) {
  bag::McapWriter writer(path_);
  const auto infos = writer.add_topic<message::CameraInfo>("/cam/camera_info");
  writer.write(infos, {kNoon, kNoon}, message::info_of(frame_at(0).camera));
  const auto infrared = writer.add_topic<message::Image>("/cam/ir");
  const auto depth = writer.add_topic<message::Image>("/cam/depth");
  const auto colors = writer.add_topic<message::Image>("/cam/grey8");
  writer.write(infrared, {kNoon, kNoon}, grey(1500, "mono16"));
  writer.write(depth, {kNoon, kNoon}, grey(1000, "16UC1"));
  writer.write(colors, {kNoon, kNoon}, grey(1000, "mono8"));
  writer.close();
  EXPECT_FLOAT_EQ(first().depth.front(), 1);
  EXPECT_THAT(refusal(":/cam/none"),
              AllOf(HasSubstr("fits: /cam/depth, /cam/ir (grey"), Not(HasSubstr("grey8"))));
}

TEST_F(BagUnits, RecordingOfAnotherKindIsNamedWithWhatMakesItOne) {
  const std::vector<std::array<std::string, 3>> kinds = {
      {"a.db3", std::string("SQLite format 3\0", 16) + "rest", "mcap convert"},
      {"a.bag", "#ROSBAG V2.0\n", "rosbags-convert --src"},
      {"b.mcap", "version https://git-lfs.github.com/spec/v1\noid sha256:12\n", "git lfs pull"},
      {"c.mcap.zstd", "\x28\xb5\x2f\xfd rest", "zstd -d"}};
  for (const auto& [file, head, remedy] : kinds) {
    const test::Folder folder;
    folder.write(file, head);
    path_ = folder / file;
    EXPECT_THAT(refusal(), AllOf(HasSubstr(path_ + ": is "), HasSubstr(remedy))) << file;
    path_ = folder.path().string();  // as ROS 2 records
    EXPECT_THAT(refusal(), AllOf(HasSubstr(folder / file), HasSubstr(remedy))) << file;
  }
}

}  // namespace
}  // namespace palpate::sensor
