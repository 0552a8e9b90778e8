// What palpate advises about recordings works: each remedy is applied to the input that earned it,
// and that is read right.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "bag/bags.hpp"
#include "message/depth_images.hpp"
#include "support/contains.hpp"

namespace palpate::bag {
namespace {

using app::Outcome;
using app::Shell;
using nlohmann::json;
using test::contains;

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr double kPlane = 0.5;  // m from the camera

DepthFrame plane() {
  DepthFrame frame;
  frame.camera = {
      .width = kWidth, .height = kHeight, .pinhole = {60, 60, 32, 24}, .distortion = {}};
  frame.depth.assign(std::size_t{kWidth} * kHeight, static_cast<float>(kPlane));
  return frame;
}

// The plane in steps of `unit` m, big or little end first, without padding.
Bytes samples(double unit, bool big) {
  const auto value = static_cast<std::uint16_t>(kPlane / unit + 0.5);
  const std::uint8_t low = value & 255U;
  const std::uint8_t high = value >> 8U;
  Bytes bytes;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    bytes.push_back(big ? high : low);
    bytes.push_back(big ? low : high);
  }
  return bytes;
}

message::Image grey(double unit, const std::string& encoding) {
  message::Image image = message::image_of(plane());
  image.encoding = encoding;
  image.step = 2 * kWidth;
  const Bytes bytes = samples(unit, false);
  image.data.assign(bytes.begin(), bytes.end());
  return image;
}

void append_part(Bytes& out, const char* kind, const Bytes& content) {
  const auto big = [&](std::uint32_t number) {
    for (const int shift : {24, 16, 8, 0}) out.push_back((number >> shift) & 255U);
  };
  big(static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = out.size();
  out.insert(out.end(), kind, kind + 4);
  out.insert(out.end(), content.begin(), content.end());
  big(crc_of(View(out).subspan(begin)));
}

// The plane as a grey PNG of 16 bits in mm.
message::CompressedImage png() {
  const Bytes whole = samples(1e-3, true);
  Bytes rows;
  for (std::size_t v = 0; v < kHeight; ++v) {
    rows.push_back(0);  // no filter
    const auto row = whole.begin() + static_cast<std::ptrdiff_t>(v) * 2 * kWidth;
    rows.insert(rows.end(), row, row + 2 * kWidth);
  }
  uLongf size = compressBound(rows.size());
  Bytes packed(size);
  EXPECT_EQ(compress(packed.data(), &size, rows.data(), rows.size()), Z_OK);
  packed.resize(size);
  Bytes bytes{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_part(bytes, "IHDR", {0, 0, 0, kWidth, 0, 0, 0, kHeight, 16, 0, 0, 0, 0});
  append_part(bytes, "IDAT", packed);
  append_part(bytes, "IEND", {});
  message::CompressedImage image;
  image.format = "png";
  image.data.assign(bytes.begin(), bytes.end());
  return image;
}

class BagRemedies : public testing::Test {
 protected:
  BagRemedies() {
    // 2 mm into the plane, at 500 N/m.
    shell_.write("way.csv",
                 "t,hip_x,hip_y,hip_z\n0,0,0,0.48\n0.2,0,0,0.48\n0.3,0,0,0.502\n1,0,0,0.502\n");
  }

  // 1 s at 30 Hz of the same message on each topic, with a camera beside it.
  template <class T>
  void record(const std::vector<std::pair<std::string, T>>& topics,
              const std::string& file = "run.mcap") const {
    McapWriter writer(shell_.path(file));
    const auto infos = writer.add_topic<message::CameraInfo>("/cam/camera_info");
    for (const auto& [topic, each] : topics) {
      const auto number = writer.add_topic<T>(topic);
      T message = each;
      for (std::uint64_t i = 0; i < 30; ++i) {
        const std::uint64_t time = kNoon + i * kSecond / 30;
        message.header.stamp.sec = static_cast<std::int32_t>(time / kSecond);
        message.header.stamp.nanosec = static_cast<std::uint32_t>(time % kSecond);
        message.data[0] ^= 1;  // no two are the same
        writer.write(infos, {time, time}, message::info_of(plane().camera));
        writer.write(number, {time, time}, message);
      }
    }
  }

  // What palpate says of a source that it refuses, or cannot use.
  std::string refusal(const std::string& source) {
    const Outcome outcome = touch(source);
    return outcome.out + outcome.err;
  }

  Outcome touch(const std::string& source) {
    return shell_.run(
        fmt::format("touch '{}' --simulated-time --trajectory way.csv --json report.json", source));
  }

  // A hand that presses on it feels the plane.
  void expect_plane(const std::string& source) {
    const Outcome outcome = touch(source);
    ASSERT_EQ(outcome.code, 0) << source << outcome.err;
    const json report = json::parse(shell_.read("report.json"));
    EXPECT_NEAR(report["largest_force_N"].get<double>(), 1, 0.1) << source;
  }

  Shell shell_;
};

// The words behind `before` in a message, up to a blank or a comma.
std::string word_after(const std::string& message, const std::string& before) {
  const std::size_t at = message.find(before);
  if (at == std::string::npos) return "nothing after '" + before + "' in " + message;
  const std::size_t begin = at + before.size();
  return message.substr(begin, message.find_first_of(" ,;\n", begin) - begin);
}

TEST_F(BagRemedies, UnitIsGivenAsTheMessageSays) {
  record<message::Image>({{"/cam/depth", grey(1e-5, "16UC1")}});
  const std::string said = refusal("bag:run.mcap");
  ASSERT_TRUE(contains(said, "bag:run.mcap,unit=METRES")) << said;
  expect_plane("bag:run.mcap,unit=1e-5");
}

TEST_F(BagRemedies, UnitIsGivenBehindTheNameWhereAnOptionOfFilesIsRefused) {
  record<message::Image>({{"/cam/depth", grey(1e-5, "16UC1")}});
  for (const char* option : {"--depth-unit 1e-5", "--scale 0.01"}) {
    const Outcome refused = shell_.run(fmt::format("touch bag:run.mcap {}", option));
    EXPECT_EQ(refused.code, 2) << option;
    EXPECT_TRUE(contains(refused.err, ",unit=METRES behind their names")) << refused.err;
  }
  expect_plane("bag:run.mcap,unit=1e-5");
}

TEST_F(BagRemedies, UnitIsGivenBehindATopic) {
  message::Image millimetres = message::image_of(plane());
  for (std::size_t i = 0; i < millimetres.data.size(); i += sizeof(float)) {
    const float z = 500;
    std::memcpy(millimetres.data.data() + i, &z, sizeof(z));
  }
  record<message::Image>({{"/cam/depth", millimetres}});
  const std::string said = refusal("bag:run.mcap:/cam/depth");
  ASSERT_TRUE(contains(said, "bag:run.mcap:/cam/depth,unit=METRES")) << said;
  expect_plane("bag:run.mcap:/cam/depth,unit=0.001");
}

TEST_F(BagRemedies, TopicThatFitsIsNamed) {
  record<message::Image>(
      {{"/cam/depth", grey(1e-3, "16UC1")}, {"/cam/second", grey(1e-3, "16UC1")}});
  for (const char* asked : {"bag:run.mcap", "bag:run.mcap:/cam/absent"}) {
    expect_plane("bag:run.mcap:" + word_after(refusal(asked), "fits: "));
  }
}

TEST_F(BagRemedies, GreyTopicsThatAreListedAreFelt) {
  record<message::Image>({{"/cam/mono", grey(1e-3, "mono16")}});
  expect_plane("bag:run.mcap:" + word_after(refusal("bag:run.mcap"), "fits: "));
}

TEST_F(BagRemedies, PngTopicsThatAreListedAreFelt) {
  McapWriter writer(shell_.path("run.mcap"));
  const auto infos = writer.add_topic<message::CameraInfo>("/cam/camera_info");
  const auto images = writer.add_topic<message::CompressedImage>("/cam/image/compressed");
  const auto colors = writer.add_topic<message::CompressedImage>("/cam/color/compressed");
  message::CompressedImage jpeg;
  jpeg.format = "rgb8; jpeg compressed";
  jpeg.data.assign(100, 7);
  message::CompressedImage image = png();
  for (std::int32_t i = 0; i < 2; ++i) {
    const std::uint64_t time = kNoon + static_cast<std::uint64_t>(i) * kSecond;
    image.header.stamp.sec = static_cast<std::int32_t>(time / kSecond);
    writer.write(infos, {time, time}, message::info_of(plane().camera));
    writer.write(colors, {time, time}, jpeg);
    writer.write(images, {time, time}, image);
  }
  writer.close();
  const std::string said = refusal("bag:run.mcap");
  EXPECT_FALSE(contains(said, "/cam/color")) << said;
  expect_plane("bag:run.mcap:" + word_after(said, "fits: "));
}

TEST_F(BagRemedies, FileOfAFolderIsNamed) {
  std::filesystem::create_directory(shell_.path("runs"));
  record<message::Image>({{"/cam/depth", grey(1e-3, "16UC1")}}, "runs/a.mcap");
  record<message::Image>({{"/cam/depth", grey(1e-3, "16UC1")}}, "runs/b.mcap");
  expect_plane("bag:" + word_after(refusal("bag:runs"), "name one: "));
  const Outcome info = shell_.run("bag info runs");
  EXPECT_EQ(info.code, 1);
  const Outcome one = shell_.run("bag info " + word_after(info.err, "name one: "));
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_TRUE(contains(one.out, "/cam/depth")) << one.out;
}

TEST_F(BagRemedies, CameraIsRecordedBesideImagesThatLackIt) {
  {
    McapWriter writer(shell_.path("run.mcap"));
    const auto images = writer.add_topic<message::Image>("/cam/depth");
    writer.write(images, {kNoon, kNoon}, grey(1e-3, "16UC1"));
  }
  const std::string said = refusal("bag:run.mcap");
  EXPECT_TRUE(contains(said, "/cam/camera_info: there is no CameraInfo; record it with /cam/depth"))
      << said;
  record<message::Image>({{"/cam/depth", grey(1e-3, "16UC1")}});
  expect_plane("bag:run.mcap");
}

TEST_F(BagRemedies, CutBagIsRecovered) {
  record<message::Image>({{"/cam/depth", grey(1e-3, "16UC1")}});
  std::filesystem::resize_file(shell_.path("run.mcap"),
                               std::filesystem::file_size(shell_.path("run.mcap")) - 40);
  const Outcome cut = shell_.run("bag info run.mcap --check");
  EXPECT_TRUE(contains(cut.out, "was not closed")) << cut.out;
  ASSERT_EQ(shell_.run("bag recover run.mcap whole.mcap").code, 0);
  const Outcome whole = shell_.run("bag info whole.mcap --check");
  EXPECT_TRUE(contains(whole.out, "damaged    nothing\n")) << whole.out;
  expect_plane("bag:whole.mcap");
}

TEST_F(BagRemedies, FileThatZstdPackedIsUnpacked) {
  if (std::system("zstd --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "zstd is absent";
  std::filesystem::create_directory(shell_.path("runs"));
  record<message::Image>({{"/cam/depth", grey(1e-3, "16UC1")}}, "runs/run_0.mcap");
  const std::string in_folder = fmt::format("cd {} && ", shell_.path(""));
  const std::string pack = "zstd -q --rm runs/run_0.mcap -o runs/run_0.mcap.zstd";
  ASSERT_EQ(std::system((in_folder + pack).c_str()), 0);
  const std::string said = refusal("bag:runs");
  const std::size_t begin = said.find("'zstd");
  ASSERT_NE(begin, std::string::npos) << said;
  const std::string remedy = said.substr(begin + 1, said.find('\'', begin + 1) - begin - 1);
  ASSERT_EQ(std::system((in_folder + remedy + " 2>err").c_str()), 0)
      << remedy << shell_.read("err");
  expect_plane("bag:runs");
}

TEST_F(BagRemedies, InfoSaysOfOtherRecordingsWhatTouchSays) {
  std::filesystem::create_directory(shell_.path("lite"));
  shell_.write("lite/run_0.db3", std::string("SQLite format 3\0", 16));
  shell_.write("one.bag", "#ROSBAG V2.0\n");
  shell_.write("pointer.mcap", "version https://git-lfs.github.com/spec/v1\n");
  for (const std::string name : {"lite", "lite/run_0.db3", "one.bag", "pointer.mcap"}) {
    const Outcome info = shell_.run("bag info " + name);
    EXPECT_EQ(info.code, 1) << name;
    EXPECT_EQ(info.err, refusal("bag:" + name)) << name;
    EXPECT_TRUE(contains(info.err, "by '")) << info.err;
  }
}

}  // namespace
}  // namespace palpate::bag
