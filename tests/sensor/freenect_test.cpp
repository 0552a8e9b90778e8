// libfreenect's driver on fakenect, which stands in for the library and plays a dump made here.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sensor/fake_camera.hpp"
#include "sensor/folder.hpp"

namespace palpate {
namespace {

using namespace sensor;
using testing::HasSubstr;

// Frame k holds the raw value 600 + k; one pixel has none.
void write_dump(const Folder& folder, int frames) {
  std::string index;
  for (int k = 0; k < frames; ++k) {
    const std::string name = fmt::format("d-{:.6f}-{}.pgm", 100 + k / 200.0, 2'000'000 * k);
    std::string image = "P5 640 480 65535\n";
    for (int i = 0; i < 640 * 480; ++i) {
      const int raw = i == 7 ? 2047 : 600 + k;
      image += static_cast<char>(raw & 0xff);
      image += static_cast<char>(raw >> 8);
    }
    folder.write(name, image);
    index += name + "\n";
  }
  folder.write("INDEX.txt", index);
}

// The maker's nominal values: 1.2 m and 75 mm, one pixel of the sensor being 1.042 mm there.
float metres(int raw) {
  return static_cast<float>(1.2 * 0.075 / (0.075 - (raw / 4.0 - 200.375) * 1.042e-3));
}

TEST(Freenect, PlaysADump) {
  const Folder folder;
  write_dump(folder, 10);
  setenv("FAKENECT_PATH", folder.path().c_str(), 1);
  ManualClock clock;
  clock.set(10);
  const auto camera = open_camera("freenect", {.clock = &clock});
  EXPECT_EQ(camera->info().name, "freenect:0");
  DepthFrame frame;
  double stamp = 0;
  for (int k = 0; k < 10; ++k) {
    clock.set(10 + k / 30.0);
    DepthCamera::Status status = DepthCamera::Status::waiting;
    for (int i = 0; i < 10 && status == DepthCamera::Status::waiting; ++i) {
      status = camera->read(frame, 0.05);
    }
    ASSERT_EQ(status, DepthCamera::Status::frame) << k << camera->reason();
    EXPECT_EQ(frame.camera.width, 640);
    EXPECT_NEAR(frame.camera.pinhole.fx, 575.8, 0.1);
    ASSERT_EQ(frame.depth.size(), 640u * 480u);
    EXPECT_NEAR(frame.depth[100], metres(600 + k), 1e-6);
    EXPECT_EQ(frame.depth[7], 0.0F);
    EXPECT_NEAR(frame.stamp, 10 + k / 30.0, 1e-3);
    EXPECT_GT(frame.stamp, stamp);
    stamp = frame.stamp;
  }
}

TEST(Freenect, RefusesNumbersThatAreNone) {
  const auto refusal = [](const std::string& name) -> std::string {
    try {
      (void)open_camera(name);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(refusal("freenect:a"), HasSubstr("not a number"));
  EXPECT_THAT(refusal("freenect:-1"), HasSubstr("not a number"));
  EXPECT_THAT(refusal("freenect:7"), HasSubstr("no such Kinect"));
}

TEST(Freenect, ListsItsCamera) {
  for (const DriverInfo& driver : list_cameras()) {
    if (driver.name != "freenect") continue;
    EXPECT_TRUE(driver.available) << driver.missing;
    ASSERT_EQ(driver.devices.size(), 1u);
    EXPECT_EQ(driver.devices[0].name, "freenect:0");
    return;
  }
  FAIL() << "no driver of that name";
}

}  // namespace
}  // namespace palpate
