#include "dds/domain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "palpate/base/error.hpp"

namespace palpate::dds {
namespace {

using testing::HasSubstr;
using testing::Not;

DomainOptions read(const std::map<std::string, std::string>& variables) {
  return options_from([&](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? std::nullopt : std::optional(found->second);
  });
}

TEST(Domain, TellsThisMachineAloneUnlessAskedOtherwise) {
  EXPECT_EQ(read({}).range, Range::localhost);
  EXPECT_EQ(read({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET"}}).range, Range::subnet);
  EXPECT_EQ(read({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF"}}).range, Range::localhost);
  EXPECT_EQ(read({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET"}, {"ROS_LOCALHOST_ONLY", "1"}}).range,
            Range::localhost);
}

TEST(Domain, IsTheOneOfTheEnvironment) {
  EXPECT_EQ(read({{"ROS_DOMAIN_ID", "42"}}).id, 42U);
  EXPECT_EQ(read({{"ROS_DOMAIN_ID", ""}}).id, 0U);
  for (const char* wrong : {"233", "-1", "4x", "x", "99999999999"}) {
    EXPECT_THAT(
        [&] {
          static_cast<void>(read({{"ROS_DOMAIN_ID", wrong}}));
        },
        testing::ThrowsMessage<Error>(HasSubstr(wrong)));
  }
  EXPECT_THROW(static_cast<void>(read({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "MOON"}})), Error);
}

TEST(Domain, IsSetUpByItsOwnerWhereThereIsOne) {
  EXPECT_TRUE(read({}).own_settings);
  EXPECT_FALSE(read({{"CYCLONEDDS_URI", "file:///etc/cyclone.xml"}}).own_settings);
}

TEST(Domain, AsksForNoMoreReceiveBufferThanTheSystemAllows) {
  EXPECT_THAT(settings_of({}, 212992), HasSubstr("min=\"212992B\""));
  EXPECT_THAT(settings_of({}, 1 << 30), HasSubstr("min=\"4194304B\""));
  EXPECT_THAT(settings_of({}, 0), Not(HasSubstr("SocketReceiveBufferSize")));
}

TEST(Domain, TellsFurtherMachinesThatAreNamed) {
  const std::string local = settings_of(read({{"ROS_STATIC_PEERS", "robot;10.0.0.7;"}}), 0);
  EXPECT_THAT(
      local,
      HasSubstr(R"(<Peer address="localhost"/><Peer address="robot"/><Peer address="10.0.0.7"/>)"));
  EXPECT_THAT(local, HasSubstr("<AllowMulticast>false"));
  const std::string wide = settings_of({.range = Range::subnet, .peers = "robot"}, 0);
  EXPECT_THAT(wide, Not(HasSubstr("AllowMulticast")));
  EXPECT_THAT(wide, HasSubstr(R"(<Peers><Peer address="robot"/></Peers>)"));
  EXPECT_THROW(static_cast<void>(settings_of({.peers = "\"/><evil"}, 0)), Error);
}

}  // namespace
}  // namespace palpate::dds
