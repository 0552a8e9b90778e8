#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sensor/folder.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

TEST(OpenCamera, OpensByName) {
  DepthFrame frame;
  EXPECT_EQ(open_camera("simulated")->read(frame, 0), DepthCamera::Status::frame);
  const sensor::Folder folder;
  folder.write("sequence.json", R"({"fx": 4, "fy": 4, "cx": 1.5, "cy": 1})");
  folder.write("depth/0.pgm", sensor::pgm(2000));
  const std::string name = "sequence:" + folder.path().string();
  const auto once = open_camera(name);
  EXPECT_EQ(once->info().name, name);
  EXPECT_EQ(once->read(frame, 0), DepthCamera::Status::frame);
  EXPECT_EQ(frame.depth[0], 2.0F);
  EXPECT_EQ(once->read(frame, 0), DepthCamera::Status::ended);
  const auto loop = open_camera(name, {.loop = true});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(loop->read(frame, 0), DepthCamera::Status::frame);
}

// What comes once again bit for bit is no frozen picture where there is no noise, or one image.
TEST(OpenCamera, KnowsWhichCamerasRepeatThemselves) {
  EXPECT_FALSE(open_camera("simulated:still")->info().repeats);
  EXPECT_FALSE(open_camera("simulated:still,loop=2")->info().repeats);
  EXPECT_TRUE(open_camera("simulated:still,loop=1")->info().repeats);
  EXPECT_TRUE(open_camera("simulated:still,noise=none")->info().repeats);
  const sensor::Folder folder;
  folder.write("sequence.json", R"({"fx": 4, "fy": 4, "cx": 1.5, "cy": 1})");
  folder.write("depth/0.pgm", sensor::pgm(2000));
  const std::string name = "sequence:" + folder.path().string();
  EXPECT_FALSE(open_camera(name)->info().repeats);
  EXPECT_TRUE(open_camera(name, {.loop = true})->info().repeats);
  folder.write("depth/1.pgm", sensor::pgm(2001));
  EXPECT_FALSE(open_camera(name, {.loop = true})->info().repeats);
}

TEST(OpenCamera, SaysWhichCamerasThereAre) {
  for (const char* name : {"", "webcam", "simulatd:table"}) {
    try {
      (void)open_camera(name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("simulated[:SCENE]"));
    }
  }
}

TEST(OpenCamera, ListsEveryDriverAndWhatIsMissing) {
  const std::vector<DriverInfo> drivers = list_cameras();
  ASSERT_EQ(drivers.size(), 7u);
  for (const DriverInfo& driver : drivers) {
    EXPECT_FALSE(driver.description.empty()) << driver.name;
    EXPECT_EQ(driver.available, driver.missing.empty()) << driver.name;
    if (driver.available) continue;
    EXPECT_TRUE(driver.devices.empty());
    try {
      (void)open_camera(driver.name);
      FAIL() << driver.name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(driver.missing));
    }
  }
  EXPECT_EQ(drivers[0].name, "simulated");
  for (const DriverInfo::Device& device : drivers[0].devices) {
    DepthFrame frame;
    EXPECT_EQ(open_camera(device.name)->read(frame, 0), DepthCamera::Status::frame) << device.name;
  }
}

}  // namespace
}  // namespace palpate
