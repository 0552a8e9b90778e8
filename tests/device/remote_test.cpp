// RemoteDevice over real sockets, with a clock that the tests hold.
#include "palpate/device/remote.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "device/datagram_socket.hpp"
#include "device/hand_clock.hpp"
#include "device/remote_client.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::HandClock;
using test::RemoteClient;

class RemoteDeviceTest : public testing::Test {
 protected:
  [[nodiscard]] RemoteDeviceOptions options() const { return {.path = folder_ / "device"}; }

  DeviceState step(RemoteDevice& device, double force = 0) {
    clock_.time += 1e-3;
    const DeviceState state = device.read();
    device.write({0, 0, force});
    return state;
  }
  // Good packets and steps for a second: the full force may flow.
  void talk(RemoteDevice& device, RemoteClient& client, double force = 0) {
    for (int i = 0; i < 1000; ++i) {
      ASSERT_TRUE(client.say(0.01));
      step(device, force);
      static_cast<void>(client.hear());
    }
  }

  test::Folder folder_;
  HandClock clock_;
};

TEST_F(RemoteDeviceTest, TellsWhereTheClientsHandIsAndTheClientTheForce) {
  RemoteDevice device(clock_, options());
  EXPECT_FALSE(device.info().keeps_time);
  EXPECT_EQ(device.info().maximum_force, 5);
  EXPECT_EQ(step(device).status, DeviceState::Status::silent);
  EXPECT_NE(device.reason().find(options().path), std::string::npos) << device.reason();
  RemoteClient client(device.path(), folder_ / "client");
  talk(device, client);
  client.packet().buttons = 3;
  client.say(0.02);
  const DeviceState state = step(device, -1.5);
  EXPECT_EQ(state.status, DeviceState::Status::ok);
  EXPECT_EQ(state.position, Vector3d(0, 0, 0.02));
  EXPECT_EQ(state.buttons, 3u);
  EXPECT_EQ(state.time, clock_.time);
  EXPECT_EQ(device.reason(), "");
  const auto heard = client.hear();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->z, -1.5);
  EXPECT_EQ(heard->flags, 1u);
  EXPECT_EQ(device.counts().taken, 1001u);
}

TEST_F(RemoteDeviceTest, TellsAClientThatTurnsTheTorque) {
  RemoteDeviceOptions turning = options();
  turning.maximum_torque = 0.3;
  turning.turns = true;
  RemoteDevice device(clock_, turning);
  EXPECT_TRUE(device.info().has_orientation);
  EXPECT_EQ(device.info().maximum_torque, 0.3);
  RemoteClient client(device.path(), folder_ / "client");
  client.packet().version = RemoteVersion::kTurns;
  client.packet().turns.renders_torque = true;
  client.packet().turns.orientation = Eigen::AngleAxisd(0.4, Vector3d::UnitX());
  talk(device, client);
  client.say(0.02);
  clock_.time += 1e-3;
  EXPECT_NEAR(device.read().orientation.angularDistance(client.packet().turns.orientation), 0,
              1e-12);
  device.write_wrench({{0, 0, -1.5}, {0, 0, 0.25}, 0});
  const auto heard = client.hear();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->z, -1.5);
  EXPECT_EQ(heard->torque, Vector3d(0, 0, 0.25));
  device.write_wrench({.torque = {0, std::numeric_limits<double>::quiet_NaN(), 0}});
  EXPECT_EQ(device.read().status, DeviceState::Status::failed);
}

TEST_F(RemoteDeviceTest, TakesTheNewestOfWhatWaitsAndABoundedNumber) {
  RemoteDevice device(clock_, options());
  RemoteClient client(device.path(), folder_ / "client");
  int sent = 0;
  while (sent < 300 && client.say(1e-3 * sent)) ++sent;  // until its queue is full
  ASSERT_GT(sent, 5);
  const int taken = std::min(sent, RemoteDevice::kMostPackets);
  EXPECT_EQ(step(device).position.z(), 1e-3 * (taken - 1));
  EXPECT_EQ(device.counts().received, static_cast<std::uint64_t>(taken));
}

TEST_F(RemoteDeviceTest, CountsWhatItRefusesAndSaysWhy) {
  RemoteDevice device(clock_, options());
  RemoteClient client(device.path(), folder_ / "client");
  RemoteClient nameless(device.path(), "");
  const std::vector<std::byte> junk(1000, std::byte{7});
  const auto expect_refusal = [&](PacketFlaw flaw) {
    step(device);
    const std::string words(explain(flaw));
    EXPECT_NE(device.reason().find(words), std::string::npos) << device.reason();
  };
  client.send(std::span(junk).first(0));
  expect_refusal(PacketFlaw::length);
  client.send(std::span(junk).first(80));
  expect_refusal(PacketFlaw::magic);
  client.send(junk);
  expect_refusal(PacketFlaw::length);
  client.packet().position.x() = std::nan("");
  client.say(0);
  expect_refusal(PacketFlaw::number);
  client.packet().position.x() = 1e6;
  client.say(0);
  expect_refusal(PacketFlaw::range);
  client.packet().position.x() = 0;
  nameless.say(0);
  expect_refusal(PacketFlaw::no_address);
  EXPECT_EQ(device.counts().received, 6u);
  EXPECT_EQ(device.counts().taken, 0u);
  EXPECT_EQ(step(device).status, DeviceState::Status::silent);
}

TEST_F(RemoteDeviceTest, SilenceIsToldAndNoForceComesAndItComesBack) {
  RemoteDevice device(clock_, options());
  RemoteClient client(device.path(), folder_ / "client");
  talk(device, client, 4);
  double felt = 4;
  DeviceState state;
  for (int i = 0; i < 200; ++i) {
    state = step(device, 4);
    if (const auto heard = client.hear()) felt = heard->z;
  }
  EXPECT_EQ(state.status, DeviceState::Status::silent);
  EXPECT_EQ(felt, 0);
  for (int i = 0; i < 3; ++i) {
    client.say(0.01);
    step(device, 4);
  }
  EXPECT_EQ(step(device, 4).status, DeviceState::Status::ok);
  EXPECT_LT(client.hear()->z, 0.1) << "a soft start";
}

TEST_F(RemoteDeviceTest, AClientThatIsGoneIsSilentAndNoFailure) {
  RemoteDevice device(clock_, options());
  {
    RemoteClient client(device.path(), folder_ / "client");
    talk(device, client);
  }
  for (int i = 0; i < 300; ++i) ASSERT_NE(step(device, 1).status, DeviceState::Status::failed);
  EXPECT_GT(device.counts().unsent, 0u);
  RemoteClient next(device.path(), folder_ / "client");
  next.say(0);
  step(device);
  next.say(0);
  EXPECT_EQ(step(device).status, DeviceState::Status::ok);
}

TEST_F(RemoteDeviceTest, ForcesThatAreNotFiniteLatchAndTheClientIsToldSo) {
  RemoteDevice device(clock_, options());
  RemoteClient client(device.path(), folder_ / "client");
  talk(device, client);
  client.say(0.01);
  step(device, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(step(device).status, DeviceState::Status::failed);
  EXPECT_NE(device.reason().find("not finite"), std::string::npos) << device.reason();
  const auto heard = client.hear();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->z, 0);
  EXPECT_EQ(heard->flags, 2u);
}

TEST_F(RemoteDeviceTest, SaysGoodbyeAndLeavesNoFile) {
  RemoteClient client(folder_ / "device", folder_ / "client");
  {
    RemoteDevice device(clock_, options());
    talk(device, client, 1);
    client.say(0.01);
    step(device, 1);
    static_cast<void>(client.hear());
  }
  const auto heard = client.hear();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->z, 0);
  EXPECT_EQ(heard->flags, 2u);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "device"));
}

TEST_F(RemoteDeviceTest, OnlyItsOwnerMayOpenIt) {
  const mode_t before = ::umask(0);
  const RemoteDevice device(clock_, options());
  ::umask(before);
  struct stat file {};
  ASSERT_EQ(::stat(options().path.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 0777, 0600u);
}

// A socket's file without a program behind it, as a crash leaves it.
void leave_socket(const std::string& path) {
  const int handle = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  const sockaddr_un address = test::socket_address(path);
  static_cast<void>(::bind(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  ::close(handle);
}

TEST_F(RemoteDeviceTest, TakesThePlaceOfASocketThatNobodyListensTo) {
  leave_socket(folder_ / "device");
  ASSERT_TRUE(std::filesystem::exists(folder_ / "device"));
  RemoteDevice device(clock_, options());
  RemoteClient client(device.path(), folder_ / "client");
  client.say(0);
  step(device);
  EXPECT_EQ(device.counts().taken, 1u);
}

std::string complaint(const Clock& clock, const RemoteDeviceOptions& options) {
  try {
    const RemoteDevice device(clock, options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST_F(RemoteDeviceTest, LooksWhetherAPlaceIsFreeAndTakesItInItsTurn) {
  leave_socket(options().path);
  const int folder = ::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(folder, LOCK_EX), 0);  // as another program that is at it, for good
  EXPECT_NE(complaint(clock_, options()).find("keeps its folder locked"), std::string::npos);
  ::close(folder);
  EXPECT_NO_THROW(const RemoteDevice device(clock_, options()));
}

TEST_F(RemoteDeviceTest, RefusesPathsThatAreTakenOrNoSockets) {
  const RemoteDevice device(clock_, options());
  EXPECT_NE(complaint(clock_, options()).find("another program"), std::string::npos);
  std::ofstream(folder_ / "letter") << "do not lose me";
  EXPECT_NE(complaint(clock_, {.path = folder_ / "letter"}).find("not a socket"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "letter"));
  EXPECT_NE(complaint(clock_, {.path = folder_ / "absent/device"}).find("folder"),
            std::string::npos);
  EXPECT_NE(complaint(clock_, {.path = std::string(200, 'x')}).find("characters"),
            std::string::npos);
}

TEST_F(RemoteDeviceTest, RefusesOptionsOutOfRange) {
  const auto with = [this](auto change) {
    RemoteDeviceOptions changed = options();
    change(changed);
    return complaint(clock_, changed);
  };
  EXPECT_NE(with([](auto& o) { o.maximum_force = 0; }), "");
  EXPECT_NE(with([](auto& o) { o.rate = std::nan(""); }), "");
  EXPECT_NE(with([](auto& o) { o.client_timeout = 0; }), "");
  EXPECT_NE(with([](auto& o) { o.fade = -1; }), "");
  EXPECT_NE(with([](auto& o) { o.soft_start = 0; }), "");
  EXPECT_EQ(with([](auto&) {}), "");
}

TEST_F(RemoteDeviceTest, OthersMayLookAtItWhileItSteps) {
  RemoteDevice device(clock_, options());
  RemoteClient client(device.path(), folder_ / "client");
  std::jthread watcher([&](const std::stop_token& stop) {
    std::uint64_t last = 0;
    do {
      const RemoteDevice::Counts counts = device.counts();
      EXPECT_GE(counts.taken, last);
      last = counts.taken;
      static_cast<void>(device.reason());
    } while (!stop.stop_requested());
  });
  talk(device, client);
  EXPECT_GT(device.counts().taken, 0u);
}

}  // namespace
}  // namespace palpate
