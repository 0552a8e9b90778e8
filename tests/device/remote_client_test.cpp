// The clients of examples/ at a real RemoteDevice in real time, against a wall at z = 0.
#include "device/remote_client.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "palpate/device/remote.hpp"

namespace palpate {
namespace {

constexpr double kStiffness = 500;  // N/m
constexpr double kDepth = 5e-3;     // that the clients go into the wall, m

constexpr double kLever = 0.01;  // of the torque, m

struct Session {
  int states = 0;
  double deepest = 0;   // m
  double largest = 0;   // N, that was written
  std::string printed;  // by the client
  int status = -1;      // of its end
};

// A step; the force is that of the wall.
DeviceState serve(RemoteDevice& device, Session& session) {
  const DeviceState state = device.read();
  const bool felt = state.status == DeviceState::Status::ok;
  const double force = felt ? -kStiffness * std::min(0.0, state.position.z()) : 0;
  device.write_wrench({.force = {0, 0, force}, .torque = {0, kLever * force, 0}});
  session.states += felt ? 1 : 0;
  session.deepest = std::min(session.deepest, state.position.z());
  session.largest = std::max(session.largest, force);
  std::this_thread::sleep_for(std::chrono::microseconds(500));
  return state;
}

Session run(const std::string& program) {
  const test::Folder folder;
  const SteadyClock clock;
  // However busy the machine is: no silence, and no start so soft that it hides the wall.
  RemoteDevice device(
      clock,
      {.path = folder / "device", .maximum_torque = 1, .client_timeout = 60, .soft_start = 1e-3});
  Session session;
  std::jthread server([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) serve(device, session);
  });
  const std::string command = program + " " + device.path() + " 1.5";
  if (FILE* pipe = ::popen(command.c_str(), "r"); pipe != nullptr) {
    std::array<char, 200> line{};
    while (std::fgets(line.data(), line.size(), pipe) != nullptr) session.printed += line.data();
    session.status = ::pclose(pipe);
  }
  server.request_stop();
  server.join();
  EXPECT_EQ(device.counts().received, device.counts().taken) << device.reason();
  return session;
}

void check(const Session& session) {
  SCOPED_TRACE(session.printed);
  EXPECT_EQ(session.status, 0);
  EXPECT_GT(session.states, 20);
  EXPECT_LT(session.deepest, -0.5 * kDepth);
  EXPECT_GE(session.deepest, -kDepth);
  unsigned long long states = 0;
  unsigned long long forces = 0;
  double largest = 0;
  ASSERT_EQ(std::sscanf(session.printed.c_str(), "%llu states, %llu forces, largest %lf N", &states,
                        &forces, &largest),
            3);
  EXPECT_GT(states, 20u);
  EXPECT_GT(forces, 20u);
  EXPECT_GT(largest, 0.5 * session.largest);
  EXPECT_LE(largest, session.largest + 1e-3);
}

TEST(RemoteDeviceClient, InCIsADevice) {
  const std::string program = PALPATE_CLIENT_C;
  if (program.empty()) GTEST_SKIP() << "the examples are not built";
  check(run(program));
}

TEST(RemoteDeviceClient, InPythonIsADevice) {
  const std::string program = PALPATE_CLIENT_PYTHON;
  if (program.empty()) GTEST_SKIP() << "there is no python3";
  const Session session = run(program);
  check(session);
  double force = 0;
  double torque = 0;
  const auto at = session.printed.find("largest");
  ASSERT_NE(at, std::string::npos) << session.printed;
  ASSERT_EQ(std::sscanf(&session.printed[at], "largest %lf N, %lf N m", &force, &torque), 2);
  EXPECT_NEAR(torque, kLever * force, 1e-4) << "it has a wrist";
}

}  // namespace
}  // namespace palpate
