#include "device/device_name.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"

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
