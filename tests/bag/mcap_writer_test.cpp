// When a bag is closed, what its chunks are, and what becomes of it on a full disk.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "bag/bags.hpp"
#include "support/folder.hpp"

namespace palpate::bag {
namespace {

TEST(McapWriter, FileIsClosedAfterEveryChunkWhileItIsWritten) {
  const test::Folder folder;
  const std::string path = folder / "run.mcap";
  McapWriter writer(path);
  EXPECT_TRUE(McapReader(path).contents().closed);
  const auto topic = writer.add_topic<message::PoseStamped>("/hand/pose");
  for (int chunk = 0; chunk < 5; ++chunk) {
    const std::uint64_t begin = kNoon + static_cast<std::uint64_t>(chunk) * kSecond;
    for (int i = 0; i < 100; ++i) writer.write(topic, {begin, begin}, pose(i));
    EXPECT_EQ(all_of(path).size(), 100u * static_cast<std::size_t>(chunk)) << "not written yet";
    writer.advance(begin + kSecond);
    McapReader reader(path);
    EXPECT_TRUE(reader.contents().closed);
    EXPECT_TRUE(reader.contents().losses.empty());
    EXPECT_EQ(reader.contents().chunks.size(), chunk + 1u);
    EXPECT_EQ(all_of(reader).size(), 100u * (static_cast<std::size_t>(chunk) + 1));
  }
}

TEST(McapWriter, ChunkEndsAtItsSizeOrAfterItsTime) {
  const test::Folder folder;
  McapWriter writer(folder / "run.mcap", {.chunk_size = 10'000});
  const auto topic = writer.add_channel({.topic = "/raw"});
  const Bytes data(4000);
  for (std::uint64_t i = 0; i < 9; ++i) writer.write(topic, {kNoon + i, 0}, data);
  EXPECT_EQ(McapReader(folder / "run.mcap").contents().chunks.size(), 3u);
  writer.write(topic, {kNoon + 10, 0}, data);
  writer.advance(kNoon);  // a time that jumps back is none that has passed
  writer.advance(kNoon + kSecond);
  EXPECT_EQ(McapReader(folder / "run.mcap").contents().chunks.size(), 3u);
  writer.advance(kNoon + 10 + kSecond);
  EXPECT_EQ(McapReader(folder / "run.mcap").contents().chunks.size(), 4u);
}

TEST(McapWriter, QosIsWrittenAsRosbag2DoesIt) {
  EXPECT_EQ(offered_qos({.reliable = false, .depth = 2}),
            "- history: 1\n  depth: 2\n  reliability: 2\n  durability: 2\n"
            "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
            "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  liveliness: 1\n"
            "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
            "  avoid_ros_namespace_conventions: false\n");
  EXPECT_NE(offered_qos({.stays = true}).find("durability: 1"), std::string::npos);
}

TEST(McapWriter, RefusesUnknownChannelsFoldersThatAreNotThereAndWorkAfterItsEnd) {
  const test::Folder folder;
  EXPECT_THROW(McapWriter(folder / "no/such/run.mcap"), Error);
  McapWriter writer(folder / "run.mcap");
  EXPECT_THROW(writer.write(1, {}, View{}), Error);
  EXPECT_THROW(writer.write(0, {}, View{}), Error);
  writer.close();
  writer.close();
  EXPECT_THROW(writer.advance(kNoon), Error);
}

// Files grow to a limit as they do on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  sighandler_t handler_;
};

TEST(McapWriter, ASecondWriterOfAFileIsRefusedAndTheFirstGoesOn) {
  const test::Folder folder;
  McapWriter writer(folder / "run.mcap");
  write_poses(writer, 1, 10);
  EXPECT_THROW(McapWriter(folder / "run.mcap"), Error);
  writer.close();
  EXPECT_EQ(McapReader(folder / "run.mcap").contents().messages, 10u);
  EXPECT_NO_THROW(McapWriter(folder / "run.mcap")) << "it is free again";
}

TEST(McapWriter, FullDiskIsToldAndTheFileHoldsWhatWasWrittenBefore) {
  const test::Folder folder;
  const std::string path = folder / "run.mcap";
  for (const rlim_t room : {5'000u, 20'000u, 20'400u, 33'333u}) {
    McapWriter writer(path, {.chunk_size = 2000, .compressed = false});
    const FullDisk disk(room);
    try {
      write_poses(writer, 1000, 100);
      ADD_FAILURE() << "there was room";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("can be read"), std::string::npos) << error.what();
    }
    EXPECT_THROW(writer.advance(2 * kNoon), Error) << "it takes no more";
    McapReader reader(path);
    EXPECT_TRUE(reader.contents().closed);
    EXPECT_TRUE(reader.contents().losses.empty());
    const std::vector<Read> read = all_of(reader);
    EXPECT_EQ(read.size(), reader.contents().messages);
    EXPECT_GT(read.size(), 5u) << room;
    EXPECT_LT(std::filesystem::file_size(path), room + 1);
  }
}

TEST(McapWriter, LongRecordingIsClosedAtEverySyncOnlyAndLosesNothing) {
  const test::Folder folder;
  const std::string path = folder / "run.mcap";
  McapWriter writer(path, {.chunk_size = 1, .sync_time = 1000});
  const auto topic = writer.add_channel({.topic = "/raw"});
  std::uint64_t open = 0;
  for (std::uint64_t i = 0; i < 6000; ++i) {
    writer.write(topic, {kNoon + i, 0}, view_of("x"));
    if (i % 400 == 399) {
      McapReader reader(path);
      open += reader.contents().closed ? 0 : 1;
      EXPECT_EQ(all_of(reader).size(), i + 1);
    }
  }
  EXPECT_GT(open, 2u);
  writer.close();
  EXPECT_TRUE(McapReader(path).contents().closed);
  EXPECT_LT(std::filesystem::file_size(path), 2'000'000u);
}

}  // namespace
}  // namespace palpate::bag
