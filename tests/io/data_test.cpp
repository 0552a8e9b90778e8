// Every file of the real data set loads, with the number of points known of it, or is refused with
// a message that helps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <thread>

#include "io/reading.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

struct Expected {
  std::string path;      // regular expression on the path inside the data set
  std::size_t declared;  // 0: any
  std::string refusal;   // part of the message; empty: it loads
};

const std::vector<Expected> kTable{
    {"stanford_bunny/bun_zipper.ply", 35947, ""},
    {"stanford_bunny/bun_zipper_res2.ply", 8171, ""},
    {"stanford_bunny/bun_zipper_res3.ply", 1889, ""},
    {"stanford_bunny/bun_zipper_res4.ply", 453, ""},
    {"stanford_bunny/scans/.*\\.ply", 0, ""},
    {"stanford_dragon/dragon_vrip.ply.gz", 437645, ""},
    {"stanford_dragon/dragon_vrip_res3.ply.gz", 22998, ""},
    {"lamppost/lamppost.pcd", 1771, ""},
    {"redwood_open3d_mit/fragment.pcd", 113662, ""},
    {"redwood_open3d_mit/frag_115.ply", 64365, ""},
    {"pcl_tabletop/bun0.pcd", 397, ""},
    {"pcl_tabletop/room_scan1.pcd", 112586, ""},
    {"pcl_tabletop/room_scan2.pcd", 112624, ""},
    {"pcl_tabletop/region_growing_tutorial.pcd", 108104, ""},
    {"pcl_tabletop/.*\\.pcd", 307200, ""},
    {".*depth.*\\.png", 307200, ""},
    {"pdal_small/autzen_trim.las", 110000, ""},
    {"pdal_small/autzen_trim.laz", 110000, ""},
    {"pdal_small/lone-star.*laz", 518862, ""},
    {"autzen_10m/autzen.las.xz", 0, "xz -dk"},
    {".*\\.json", 0, "JSON"},
    {".*(trajectory|odometry)\\.log", 0, "values in a row, but the first row has 3"},
    {".*cam\\.info\\.txt", 0, "line 16: 5 values in a row, but the first row has 4"},
    {".*(SOURCE\\.txt|LICENSE.*|README.*|bun\\.conf)", 0, "neither a point nor a header"},
};

std::filesystem::path data_folder() {
  const char* folder = std::getenv("PALPATE_DATA");
  return folder == nullptr ? std::filesystem::path{} : std::filesystem::path(folder);
}

const Expected* expected_of(const std::string& path) {
  for (const Expected& entry : kTable) {
    if (std::regex_match(path, std::regex(entry.path))) return &entry;
  }
  return nullptr;
}

class Data : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(data_folder())) {
      GTEST_SKIP() << "PALPATE_DATA names no folder with the real data";
    }
  }
};

TEST_F(Data, EveryFileLoadsOrIsRefusedWithAMessageThatHelps) {
  ReadOptions options;
  options.intrinsics = Pinhole{.fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data_folder())) {
    if (!entry.is_regular_file()) continue;
    const std::string path = entry.path().lexically_relative(data_folder()).string();
    const Expected* expected = expected_of(path);
    std::string message;
    try {
      const CloudFile file = read_cloud_file(entry.path(), options);
      std::printf("%s: %zu of %zu points, %s\n", path.c_str(), file.cloud.size(), file.declared,
                  file.format.c_str());
      const bool sampled = file.mesh && file.mesh->spacing > 0;
      EXPECT_TRUE(sampled || file.declared == file.cloud.size() + file.dropped);
      EXPECT_EQ(sampled, std::regex_match(path, std::regex(".*_res[34]\\.ply"))) << path;
      if (expected != nullptr && expected->declared > 0) {
        EXPECT_EQ(file.declared, expected->declared) << path;
      }
    } catch (const Error& error) {
      message = error.what();
      std::printf("%s\n", message.c_str());
    }
    if (expected == nullptr) continue;  // added since: any answer but a fault
    EXPECT_EQ(message.empty(), expected->refusal.empty()) << path << ": " << message;
    EXPECT_THAT(message, HasSubstr(expected->refusal));
  }
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Every point of the file against its integers, read here by the layout of its header.
TEST_F(Data, LasPointsAreThoseOfTheFile) {
  const auto path = data_folder() / "pdal_small/autzen_trim.las";
  const std::string bytes = bytes_of(path);
  const CloudFile file = read_cloud_file(path, {.scale = 1});
  ASSERT_EQ(file.cloud.size(), 110000u);
  const auto number = [&]<class T>(std::size_t offset, T) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
  };
  const std::size_t begin = number(96, std::uint32_t{});
  const std::size_t size = number(105, std::uint16_t{});
  for (std::size_t i = 0; i < file.cloud.size(); ++i) {
    const std::size_t record = begin + i * size;
    const Eigen::Vector3d point = file.cloud.point(i);
    for (std::size_t k = 0; k < 3; ++k) {
      const double scale = number(131 + 8 * k, double{});
      const double offset = number(155 + 8 * k, double{});
      const double steps = (point[static_cast<Eigen::Index>(k)] - offset) / scale;
      ASSERT_NEAR(steps, number(record + 4 * k, std::int32_t{}), 0.01) << i;
    }
    ASSERT_EQ(file.cloud.intensities[i], number(record + 12, std::uint16_t{})) << i;
  }
}

TEST_F(Data, ScansOfTheBunnyHoldAllTheirPoints) {
  std::size_t points = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(data_folder() / "stanford_bunny/scans")) {
    if (entry.path().extension() == ".ply") points += read_cloud(entry.path()).size();
  }
  EXPECT_EQ(points, 362272u);
}

TEST_F(Data, FragmentHasUnitNormals) {
  const PointCloud cloud = read_cloud(data_folder() / "redwood_open3d_mit/fragment.pcd");
  ASSERT_EQ(cloud.normals.size(), cloud.size());
  ASSERT_EQ(cloud.colors.size(), cloud.size());
  for (const auto& n : cloud.normals) ASSERT_NEAR(n.norm(), 1, 1e-5);
}

// Ten million points through a pipe, as "xz -dc autzen.las.xz | palpate ... -" gives them.
TEST_F(Data, LidarThroughXzStaysInTheBoundsOfItsHeader) {
  if (std::system("xz --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "xz is not installed";
  const auto pipe =
      std::filesystem::temp_directory_path() / ("palpate-xz-" + std::to_string(getpid()));
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string command = "xz -dc '" + (data_folder() / "autzen_10m/autzen.las.xz").string() +
                              "' > '" + pipe.string() + "'";
  CloudFile file;
  {
    std::jthread unpack([&] { EXPECT_EQ(std::system(command.c_str()), 0); });
    file = read_cloud_file(pipe, {.scale = 1});
  }
  std::filesystem::remove(pipe);
  EXPECT_EQ(file.cloud.size(), 10653336u);
  Box box;
  for (std::size_t i = 0; i < file.cloud.size(); ++i) box.extend(file.cloud.point(i));
  // About 1.04 x 1.42 km, in feet; the header's offset lies within.
  EXPECT_NEAR(0.3048 * box.size().x(), 1040, 20);
  EXPECT_NEAR(0.3048 * box.size().y(), 1420, 20);
  EXPECT_TRUE(box.contains({637291, 851210, 511}));
}

}  // namespace
}  // namespace palpate
