// Folders of clouds, played as sequences.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"
#include "sensor/folder.hpp"
#include "sensor/sequence.hpp"

namespace palpate {
namespace {

using namespace sensor;
using testing::HasSubstr;

constexpr const char* kCamera = R"({"fx": 4, "fy": 4, "cx": 1.5, "cy": 1})";

// Three points in the plane z, as PCD.
std::string pcd(double z) {
  std::string text =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS "
      "3\n"
      "DATA ascii\n";
  for (const char* xy : {"0 0 ", "1 0 ", "0 1 "}) text += xy + std::to_string(z) + "\n";
  return text;
}

TEST(CloudSequence, PlaysAFolderOfCloudsByTheTimesInTheirNames) {
  struct Case {
    const char* first;
    const char* second;
    double interval;
  };
  for (const Case& c :
       {Case{"9.5", "10.25", 0.75}, Case{"1460131600000000", "1460131600100000", 0.1},
        Case{"1460131600000000000", "1460131600200000000", 0.2},
        Case{"frame_1", "frame_2", 1.0 / 30}, Case{"1", "2", 1.0 / 30}}) {
    const Folder folder;
    folder.write(std::string(c.second) + ".pcd", pcd(2));
    folder.write(std::string(c.first) + ".PCD", pcd(1));
    folder.write("notes.txt", "no cloud");
    const Sequence sequence = read_sequence(folder.path());
    ASSERT_EQ(sequence.frames.size(), 2U) << c.first;
    EXPECT_NEAR(sequence.rate, 1 / c.interval, 1e-4 / c.interval) << c.first;
    EXPECT_EQ(sequence.assumed, "");
    const auto camera = open_sequence(sequence);
    DepthFrame frame;
    ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame) << camera->reason();
    ASSERT_TRUE(frame.cloud);
    EXPECT_EQ(frame.cloud->size(), 3U);
    EXPECT_EQ(frame.cloud->point(0).z(), 1) << c.first;
    ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
    EXPECT_EQ(frame.cloud->point(0).z(), 2);
    EXPECT_NEAR(frame.stamp, c.interval, 1e-6);
    EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::ended);
  }
}

TEST(CloudSequence, PlaysTheScansOfKitti) {
  const Folder folder;
  for (int k = 0; k < 3; ++k) {
    std::string bytes;
    for (const float number : {0.F, 1.F, static_cast<float>(k), 0.5F}) {
      bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    folder.write("000000000" + std::to_string(k) + ".bin", bytes);
  }
  const auto camera = open_sequence(read_sequence(folder.path()));
  DepthFrame frame;
  for (int k = 0; k < 3; ++k) {
    ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame) << camera->reason();
    ASSERT_TRUE(frame.cloud);
    EXPECT_EQ(frame.cloud->point(0), Eigen::Vector3d(0, 1, k));
  }
}

TEST(CloudSequence, PlaysImagesAloneWhereThereAreAny) {
  const Folder folder;
  folder.write("sequence.json", kCamera);
  for (const char* name : {"depth/0.pgm", "depth/1.pgm", "depth/2.pgm"}) folder.write(name, pgm(1));
  folder.write("depth/001_mesh.ply", "of all images");
  EXPECT_EQ(read_sequence(folder.path()).frames.size(), 3U);
}

TEST(CloudSequence, AnImageAfterACloudIsAnImage) {
  const Folder folder;
  folder.write("sequence.json", R"({"fx": 4, "fy": 4, "cx": 1.5, "cy": 1, "frames": "list.txt"})");
  folder.write("list.txt", "0 a.pgm\n1 b.pcd\n2 c.pgm\n3 d.pgm\n");
  for (const char* name : {"a.pgm", "c.pgm", "d.pgm"}) folder.write(name, pgm(1000));
  folder.write("b.pcd", pcd(1));
  const auto camera = open_sequence(read_sequence(folder.path()));
  DepthFrame frame;
  for (const bool cloud : {false, true, false, false}) {
    ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::frame) << camera->reason();
    EXPECT_EQ(frame.cloud != nullptr, cloud);
  }
}

TEST(CloudSequence, CloudsNeedNoLensAndMayHavePoses) {
  const Folder folder;
  folder.write("sequence.json", R"({"images": "scans", "fps": 5, "pose": "poses.txt"})");
  folder.write("scans/a.ply", "no ply");
  folder.write("scans/b.pcd", pcd(1));
  folder.write("poses.txt", "0 1 0 0 0 0 0 1\n0.2 2 0 0 0 0 0 1\n");
  const Sequence sequence = read_sequence(folder.path());
  EXPECT_EQ(sequence.rate, 5);
  ASSERT_TRUE(sequence.frames[1].T_world_sensor);
  EXPECT_EQ(sequence.frames[1].T_world_sensor->translation().x(), 2);
  const auto camera = open_sequence(sequence);
  DepthFrame frame;
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::damaged);
  EXPECT_THAT(camera->reason(), HasSubstr("a.ply"));
  EXPECT_EQ(camera->read(frame, 0), DepthCamera::Status::frame);
  folder.write("scans/c.png", "an image, so clouds are no frames");
  try {
    (void)read_sequence(folder.path());
    FAIL() << "images need a lens";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"fx\" is missing"));
  }
}

}  // namespace
}  // namespace palpate
