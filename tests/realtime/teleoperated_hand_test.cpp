// The real-time contract of a simulated device whose hand is guided from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "palpate/device/simulated.hpp"
#include "realtime/watch.hpp"

namespace palpate::realtime {
namespace {

// A watched step of a device against a wall at z = 0.
void step(SimulatedDevice& device) {
  Watch watch;
  const DeviceState state = device.read();
  device.write({0, 0, -500 * std::min(0.0, state.position.z())});
  const Findings found = watch.stop();
  EXPECT_EQ(found.total(), 0) << found << "at " << state.time << " s";
}

TEST(TeleoperatedHandStep, KeepsTheContractWhilePlayingTakenSilentAndReturning) {
  if (!can_trap_system_calls()) {
    GTEST_SKIP() << "this kernel has no Syscall User Dispatch (Linux 5.11 on x86-64)";
  }
  RemoteTarget remote;
  TeleoperatedHand hand(remote, {{0, {0, 0, 0.01}}, {0.1, {0, 0, -0.01}}, {0.2, {0.01, 0, 0.01}}},
                        {.return_after = 0.1});
  SimulatedDevice device({}, hand);
  for (int i = 0; i < 2000; ++i) {
    if (i > 500 && i < 1000 && i % 8 == 0) {
      static_cast<void>(remote.move({{1e-5 * i, 0, -5e-3}, 1}, 1e-3 * i));
    }
    step(device);
  }
}

TEST(TeleoperatedHandStep, KeepsTheContractWhileAnotherThreadSpeaks) {
  if (!can_trap_system_calls()) {
    GTEST_SKIP() << "this kernel has no Syscall User Dispatch (Linux 5.11 on x86-64)";
  }
  RemoteTarget remote;
  TeleoperatedHand hand(remote);
  SimulatedDevice device({}, hand);
  std::jthread others([&](const std::stop_token& stop) {
    for (int i = 0; !stop.stop_requested(); ++i) {
      static_cast<void>(remote.move({{0, 0, 1e-5 * (i % 1000)}, 0}, 1e-3 * i));
      if (i % 100 == 0) remote.release();
    }
  });
  for (int i = 0; i < 2000; ++i) step(device);
}

}  // namespace
}  // namespace palpate::realtime
