// Recordings of several MCAP files, as 'ros2 bag record --max-bag-duration' makes them.
#include "sensor/split_bag.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "bag/bags.hpp"
#include "message/point_clouds.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "support/folder.hpp"

namespace palpate::sensor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Status = DepthCamera::Status;

constexpr std::uint64_t kInterval = bag::kSecond / 10;

class SplitBagTest : public testing::Test {
 protected:
  // Two clouds, `first` and `first` + 1 m away, a tenth of a second apart.
  void record(const std::string& name, int first) const {
    bag::McapWriter writer(folder_ / name);
    const std::uint16_t topic = writer.add_topic<message::PointCloud2>("/points");
    for (int i = first; i < first + 2; ++i) {
      PointCloud cloud;
      cloud.positions = {{0, 0, static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0}};
      message::PointCloud2 told = message::message_of(cloud);
      const std::uint64_t time = bag::kNoon + static_cast<std::uint64_t>(i) * kInterval;
      told.header.stamp = {static_cast<std::int32_t>(time / bag::kSecond),
                           static_cast<std::uint32_t>(time % bag::kSecond)};
      writer.write(topic, {time, time}, told);
    }
  }

  void list(const std::string& files) const {
    folder_.write("metadata.yaml",
                  "rosbag2_bagfile_information:\n  storage_identifier: mcap\n"
                  "  relative_file_paths:\n" +
                      files + "  duration:\n    nanoseconds: 3\n");
  }

  // How far away the clouds of the recording are, in their order; stamps are told in tenths of s.
  std::vector<int> played(std::vector<int>& stamps, int laps = 1) const {
    const auto camera = open_camera("bag:" + folder_.path().string(), {.loop = laps > 1});
    std::vector<int> found;
    DepthFrame frame;
    while (camera->read(frame, 0) == Status::frame && found.size() < std::size_t(4 * laps)) {
      found.push_back(static_cast<int>(frame.cloud->point(0).z()));
      stamps.push_back(static_cast<int>(std::lround(10 * frame.stamp)));
    }
    return found;
  }

  test::Folder folder_;
};

TEST_F(SplitBagTest, PlaysWhatMetadataListsInThatOrder) {
  record("run_0.mcap", 1);
  record("run_1.mcap", 3);
  record("other.mcap", 7);
  for (const char* files : {"    - run_0.mcap\n    - run_1.mcap\n",
                            "  - \"run/run_0.mcap\"\r\n  - 'run/run_1.mcap'\r\n"}) {
    list(files);
    std::vector<int> stamps;
    EXPECT_THAT(played(stamps), ElementsAre(1, 2, 3, 4)) << files;
    EXPECT_THAT(stamps, ElementsAre(0, 1, 2, 3));
  }
  std::vector<int> stamps;
  EXPECT_THAT(played(stamps, 2), ElementsAre(1, 2, 3, 4, 1, 2, 3, 4));
}

TEST_F(SplitBagTest, NamesAPartThatIsMissing) {
  record("run_0.mcap", 1);
  list("    - run_0.mcap\n    - run_1.mcap\n");
  try {
    (void)open_camera("bag:" + folder_.path().string());
    FAIL() << "it was opened";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("run_1.mcap"));
  }
}

TEST_F(SplitBagTest, TellsWhatWasLostWithTheNameOfThePart) {
  record("run_0.mcap", 1);
  record("run_1.mcap", 3);
  std::filesystem::resize_file(folder_ / "run_1.mcap",
                               std::filesystem::file_size(folder_ / "run_1.mcap") - 30);
  SplitBag bag({folder_ / "run_0.mcap", folder_ / "run_1.mcap"});
  bag::Message message;
  while (bag.next(message)) EXPECT_EQ(bag.channel_of(message).topic, "/points");
  const auto loss = bag.next_loss();
  ASSERT_TRUE(loss);
  EXPECT_THAT(*loss, HasSubstr("run_1.mcap: "));
}

}  // namespace
}  // namespace palpate::sensor
