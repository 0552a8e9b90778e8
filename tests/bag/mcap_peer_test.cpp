// Others read what we write, and we read what others write: the readers and the writer of
// @mcap/core (npm), with the decoder of @foxglove/rosmsg2-serialization and the definitions in the
// file.
#include "bag/mcap_peer.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "bag/bags.hpp"
#include "bag/mcap_check.hpp"
#include "message/display_types.hpp"

namespace palpate::bag {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

TEST_F(McapPeer, ReadsTheFileAfterEveryChunk) {
  const std::string path = folder_ / "run.mcap";
  std::string files;
  {
    McapWriter writer(path);
    const auto poses = writer.add_topic<message::PoseStamped>("/hand/pose");
    const auto joys = writer.add_topic<message::Joy>("/hand/joy");
    for (int chunk = 0; chunk <= 5; ++chunk) {
      const std::string copy = folder_ / fmt::format("{}.mcap", chunk);
      fs::copy_file(path, copy);
      files += " " + copy;
      for (int i = 0; i < 200; ++i) {
        const std::uint64_t time = kNoon + static_cast<std::uint64_t>(200 * chunk + i);
        writer.write(poses, {time, time}, pose(200 * chunk + i));
        if (chunk > 2) writer.write(joys, {time, time}, message::Joy{});
      }
      writer.advance(kNoon + 2 * static_cast<std::uint64_t>(chunk + 1) * kSecond);
      if (chunk == 3) writer.attach({"setup.toml", "", kNoon, kNoon, Bytes(1000, 'a')});
      if (chunk == 4) writer.add(Metadata{"palpate", {{"a", "b"}}});
    }
  }
  const json found = json::parse(run("read.mjs", files + " " + path));
  ASSERT_EQ(found.size(), 7u);
  for (int chunk = 0; chunk < 7; ++chunk) {
    const json& indexed = found[static_cast<std::size_t>(chunk)]["indexed"];
    const json& streamed = found[static_cast<std::size_t>(chunk)]["streamed"];
    json expected = json::object();
    if (chunk > 0) expected["/hand/pose"] = 200 * chunk;
    if (chunk > 3) expected["/hand/joy"] = 200 * (chunk - 3);
    EXPECT_EQ(indexed["counts"], expected) << chunk;
    EXPECT_EQ(streamed["counts"], expected) << chunk;
    EXPECT_TRUE(streamed["done"]) << chunk;
    EXPECT_EQ(indexed["statistics"], 200 * chunk + 200 * std::max(0, chunk - 3));
    EXPECT_EQ(indexed["profile"], "ros2");
    EXPECT_EQ(indexed["attachments"].size(), chunk > 3 ? 1u : 0u);
    EXPECT_EQ(indexed["metadata"].size(), chunk > 4 ? 1u : 0u);
    if (chunk > 0) {
      const json& last = indexed["last"]["/hand/pose"];
      EXPECT_EQ(last["header"]["stamp"]["sec"], 200 * chunk - 1);
      EXPECT_EQ(last["header"]["frame_id"], "world");
      EXPECT_EQ(last["pose"]["position"]["x"], 0.001 * (200 * chunk - 1));
    }
  }
}

template <class T>
void write_one(McapWriter& writer, T message) {
  const std::uint16_t topic = writer.add_topic<T>(std::string("/") + T::kName);
  writer.write(topic, {kNoon, kNoon}, message);
}

TEST_F(McapPeer, DecodesAMessageOfEveryTypeByItsSchema) {
  {
    McapWriter writer(folder_ / "types.mcap");
    message::Marker marker;
    marker.ns = "hand";
    marker.points.resize(2);
    message::CameraInfo camera;
    camera.k[4] = 525;
    camera.d = {1, 2, 3};
    message::DiagnosticArray diagnostics;
    diagnostics.status.push_back({std::byte{2}, "guard", "off", "", {{"key", "value"}}});
    message::PointCloud2 cloud;
    cloud.fields.push_back({"x", 4, 7, 1});
    cloud.data = {1, 2, 3};
    message::TFMessage transforms;
    transforms.transforms.resize(2);
    transforms.transforms[1].child_frame_id = "hand";
    message::JointState joints;
    joints.name = {"a", "bc"};
    joints.effort = {1.5};
    write_one(writer, message::MarkerArray{{marker, marker}});
    write_one(writer, camera);
    write_one(writer, diagnostics);
    write_one(writer, cloud);
    write_one(writer, transforms);
    write_one(writer, joints);
    write_one(writer, message::Image{});
    write_one(writer, message::CompressedImage{});
    write_one(writer, message::WrenchStamped{});
    write_one(writer, message::TwistStamped{});
    write_one(writer, message::Float64MultiArray{{{{"a", 2, 3}}, 1}, {0.5}});
    write_one(writer, message::Bool{true});
    write_one(writer, message::Int32{-7});
    writer.close();
  }
  const json last = json::parse(run("read.mjs", folder_ / "types.mcap"))[0]["indexed"]["last"];
  EXPECT_EQ(last.size(), 13u);
  EXPECT_EQ(last["/visualization_msgs/MarkerArray"]["markers"][1]["ns"], "hand");
  EXPECT_EQ(last["/visualization_msgs/MarkerArray"]["markers"][1]["color"]["a"], 1);
  EXPECT_EQ(last["/sensor_msgs/CameraInfo"]["k"][4], 525);
  EXPECT_EQ(last["/sensor_msgs/CameraInfo"]["d"], json({1, 2, 3}));
  EXPECT_EQ(last["/diagnostic_msgs/DiagnosticArray"]["status"][0]["values"][0]["value"], "value");
  EXPECT_EQ(last["/sensor_msgs/PointCloud2"]["fields"][0]["offset"], 4);
  EXPECT_EQ(last["/sensor_msgs/PointCloud2"]["data"], json({1, 2, 3}));
  EXPECT_EQ(last["/tf2_msgs/TFMessage"]["transforms"][1]["child_frame_id"], "hand");
  EXPECT_EQ(last["/sensor_msgs/JointState"]["name"], json({"a", "bc"}));
  EXPECT_EQ(last["/std_msgs/Float64MultiArray"]["layout"]["dim"][0]["stride"], 3);
  EXPECT_EQ(last["/std_msgs/Int32"]["data"], -7);
}

TEST_F(McapPeer, WritesBagsThatAreRead) {
  for (const std::string kind : {"none", "lz4", "zstd", "loose"}) {
    const std::string path = folder_ / (kind + ".mcap");
    (void)run("write.mjs", path + " " + kind);
    McapReader reader(path);
    const Contents& contents = reader.contents();
    EXPECT_TRUE(contents.closed) << kind;
    EXPECT_EQ(contents.library, "@mcap/core") << kind;
    EXPECT_EQ(contents.messages, 2000u) << kind;
    EXPECT_EQ(contents.end, 999 * kSecond / 100) << kind;
    ASSERT_EQ(contents.attachments.size(), 1u) << kind;
    EXPECT_EQ(reader.attachment(0).data, (Bytes{1, 2, 3})) << kind;
    ASSERT_EQ(contents.metadata.size(), 1u) << kind;
    EXPECT_EQ(contents.metadata[0].words.at("by"), "others") << kind;
    reader.choose([](const Channel& channel) { return channel.topic == "/b"; });
    int next = 0;
    for (Message message; reader.next(message); ++next) {
      message::Point point;
      message::decode(message.data, point);
      EXPECT_EQ(point.x, next) << kind;
      EXPECT_EQ(point.y, 1) << kind;
    }
    EXPECT_EQ(next, 1000) << kind;
    Contents checked = contents;
    check(RandomFile(path), checked);
    // Without chunks @mcap/core writes attachments later than where it says.
    std::erase(checked.losses,
               "the summary's index of the attachment at byte 39 is not what is there");
    EXPECT_TRUE(checked.losses.empty()) << kind << ": " << checked.losses[0];
  }
}

}  // namespace
}  // namespace palpate::bag
