// What is written is read again, whole, in order, by topic and from a time on.
#include <gtest/gtest.h>

#include "bag/bags.hpp"
#include "support/folder.hpp"

namespace palpate::bag {
namespace {

TEST(Mcap, MessagesOfSeveralTopicsComeBackAsTheyWere) {
  const test::Folder folder;
  const std::string path = folder / "run.mcap";
  {
    McapWriter writer(path);
    const auto poses = writer.add_topic<message::PoseStamped>("/hand/pose");
    const auto joys = writer.add_topic<message::Joy>("/hand/joy");
    for (int i = 0; i < 3000; ++i) {
      const std::uint64_t time = kNoon + static_cast<std::uint64_t>(i) * 1'000'000;
      writer.write(poses, {time, time + 5}, pose(i));
      message::Joy joy;
      joy.buttons = {i};
      if (i % 10 == 0) writer.write(joys, {time, time}, joy);
    }
    writer.close();
  }
  McapReader reader(path);
  const Contents& contents = reader.contents();
  EXPECT_TRUE(contents.closed);
  EXPECT_EQ(contents.profile, "ros2");
  EXPECT_EQ(contents.messages, 3300u);
  EXPECT_EQ(contents.chunks.size(), 3u);  // of a second each
  EXPECT_EQ(contents.start, kNoon);
  EXPECT_EQ(contents.end, kNoon + 2'999'000'000);
  ASSERT_EQ(contents.channels.size(), 2u);
  const Channel& channel = contents.channels.at(1);
  EXPECT_EQ(channel.schema.name, "geometry_msgs/msg/PoseStamped");
  EXPECT_EQ(channel.schema.text, message::schema_of<message::PoseStamped>());
  EXPECT_EQ(channel.count, 3000u);
  EXPECT_EQ(channel.metadata.at("topic_type_hash"),
            std::string("RIHS01_") + message::PoseStamped::kHash);
  int next_pose = 0;
  int next_joy = 0;
  for (Message message; reader.next(message);) {
    if (reader.channel_of(message).topic == "/hand/pose") {
      message::PoseStamped read;
      message::decode(message.data, read);
      EXPECT_EQ(read.header.stamp.sec, next_pose);
      EXPECT_EQ(message.sequence, static_cast<std::uint32_t>(next_pose++));
      EXPECT_EQ(message.stamp.publish, message.stamp.log + 5);
    } else {
      message::Joy read;
      message::decode(message.data, read);
      EXPECT_EQ(read.buttons[0], next_joy);
      next_joy += 10;
    }
  }
  EXPECT_EQ(next_pose, 3000);
  EXPECT_EQ(next_joy, 3000);
  EXPECT_TRUE(contents.losses.empty());
}

TEST(Mcap, ReaderGivesTheTopicsThatAreWantedFromATimeOn) {
  const test::Folder folder;
  McapWriter writer(folder / "run.mcap", {.chunk_time = kSecond / 10});
  const auto a = writer.add_topic<message::Float64>("/a");
  const auto b = writer.add_topic<message::Float64>("/b");
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t time = kNoon + static_cast<std::uint64_t>(i) * kSecond / 100;
    writer.write(i % 2 == 0 ? a : b, {time, time}, message::Float64{1.0 * i});
  }
  writer.close();
  McapReader reader(folder / "run.mcap");
  reader.choose([](const Channel& channel) { return channel.topic == "/b"; }, kNoon + kSecond / 2);
  const std::vector<Read> read = all_of(reader);
  ASSERT_EQ(read.size(), 25u);
  EXPECT_EQ(read.front().time, kNoon + 51 * kSecond / 100);
  for (const Read& each : read) EXPECT_EQ(each.topic, "/b");
  reader.choose([](const Channel&) { return true; });
  EXPECT_EQ(all_of(reader).size(), 100u);
}

TEST(Mcap, MessagesThatWereWrittenOutOfOrderComeInTheOrderOfTheirTimes) {
  const test::Folder folder;
  McapWriter writer(folder / "run.mcap", {.chunk_size = 300});  // a few messages
  const auto topic = writer.add_topic<message::Float64>("/a");
  for (std::uint64_t i = 0; i < 200; ++i) {
    const std::uint64_t time = kNoon + (i * 37 % 200) * 1000;
    writer.write(topic, {time, time}, message::Float64{1.0});
  }
  writer.close();
  const std::vector<Read> read = all_of(folder / "run.mcap");
  ASSERT_EQ(read.size(), 200u);
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i].time, kNoon + i * 1000);
}

// The second chunk begins earlier than the first and goes on at the first one's last time.
TEST(Mcap, MessagesOfOneTimeComeAsTheyLieInTheFile) {
  const test::Folder folder;
  McapWriter writer(folder / "run.mcap");
  const auto topic = writer.add_topic<message::Float64>("/a");
  for (const auto& [time, value] : {std::pair(5, 1.0), std::pair(1, 0.0), std::pair(5, 2.0)}) {
    const std::uint64_t stamp = kNoon + static_cast<std::uint64_t>(time);
    writer.write(topic, {stamp, stamp}, message::Float64{value});
    if (value == 1) writer.advance(kNoon + 2 * kSecond);
  }
  writer.close();
  const std::vector<Read> read = all_of(folder / "run.mcap");
  ASSERT_EQ(read.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    message::Float64 value;
    message::decode(read[i].data, value);
    EXPECT_EQ(value.data, static_cast<double>(i));
  }
}

TEST(Mcap, AttachmentsAndMetadataComeBackAsTheyWere) {
  const test::Folder folder;
  McapWriter writer(folder / "run.mcap");
  write_poses(writer, 1, 10);
  Attachment setup{"setup.toml", "application/toml", kNoon, kNoon - 5, {}};
  for (int i = 0; i < 100'000; ++i) setup.data.push_back(static_cast<std::uint8_t>(i));
  writer.attach(setup);
  writer.add(Metadata{"palpate", {{"version", "1"}, {"host", ""}}});
  const auto topic = writer.add_topic<message::Float64>("/later");
  writer.write(topic, {kNoon, kNoon}, message::Float64{1});
  writer.close();
  const McapReader reader(folder / "run.mcap");
  ASSERT_EQ(reader.contents().attachments.size(), 1u);
  const Attachment read = reader.attachment(0);
  EXPECT_EQ(read.name, "setup.toml");
  EXPECT_EQ(read.media_type, "application/toml");
  EXPECT_EQ(read.create_time, kNoon - 5);
  EXPECT_EQ(read.data, setup.data);
  ASSERT_EQ(reader.contents().metadata.size(), 1u);
  EXPECT_EQ(reader.contents().metadata[0].words.at("version"), "1");
  EXPECT_EQ(reader.contents().messages, 11u);
}

TEST(Mcap, ImageOfNothingAndAMessageLargerThanAChunkComeBack) {
  const test::Folder folder;
  message::Image image;
  image.data.assign(40 << 20, 0);  // packs better than 1000 to 1
  McapWriter writer(folder / "run.mcap");
  const auto topic = writer.add_topic<message::Image>("/image");
  writer.write(topic, {kNoon, kNoon}, image);
  writer.write(topic, {kNoon + 1, kNoon}, message::Image{});
  writer.close();
  const std::vector<Read> read = all_of(folder / "run.mcap");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_GT(read[0].data.size(), image.data.size());
}

TEST(Mcap, MessagesWithoutCompressionAndWithoutSchemaComeBack) {
  const test::Folder folder;
  McapWriter writer(folder / "run.mcap", {.compressed = false, .profile = ""});
  const auto topic = writer.add_channel({.topic = "/json", .message_encoding = "json"});
  writer.write(topic, {1, 2}, view_of("{}"));
  writer.close();
  McapReader reader(folder / "run.mcap");
  EXPECT_EQ(reader.contents().profile, "");
  EXPECT_EQ(reader.contents().channels.at(topic).message_encoding, "json");
  EXPECT_EQ(reader.contents().channels.at(topic).schema, Schema{});
  ASSERT_EQ(all_of(reader).size(), 1u);
}

TEST(Mcap, FileOfNothingIsAFile) {
  const test::Folder folder;
  McapWriter(folder / "run.mcap").close();
  McapReader reader(folder / "run.mcap");
  EXPECT_TRUE(reader.contents().closed);
  EXPECT_TRUE(reader.contents().losses.empty());
  EXPECT_TRUE(all_of(reader).empty());
}

TEST(Mcap, WhatIsNoBagIsRefusedWithWords) {
  const test::Folder folder;
  folder.write("cloud.ply", "ply\nformat ascii 1.0\n");
  folder.write("empty.mcap", "");
  for (const char* name : {"cloud.ply", "empty.mcap", "absent.mcap", "."}) {
    try {
      const McapReader reader(folder / name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(folder / name), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace palpate::bag
