#include "dds/endpoint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "dds/discovery.hpp"
#include "message/sensor_types.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"

namespace palpate::dds {
namespace {

using message::Image;
using message::PoseStamped;

// Tests that run side by side have a domain each.
DomainOptions domain() {
  return {.id = 100 + static_cast<std::uint32_t>(getpid()) % 100};
}

// Until `done`, for as long as a loaded machine may take.
bool soon(const std::function<bool()>& done) {
  SteadyClock clock;
  for (const double end = clock.now() + 20; clock.now() < end;) {
    if (done()) return true;
    clock.wait_until(clock.now() + 0.01);
  }
  return false;
}

TEST(Endpoint, CarriesLargeMessagesWhole) {
  const Participant participant(domain());
  Writer<Image> writer(participant, "/depth", {.reliable = true});
  Reader<Image> reader(participant, "/depth", {.reliable = true});
  Image sent;
  sent.width = 640;
  sent.data.resize(1'000'001);
  for (std::size_t i = 0; i < sent.data.size(); ++i)
    sent.data[i] = static_cast<std::uint8_t>(i * 7);
  ASSERT_TRUE(soon([&] { return writer.readers() == 1 && reader.writers() == 1; }));
  ASSERT_TRUE(writer.write(sent));
  Image received;
  ASSERT_TRUE(soon([&] { return reader.take(received); }));
  EXPECT_EQ(received.data, sent.data);
  EXPECT_FALSE(reader.take(received));
}

TEST(Endpoint, GivesLateReadersWhatStays) {
  const Participant participant(domain());
  const Quality stays{.reliable = true, .depth = 1, .stays = true};
  Writer<PoseStamped> writer(participant, "/early", stays);
  PoseStamped pose;
  pose.pose.position.x = 5;
  writer.write(pose);
  Reader<PoseStamped> reader(participant, "/early", stays);
  PoseStamped received;
  ASSERT_TRUE(soon([&] { return reader.take(received); }));
  EXPECT_EQ(received.pose.position.x, 5);
}

TEST(Endpoint, WaitsForNothingWhileAMessageWaits) {
  const Participant participant(domain());
  Writer<PoseStamped> writer(participant, "/pose", {.reliable = true, .depth = 2});
  Reader<PoseStamped> reader(participant, "/pose", {.reliable = true, .depth = 2});
  ASSERT_TRUE(soon([&] { return writer.readers() == 1 && reader.writers() == 1; }));
  writer.write({});
  writer.write({});
  PoseStamped received;
  ASSERT_TRUE(soon([&] { return reader.take(received); }));
  ASSERT_TRUE(reader.wait(10));
  ASSERT_TRUE(reader.take(received));
  EXPECT_FALSE(reader.wait(0));
}

TEST(Endpoint, DoesNotHearAnotherTypeUnderItsName) {
  const Participant participant(domain());
  Writer<Image> writer(participant, "/mixed", {.reliable = true});
  Reader<PoseStamped> reader(participant, "/mixed", {.reliable = true});
  Reader<Image> right(participant, "/mixed", {.reliable = true});
  ASSERT_TRUE(soon([&] { return right.writers() == 1; }));
  EXPECT_EQ(reader.writers(), 0U);
}

TEST(Endpoint, SaysThatAMessageIsDamagedAndGoesOn) {
  const Participant participant(domain());
  RawWriter writer(participant, {"/pose", PoseStamped::kName, PoseStamped::kHash},
                   {.reliable = true, .depth = 10});
  Reader<PoseStamped> reader(participant, "/pose", {.reliable = true, .depth = 10});
  ASSERT_TRUE(soon([&] { return writer.readers() == 1 && reader.writers() == 1; }));
  const std::vector<std::vector<std::uint8_t>> damaged = {
      {0, 1, 0, 0},
      {0, 9, 0, 0, 1, 2, 3, 4},
      {0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff}};
  for (const auto& bytes : damaged) writer.write(bytes);
  std::vector<std::uint8_t> good;
  encode(PoseStamped{}, good);
  writer.write(good);
  PoseStamped received;
  int refused = 0;
  ASSERT_TRUE(soon([&] {
    try {
      return reader.take(received);
    } catch (const Error&) {
      ++refused;
      return false;
    }
  }));
  EXPECT_EQ(refused, 3);
}

TEST(Endpoint, RefusesNamesThatAreNoTopics) {
  const Participant participant(domain());
  for (const char* name : {"", "/", "depth", "/depth/", "/a//b", "/de pth", "/depth\n"}) {
    EXPECT_THAT([&] { const Writer<Image> writer(participant, name, {}); },
                testing::ThrowsMessage<Error>(testing::HasSubstr("topic")))
        << name;
  }
}

TEST(Discovery, FindsWhoWritesAndReads) {
  const Participant participant(domain());
  const Writer<Image> writer(participant, "/depth/image", {.reliable = true, .stays = true});
  const Reader<Image> reader(participant, "/depth/image", {});
  std::vector<Endpoint> found;
  ASSERT_TRUE(soon([&] {
    found = endpoints(participant);
    return found.size() == 2;
  }));
  const auto writes = std::ranges::find(found, true, &Endpoint::writes);
  ASSERT_NE(writes, found.end());
  EXPECT_EQ(writes->topic, "/depth/image");
  EXPECT_EQ(writes->type, "sensor_msgs/Image");
  EXPECT_EQ(writes->hash, std::string("RIHS01_") + Image::kHash);
  EXPECT_TRUE(writes->reliable);
  EXPECT_TRUE(writes->stays);
}

}  // namespace
}  // namespace palpate::dds
