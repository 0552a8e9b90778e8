#include <gtest/gtest.h>

#include "palpate/base/error.hpp"
#include "palpate/device/remote.hpp"
#include "support/folder.hpp"

namespace palpate {
namespace {

std::string refusal(std::string_view toml) {
  try {
    static_cast<void>(parse_device_profiles(toml, "my.toml"));
  } catch (const Error& error) {
    return error.what();
  }
  return "taken";
}

TEST(DeviceProfile, KnowsTheDevicesOfTheFieldAndWhereItsFiguresComeFrom) {
  const std::vector<DeviceProfile>& all = device_profiles();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front().name, "unknown");
  for (const DeviceProfile& each : all) {
    EXPECT_FALSE(each.title.empty()) << each.name;
    EXPECT_FALSE(each.source.empty()) << each.name;
    EXPECT_TRUE(each.maximum_force || each.peak_force) << each.name;
  }
  EXPECT_EQ(device_profile("omega").maximum_stiffness, 5000);
  EXPECT_EQ(device_profile("touch").peak_force, 3.3);
}

TEST(DeviceProfile, LeavesOpenWhatIsNotKnown) {
  const DeviceProfile unknown = device_profile("unknown");
  EXPECT_FALSE(unknown.damping);
  EXPECT_FALSE(unknown.rate);
  EXPECT_FALSE(unknown.delay);
}

TEST(DeviceProfile, NamesAllWhereOneIsNotThere) {
  try {
    static_cast<void>(device_profile("spoon"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("spoon"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("falcon"), std::string::npos);
  }
}

TEST(DeviceProfile, ReadsAUsersOwn) {
  const test::Folder folder;
  folder.write("my.toml", "[arm]\nmass = 0.2\ndamping = 1\nrate = 2000\n");
  const std::vector<DeviceProfile> read = read_device_profiles(folder / "my.toml");
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].name, "arm");
  EXPECT_EQ(read[0].title, "arm");
  EXPECT_EQ(read[0].mass, 0.2);
  EXPECT_EQ(read[0].damping, 1);
  EXPECT_FALSE(read[0].maximum_force);
  EXPECT_THROW(static_cast<void>(read_device_profiles(folder / "none.toml")), Error);
  EXPECT_EQ(device_profile(folder / "my.toml").rate, 2000);
  folder.write("two.toml", "[arm]\nmass = 0.2\n[leg]\nmass = 2\n");
  EXPECT_THROW(static_cast<void>(device_profile(folder / "two.toml")), Error);
}

TEST(DeviceProfile, IsThatOfARemoteDevice) {
  const test::Folder folder;
  const SteadyClock clock;
  DeviceProfile profile;
  profile.maximum_torque = 0.3;
  profile.maximum_grip = 4;
  profile.angular_damping = 1e-4;
  profile.damping = 2;
  profile.mass = 0.3;
  profile.delay = 5e-3;
  RemoteDeviceOptions options = remote_options(profile);
  options.path = folder / "device";
  const RemoteDevice device(clock, options);
  EXPECT_EQ(device.info().maximum_force, RemoteDeviceOptions().maximum_force) << "it does not say";
  EXPECT_EQ(device.info().maximum_torque, 0.3);
  EXPECT_EQ(device.info().maximum_grip, 4);
  EXPECT_EQ(device.info().angular_damping, 1e-4);
  EXPECT_EQ(device.info().damping, 2);
  EXPECT_EQ(device.info().mass, 0.3);
  EXPECT_EQ(device.info().delay, 5e-3);
  EXPECT_EQ(device.info().rate, 1000);
}

TEST(DeviceProfile, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(refusal("[arm]\nmass = 0\n"), "my.toml, line 2: 'mass' is not a number above 0");
  EXPECT_EQ(refusal("[arm]\ndelay = -1\n"),
            "my.toml, line 2: 'delay' is not a number of 0 or more");
  EXPECT_EQ(refusal("[arm]\nrate = nan\n"), "my.toml, line 2: 'rate' is not a number above 0");
  EXPECT_EQ(refusal("[arm]\nrate = \"fast\"\n"), "my.toml, line 2: 'rate' is not a number above 0");
  EXPECT_EQ(refusal("[arm]\ntitle = 3\n"), "my.toml, line 2: 'title' is not text in quotes");
  EXPECT_NE(refusal("[arm]\nweight = 3\n").find("'weight' is not a key"), std::string::npos);
  EXPECT_NE(refusal("arm = 3\n").find("not a table"), std::string::npos);
  EXPECT_NE(refusal("[arm\n").find("my.toml, line 1"), std::string::npos);
}

}  // namespace
}  // namespace palpate
