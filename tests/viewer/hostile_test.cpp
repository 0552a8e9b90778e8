// What those who connect may do wrong costs nobody else anything.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "support/effort.hpp"
#include "viewer/bytes.hpp"
#include "viewer/viewer_rig.hpp"

namespace palpate {
namespace {

using test::Frame;
using test::RawClient;
using test::ViewerRig;

std::size_t descriptors() {
  const std::filesystem::directory_iterator open("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(open), end(open)));
}

std::size_t threads() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return static_cast<std::size_t>(std::distance(begin(tasks), end(tasks)));
}

// The system may show a thread a little longer than it is there.
void expect_threads(std::size_t count) {
  for (int i = 0; i < 500 && threads() != count; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(threads(), count);
}

void expect_served(RawClient& client) {
  client.send_text(R"({"type":"ping","id":5})");
  EXPECT_EQ(client.receive_json("pong")["id"], 5);
  for (int i = 0; i < 3; ++i) client.receive_until([](const Frame& f) { return f.binary(1); });
}

TEST(HostileClient, WhatCannotBeReadIsRefusedAndCountedAndThenClosed) {
  ViewerRig rig;
  auto good = rig.enter();
  auto client = rig.enter();
  client->send_text("{\"type\":");
  EXPECT_FALSE(client->receive_json("refused")["text"].get<std::string>().empty());
  client->send_frame(2, std::string("\0\1\2", 3));
  client->receive_json("refused");
  rig.wait([](const Viewer::Counts& counts) { return counts.refused == 2; });
  for (int i = 0; i < 18; ++i) client->send_text("nonsense");
  EXPECT_EQ(client->receive_close(), 1008);
  expect_served(*good);
}

TEST(HostileClient, AMessageBeforeHelloIsRefused) {
  ViewerRig rig;
  auto client = rig.connect();
  client->send_text(R"({"type":"pause","on":true})");
  client->receive_json("refused");
  rig.press(0.03);
  EXPECT_FALSE(rig.servo->state().paused);
}

TEST(HostileClient, WhoSaysNoHelloInTimeIsClosed) {
  ViewerOptions options;
  options.limits.hello_time = 0.2;
  ViewerRig rig(options);
  auto client = rig.connect();
  EXPECT_EQ(client->receive_close(), 1013);
}

TEST(HostileClient, AFrameThatAnnouncesAGigabyteIsClosedBeforeItComes) {
  ViewerRig rig;
  auto good = rig.enter();
  auto client = rig.enter();
  client->send(std::string("\x81\xff\0\0\0\0\x40\0\0\0\1\2\3\4", 14));
  EXPECT_EQ(client->receive_close(), 1009);
  auto longer = rig.enter();
  longer->send_frame(1, std::string(65 * 1024, ' '));
  EXPECT_EQ(longer->receive_close(), 1009);
  expect_served(*good);
}

TEST(HostileClient, ARequestWithAnEndlessHeaderIsClosed) {
  ViewerRig rig;
  auto good = rig.enter();
  RawClient client(rig.viewer->port());
  client.send("GET / HTTP/1.1\r\nHost: " + rig.host() + "\r\nX: ");
  client.flood(std::string(1024 * 1024, 'a'));
  EXPECT_TRUE(client.ends());
  expect_served(*good);
}

TEST(HostileClient, ARequestThatNeverEndsIsClosedInTime) {
  ViewerOptions options;
  options.limits.header_time = 0.3;
  ViewerRig rig(options);
  auto good = rig.enter();
  RawClient slow(rig.viewer->port());
  RawClient silent(rig.viewer->port());
  slow.send("GET / HTTP/1.1\r\nHo");
  EXPECT_TRUE(slow.ends());
  EXPECT_TRUE(silent.ends());
  expect_served(*good);
}

TEST(HostileClient, GarbageInsteadOfHttpIsClosed) {
  ViewerRig rig;
  RawClient client(rig.viewer->port());
  client.send(std::string("\x16\x03\x01\0\x05 hello\r\n\r\n", 15));
  EXPECT_TRUE(client.ends());
}

TEST(HostileClient, TheNinthIsRefusedWithWordsAndThereIsRoomAgainAfterwards) {
  ViewerRig rig;
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 8; ++i) clients.push_back(rig.enter());
  auto ninth = rig.connect();
  ninth->send_text(R"({"type":"hello","token":"secret","points":10})");
  EXPECT_FALSE(ninth->receive_json("refused")["text"].get<std::string>().empty());
  EXPECT_EQ(ninth->receive_close(), 1013);
  clients.pop_back();
  rig.wait([](const Viewer::Counts& counts) { return counts.clients == 7; });
  expect_served(*rig.enter());
}

TEST(HostileClient, MoreConnectionsThanThereMayBeAreClosedAtOnce) {
  ViewerOptions options;
  options.limits.connections = 4;
  ViewerRig rig(options);
  auto good = rig.enter();
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 3; ++i) idle.push_back(std::make_unique<RawClient>(rig.viewer->port()));
  rig.wait([](const Viewer::Counts& counts) { return counts.connections == 4; });
  RawClient late(rig.viewer->port());
  EXPECT_TRUE(late.ends());
  rig.wait([](const Viewer::Counts& counts) { return counts.turned_away == 1; });
  expect_served(*good);
}

TEST(HostileClient, WhoNeverReadsIsClosedAndCostsOthersNothing) {
  ViewerOptions options;
  options.limits.silence = 0.3;
  ViewerRig rig(options);
  auto good = rig.enter();
  auto deaf = rig.enter();
  double time = 0.02;
  while (rig.viewer->counts().closed_silent == 0) {
    for (int i = 0; i < 1000; ++i) rig.servo->tick(time += 1e-6);  // many forces make long messages
    good->receive_until([](const Frame& f) { return f.binary(1); });
  }
  expect_served(*good);
  rig.wait([](const Viewer::Counts& counts) { return counts.clients == 1; });
}

TEST(HostileClient, FloodsOfMessagesAndPingsAreClosed) {
  ViewerRig rig;
  auto good = rig.enter();
  auto talker = rig.enter();
  std::string frames;
  for (int i = 0; i < 1000; ++i) frames += std::string("\x81\x82\0\0\0\0{}", 8);
  talker->flood(frames);
  talker->receive_close();
  auto pinger = rig.enter();
  frames.clear();
  for (int i = 0; i < 1000; ++i) frames += std::string("\x89\x80\0\0\0\0", 6);
  pinger->flood(frames);
  pinger->receive_close();
  rig.wait([](const Viewer::Counts& counts) { return counts.clients == 1; });
  expect_served(*good);
}

// One connection after another, of every kind, left in every state.
void connect_and_leave(ViewerRig& rig, int i) {
  RawClient client(rig.viewer->port());
  if (i % 4 == 0) return;
  if (i % 4 == 1) {
    client.send("GET / HTTP/1.1\r\nHost: " + rig.host() + "\r\nConnection: close\r\n\r\n");
    client.read_body(client.read_header());
    return;
  }
  client.upgrade(rig.host());
  if (i % 4 == 2) return;
  client.send_text(R"({"type":"hello","token":"secret","points":10})");
  client.receive_json("welcome");
}

void expect_nothing_left(int connections) {
  ViewerRig rig;
  for (int i = 0; i < 8; ++i) connect_and_leave(rig, i);
  rig.wait(
      [](const Viewer::Counts& counts) { return counts.connections == 0 && counts.accepted == 8; });
  const std::size_t open_before = descriptors();
  const std::size_t threads_before = threads();
  for (int i = 0; i < connections; ++i) {
    connect_and_leave(rig, i);
    if (i % 16 == 0) rig.wait([](const Viewer::Counts& counts) { return counts.connections < 32; });
  }
  rig.wait([&](const Viewer::Counts& counts) {
    return counts.connections == 0 &&
           counts.accepted == static_cast<std::uint64_t>(connections) + 8;
  });
  EXPECT_EQ(rig.viewer->counts().turned_away, 0u);
  EXPECT_EQ(descriptors(), open_before);
  EXPECT_EQ(threads(), threads_before);
  expect_served(*rig.enter());
}

TEST(HostileClient, HundredsOfConnectionsOneAfterAnotherLeaveNothingBehind) {
  expect_nothing_left(test::effort(400));
}

TEST(HostileClient, TenThousandConnectionsOneAfterAnotherLeaveNothingBehind) {
  if (test::effort(10) < 100) GTEST_SKIP() << "long; set PALPATE_TEST_EFFORT to 10 or more";
  expect_nothing_left(10'000);
}

// The program ends while a client's last messages and its close frame are there to be read: the two
// sides' closes must not wait for each other.
TEST(HostileClient, AViewerGoesWhileAClientCloses) {
  std::promise<void> paused;
  std::promise<void> ending;
  ViewerControls controls;
  controls.pause = [&](bool) {
    paused.set_value();
    ending.get_future().wait();
  };
  const std::size_t before = threads();
  ViewerRig rig({}, controls);
  auto client = rig.enter();
  client->send(test::client_frame(1, R"({"type":"pause","on":true})") +
               test::client_frame(1, R"({"type":"ping","id":5})") +
               test::client_frame(8, "\x03\xe9"));
  paused.get_future().wait();
  {
    const std::jthread end([&] { rig.viewer.reset(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // it asks for the end meanwhile
    ending.set_value();
  }
  EXPECT_TRUE(client->ends());
  expect_threads(before);
}

TEST(HostileClient, AViewerGoesWhileClientsAreThere) {
  const std::size_t before = threads();
  {
    ViewerRig rig;
    auto one = rig.enter();
    auto other = rig.connect();
    RawClient idle(rig.viewer->port());
  }
  expect_threads(before);
}

}  // namespace
}  // namespace palpate
