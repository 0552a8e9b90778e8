// The real-time contract over a whole exploration of each data set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "device/explore.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "realtime/build.hpp"
#include "realtime/rig.hpp"

namespace palpate::realtime {
namespace {

// Touches a cloud for two simulated seconds, at lengths and speeds that follow its R.
Run explored(const PointCloud& cloud) {
  Scene scene;
  const Source& source = scene.add("cloud", cloud);
  const auto points = source.points();
  const double radius = points->radius;
  const ExploredSurface surface = {points->origin, points->grid.points(), points->normals};
  const Trajectory path = explore(surface, {.duration = 2,
                                            .radius = radius,
                                            .depth = 0.5 * radius,
                                            .region = 100 * radius,
                                            .slide_speed = 20 * radius,
                                            .travel_speed = 50 * radius});
  Rig rig(scene);
  for (const TrajectoryRow& row : path) rig.step(row.position);
  return rig.run();
}

void expect_contract(const PointCloud& cloud) {
  const Run run = explored(cloud);
  EXPECT_EQ(run.offences.total(), 0) << run.offences;
  EXPECT_EQ(run.infinite, 0);
  EXPECT_GT(run.touching, run.steps / 10);
  EXPECT_FALSE(has(run.contact_notes, ContactNote::fault));
}

class Exploration : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!can_trap_system_calls()) {
      GTEST_SKIP() << "this kernel has no Syscall User Dispatch (Linux 5.11 on x86-64)";
    }
  }
};

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

using SyntheticExploration = Exploration;

TEST_P(SyntheticExploration, KeepsTheContract) {
  expect_contract(synthetic_cloud(GetParam()));
}

std::vector<std::string> synthetic_clouds() {
  std::vector<std::string> names;
  for (const SyntheticName& each : synthetic_names()) names.emplace_back(each.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Of, SyntheticExploration, testing::ValuesIn(synthetic_clouds()),
                         test_name);

using RealExploration = Exploration;

// What `xz -dc` makes of a file; empty when there is no xz.
std::vector<std::byte> unpacked(const std::filesystem::path& file) {
  std::vector<std::byte> bytes;
  FILE* pipe = popen(("xz -dc '" + file.string() + "' 2>/dev/null").c_str(), "r");
  if (!pipe) return bytes;
  constexpr std::size_t kChunk = 1u << 20;
  std::size_t got = 0;
  do {
    const std::size_t size = bytes.size();
    bytes.resize(size + kChunk);
    got = std::fread(bytes.data() + size, 1, kChunk, pipe);
    bytes.resize(size + got);
  } while (got > 0);
  pclose(pipe);
  return bytes;
}

TEST_P(RealExploration, KeepsTheContract) {
  const char* data = std::getenv("PALPATE_DATA");
  if (!data) GTEST_SKIP() << "PALPATE_DATA is not set";
  const std::filesystem::path file = std::filesystem::path(data) / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no such file: " << file;
  // Depth images: the camera of most of them; a wrong one bends the surface, which is no matter
  // here.
  ReadOptions options;
  options.intrinsics = Pinhole{.fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5};
  if (file.extension() != ".xz") return expect_contract(read_cloud(file, options));

  if (!kOptimised) GTEST_SKIP() << "too large for a debug build: " << file;
  const std::vector<std::byte> bytes = unpacked(file);
  if (bytes.empty()) GTEST_SKIP() << "no xz to unpack " << file;
  expect_contract(read_cloud_bytes(bytes, file.stem(), options).cloud);
}

INSTANTIATE_TEST_SUITE_P(
    Of, RealExploration,
    testing::Values("stanford_bunny/bun_zipper.ply", "stanford_bunny/scans/bun000.ply",
                    "stanford_dragon/dragon_vrip.ply.gz", "pcl_tabletop/osd_test0.pcd",
                    "pcl_tabletop/table_scene_mug_stereo_textured.pcd",
                    "pcl_tabletop/room_scan1.pcd", "realsense_makerspace_mit/depth/000125.png",
                    "redwood_open3d_mit/depth/000000.png", "redwood_open3d_mit/fragment.pcd",
                    "multiview_shelf_apc/depth/000000.png", "pdal_small/autzen_trim.las",
                    "lamppost/lamppost.pcd", "autzen_10m/autzen.las.xz"),
    test_name);

}  // namespace
}  // namespace palpate::realtime
