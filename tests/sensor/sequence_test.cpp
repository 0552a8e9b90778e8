#include "sensor/sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"
#include "sensor/fake_camera.hpp"
#include "sensor/folder.hpp"

namespace palpate {
namespace {

using namespace sensor;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kCamera = R"("fx": 4, "fy": 4, "cx": 1.5, "cy": 1)";

std::string refusal(const std::filesystem::path& folder) {
  try {
    (void)read_sequence(folder);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string described(const std::string& more = "") {
  return std::string("{") + kCamera + more + "}";
}

// Images of 1, 2, ... m at 10 Hz.
void write_images(const Folder& folder, int count, const std::string& more = "") {
  folder.write("sequence.json", described(R"(, "fps": 10)" + more));
  for (int i = 0; i < count; ++i) {
    folder.write("depth/00" + std::to_string(i) + ".pgm",
                 pgm(static_cast<std::uint16_t>(1000 * (i + 1))));
  }
}

TEST(Sequence, FindsImagesByName) {
  const Folder folder;
  write_images(folder, 3);
  folder.write("depth/readme.txt", "no image");
  const Sequence sequence = read_sequence(folder.path());
  ASSERT_EQ(sequence.frames.size(), 3u);
  EXPECT_EQ(sequence.frames[2].image.filename(), "002.pgm");
  EXPECT_DOUBLE_EQ(sequence.frames[2].stamp, 0.2);
  EXPECT_EQ(sequence.rate, 10);
  EXPECT_FALSE(sequence.posed);
}

TEST(Sequence, HonoursFolderAndStamps) {
  const Folder folder;
  folder.write("sequence.json", described(R"(, "images": "d", "stamps": [5, 5.5, 7])"));
  for (const char* name : {"d/a.pgm", "d/b.pgm", "d/c.pgm"}) folder.write(name, pgm(1));
  const Sequence sequence = read_sequence(folder.path());
  ASSERT_EQ(sequence.frames.size(), 3u);
  EXPECT_EQ(sequence.frames[1].stamp, 5.5);
  folder.write("sequence.json", described(R"(, "images": "d", "stamps": [5, 5.5])"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("2 times for 3 images"));
  folder.write("sequence.json", described(R"(, "images": "d", "stamps": [5, 5, 6])"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("do not increase"));
}

TEST(Sequence, KnowsTheTumLayout) {
  const Folder folder;
  folder.write("depth.txt", "# depth maps\n10.0 depth/a.pgm\n10.1 depth/b.pgm\n10.2 depth/c.pgm\n");
  folder.write("groundtruth.txt", "10.05 0 0 0 0 0 0 1\n10.15 1 0 0 0 0 0 1\n");
  for (const char* name : {"depth/a.pgm", "depth/b.pgm", "depth/c.pgm"}) {
    folder.write(name, pgm(5000));
  }
  const Sequence sequence = read_sequence(folder.path());
  ASSERT_EQ(sequence.frames.size(), 3u);
  EXPECT_DOUBLE_EQ(sequence.depth_unit, 2e-4);
  EXPECT_EQ(sequence.camera.pinhole.fx, 525);
  EXPECT_NEAR(sequence.rate, 10, 1e-6);
  EXPECT_TRUE(sequence.posed);
  EXPECT_FALSE(sequence.frames[0].T_world_sensor);
  ASSERT_TRUE(sequence.frames[1].T_world_sensor);
  EXPECT_NEAR(sequence.frames[1].T_world_sensor->translation().x(), 0.5, 1e-9);
  const auto camera = open_sequence(sequence);
  EXPECT_THAT(camera->info().assumed, HasSubstr("5000 units of depth a metre"));
  DepthFrame frame;
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::unposed);
  EXPECT_THAT(camera->reason(), AllOf(HasSubstr("a.pgm"), HasSubstr("no pose")));
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
  EXPECT_EQ(frame.depth[0], 1.0F);
}

TEST(Sequence, TakesPosesByOrderNumberDirectionAndMounting) {
  const Folder folder;
  const std::string matrix = "1 0 0 5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  folder.write("by_order.log", "1 1 2\n" + matrix);
  folder.write("by_number.txt",
               "# depth-to-color extrinsic\n1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
               "# pose of frame-000081\n" +
                   matrix);
  for (const char* name : {"80.pgm", "81.pgm"}) folder.write(name, pgm(1));
  const auto x_of = [&](const std::string& fields) {
    folder.write("sequence.json", described(fields));
    const Sequence sequence = read_sequence(folder.path());
    EXPECT_FALSE(sequence.frames.at(0).T_world_sensor);
    return sequence.frames.at(1).T_world_sensor.value().translation().x();
  };
  EXPECT_EQ(x_of(R"x(, "pose": "by_order.log (camera-to-world)")x"), 5);
  EXPECT_EQ(x_of(R"(, "pose": "by_number.txt")"), 5.5);
  EXPECT_EQ(x_of(R"(, "pose": "by_order.log", "pose_direction": "world_to_camera")"), -5);
  EXPECT_EQ(x_of(R"(, "pose": "by_order.log", "T_pose_camera": [1, 0, 0, 0, 0, 0, 1])"), 6);
}

TEST(Sequence, SaysWhatIsMissing) {
  const Folder folder;
  EXPECT_THAT(refusal(folder.path() / "absent"), HasSubstr("no such folder"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("Add a sequence.json"));
  folder.write("sequence.json", described(R"(, "images": "absent")"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("cannot be listed"));
  folder.write("sequence.json", described(R"(, "pose": "absent.log")"));
  EXPECT_THAT(refusal(folder.path()), AllOf(HasSubstr("absent.log: no such file"),
                                            HasSubstr("\"pose\" in"), HasSubstr("sequence.json")));
  folder.write("sequence.json", described(R"(, "frames": "absent.txt")"));
  EXPECT_THAT(refusal(folder.path()),
              AllOf(HasSubstr("absent.txt: no such file"), HasSubstr("\"frames\" in")));
  folder.write("sequence.json", described());
  EXPECT_THROW((void)open_sequence(read_sequence(folder.path())), Error) << "without images";
}

TEST(SequenceCamera, PlaysAsFastAsItIsAsked) {
  const Folder folder;
  write_images(folder, 3);
  const auto camera = open_sequence(read_sequence(folder.path()));
  EXPECT_FALSE(camera->info().paces);
  EXPECT_EQ(camera->info().rate, 10);
  DepthFrame frame;
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
    EXPECT_DOUBLE_EQ(frame.stamp, 0.1 * i);
    EXPECT_EQ(frame.depth[5], static_cast<float>(i + 1));
    EXPECT_EQ(frame.camera.width, 4);
  }
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::ended);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::ended);
}

TEST(SequenceCamera, KeepsTheTimeOfItsClock) {
  const Folder folder;
  write_images(folder, 3);
  ManualClock clock;
  clock.set(100);
  const auto camera = open_sequence(read_sequence(folder.path()), {.clock = &clock});
  EXPECT_TRUE(camera->info().paces);
  DepthFrame frame;
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
  EXPECT_DOUBLE_EQ(frame.stamp, 100);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::waiting);
  EXPECT_EQ(camera->read(frame, 1e-3), DepthCamera::Status::waiting);
  clock.set(100.099);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::waiting);
  clock.set(100.25);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::frame) << "late, and not left out";
  EXPECT_DOUBLE_EQ(frame.stamp, 100.1);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
  EXPECT_DOUBLE_EQ(frame.stamp, 100.2);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::ended);
}

// Who plans by the first frame for a while leaves no backlog behind.
TEST(SequenceCamera, BeginsAgainWhenItIsTold) {
  const Folder folder;
  write_images(folder, 3);
  ManualClock clock;
  const auto camera = open_sequence(read_sequence(folder.path()), {.clock = &clock});
  DepthFrame frame;
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
  clock.set(50);
  camera->begin(51);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::waiting) << "not yet";
  for (int i = 0; i < 3; ++i) {
    clock.set(51 + 0.1 * i);
    ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
    EXPECT_EQ(frame.stamp, clock.now());
    EXPECT_EQ(frame.depth[0], static_cast<float>(i + 1));
    EXPECT_NE(camera->read(frame, 0), DepthCamera::Status::frame);
  }
  camera->begin(60);
  clock.set(60);
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::frame) << "also after its end";
  EXPECT_EQ(frame.depth[0], 1.0F);
}

TEST(SequenceCamera, LoopsWithStampsThatGoOn) {
  const Folder folder;
  write_images(folder, 2);
  const auto camera = open_sequence(read_sequence(folder.path()), {.loop = true});
  camera->begin(7);
  DepthFrame frame;
  for (int i = 0; i < 7; ++i) {
    ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
    EXPECT_NEAR(frame.stamp, 7 + 0.1 * i, 1e-12);
    EXPECT_EQ(frame.depth[0], static_cast<float>(i % 2 + 1));
  }
}

TEST(SequenceCamera, GoesOnAfterEveryKindOfDamage) {
  const Folder folder;
  write_images(folder, 6);
  std::string swapped = "P5 16 16 65535\n";
  for (int i = 0; i < 256; ++i) {
    swapped += static_cast<char>((1000 + i) & 0xff);
    swapped += static_cast<char>((1000 + i) >> 8);
  }
  folder.write("depth/001.pgm", pgm(1).substr(0, 20));
  folder.write("depth/002.pgm", "garbage");
  folder.write("depth/003.pgm", pgm(1, 8, 6));
  folder.write("depth/004.pgm", swapped);
  const Sequence sequence = read_sequence(folder.path());
  const auto camera = open_sequence(sequence);
  std::filesystem::remove(sequence.frames[4].image);
  DepthFrame frame;
  ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
  for (const char* why :
       {"pixels", "002.pgm", "8 x 6 pixels, but the camera has 4 x 3", "no such file"}) {
    EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::damaged);
    EXPECT_THAT(camera->reason(), HasSubstr(why));
  }
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
  EXPECT_EQ(camera->reason(), "");
  EXPECT_NEAR(frame.stamp, 0.5, 1e-12);
  folder.write("depth/000.pgm", swapped);
  const auto again = open_sequence(read_sequence(folder.path()));
  EXPECT_EQ(again->read(frame, 0), DepthCamera::Status::damaged);
  EXPECT_THAT(again->reason(), HasSubstr("byte_order"));
}

}  // namespace
}  // namespace palpate
