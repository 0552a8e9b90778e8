#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/drivers.hpp"
#include "device/fake_hardware.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate::device {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& name) {
  try {
    check_options(parse_device_name(name), {"url", "profile"});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(DeviceName, IsTakenApart) {
  const DeviceName plain = parse_device_name("haply");
  EXPECT_EQ(plain.driver, "haply");
  EXPECT_EQ(plain.device, "");
  EXPECT_TRUE(plain.options.empty());
  const DeviceName whole = parse_device_name("haply:04EA,url=ws://host:1,profile=inverse3");
  EXPECT_EQ(whole.device, "04EA");
  EXPECT_EQ(whole.option("url"), "ws://host:1");
  EXPECT_EQ(whole.option("profile"), "inverse3");
  EXPECT_EQ(whole.option("library"), "");
  EXPECT_EQ(whole.option("library", "libdhd.so.3"), "libdhd.so.3");
  EXPECT_EQ(parse_device_name("haply,url=ws://host:1").device, "") << "the colon is the option's";
  EXPECT_EQ(parse_device_name("").driver, "");
}

TEST(DeviceName, OptionsThatAreNoneAreRefused) {
  EXPECT_THAT(refusal("haply,url"), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(refusal("haply,url="), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(refusal("haply,=x"), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(refusal("haply,"), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(refusal("haply,url=a,url=b"), HasSubstr("twice"));
  EXPECT_THAT(refusal("haply,uri=a"), HasSubstr("url, profile"));
}

}  // namespace

}  // namespace palpate::device

namespace palpate {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refused_name(const std::string& name) {
  test::MovedClock clock;
  try {
    (void)open_device(name, clock, {.threaded = false});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(OpenDevice, OpensByName) {
  test::MovedClock clock;
  const auto device = open_device(std::string("forcedimension,library=") + PALPATE_FAKE_DHD, clock,
                                  {.threaded = false});
  device->service();
  EXPECT_EQ(device->read().status, DeviceState::Status::silent);
  EXPECT_EQ(device->read().status, DeviceState::Status::ok);
  EXPECT_THAT(device->info().name, HasSubstr("omega.3"));
  EXPECT_EQ(device->info().rate, 4000);
  EXPECT_DOUBLE_EQ(device->info().delay.value_or(0), 3 / 4000.0) << "its own, and the thread's";
}

TEST(OpenDevice, SaysWhatThereIs) {
  EXPECT_THAT(
      refused_name("phantom"),
      AllOf(HasSubstr("phantom"), HasSubstr("forcedimension[:N]"), HasSubstr("openhaptics[:NAME]"),
            HasSubstr("haply[:ID]"), HasSubstr("palpate devices")));
  EXPECT_THAT(refused_name(""), HasSubstr("no such device"));
}

TEST(OpenDevice, KnowsNamesOfHardware) {
  EXPECT_TRUE(names_hardware("haply"));
  EXPECT_TRUE(names_hardware("haply:04EA,url=ws://localhost:1"));
  EXPECT_TRUE(names_hardware("forcedimension,profile=omega"));
  EXPECT_TRUE(names_hardware("openhaptics:Default Device"));
  EXPECT_FALSE(names_hardware("simulated"));
  EXPECT_FALSE(names_hardware("haplyx"));
  EXPECT_FALSE(names_hardware(""));
}

TEST(ListDevices, TellsEveryDriverAndWhyItIsNotThere) {
  const std::vector<DriverInfo> drivers = list_devices();
  ASSERT_EQ(drivers.size(), 4u);
  for (const DriverInfo& driver : drivers) {
    EXPECT_TRUE(names_hardware(driver.name));
    EXPECT_FALSE(driver.description.empty());
    EXPECT_EQ(driver.available, driver.missing.empty());
  }
}

}  // namespace

}  // namespace palpate
