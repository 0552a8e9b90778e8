#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "device/remote_protocol.hpp"

namespace palpate::test {

inline SocketAddress address(const char* name) {
  SocketAddress result;
  result.size = std::strlen(name) + 1;
  std::memcpy(result.path.data(), name, result.size);
  return result;
}

inline const SocketAddress kClient = address("/run/one");
inline const SocketAddress kOther = address("/run/other");

/// A client and a remote device at an hour of a clock, without a socket.
class RemoteProtocolTest : public testing::Test {
 protected:
  // The client's next good packet, with the hand at x.
  PacketFlaw say(double x, const SocketAddress& from = kClient) {
    packet_.sequence += 1;
    packet_.stamp += 1e-3;
    packet_.position.x() = x;
    return repeat(from);
  }
  PacketFlaw repeat(const SocketAddress& from = kClient) {
    return link_.receive(encode(packet_), from, now_);
  }
  // A step without anything to hear.
  DeviceState step(double dt = 1e-3) {
    now_ += dt;
    return link_.state(now_);
  }
  // Good packets for a time; the last state.
  DeviceState talk(double duration) {
    DeviceState state;
    for (const double end = now_ + duration; now_ < end;) {
      EXPECT_EQ(say(0.01), PacketFlaw::none);
      state = step();
    }
    return state;
  }
  double felt(double force = 100) {
    const auto packet = link_.answer({.force = {0, 0, force}});
    return packet ? packet->force.z() : -1;
  }

  RemoteDeviceOptions options_{.path = "none", .maximum_force = 5};
  RemoteProtocol link_{options_};
  StatePacket packet_;
  double now_ = 1000;
};

}  // namespace palpate::test
