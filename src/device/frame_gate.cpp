#include "device/frame_gate.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace palpate::device {
namespace {

constexpr std::chrono::microseconds kNap{200};  // a frame comes each millisecond

}  // namespace

bool FrameGate::is_used() const {
  return !std::ranges::all_of(lanes_, [](const auto& lane) { return lane->is_over(); });
}

bool FrameGate::close(double patience) {
  using std::chrono::steady_clock;
  std::erase_if(lanes_, [](const auto& lane) { return lane->is_over(); });
  const std::uint64_t turn = ++turn_;
  const auto is_still = [turn](const auto& lane) { return lane->stands(turn) || lane->is_over(); };
  const auto start = steady_clock::now();
  while (!std::ranges::all_of(lanes_, is_still)) {
    if (std::chrono::duration<double>(steady_clock::now() - start).count() > patience) return false;
    std::this_thread::sleep_for(kNap);
  }
  return true;
}

}  // namespace palpate::device
