#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "device/frame_lane.hpp"

namespace palpate::device {

/// Keeps the frames of all devices still while somebody else speaks to a library that knows one
/// device at a time.
///
/// Whoever makes frames looks at the gate before each one: where it is closed, they bring their
/// device to rest, have their lane stand in this turn, and make none until the next turn. The gate
/// never makes them wait; it waits for them.
class FrameGate {
 public:
  /// The gate is closed as long as this lives. One at a time.
  class Stillness {
   public:
    /// Waits for all lanes to stand still or to be over, no longer than `patience` (s).
    Stillness(FrameGate& gate, double patience) : gate_(gate), all_(gate.close(patience)) {}
    ~Stillness() { ++gate_.turn_; }
    Stillness(const Stillness&) = delete;
    Stillness& operator=(const Stillness&) = delete;

    /// False: somebody did not stand still in time.
    [[nodiscard]] bool all() const noexcept { return all_; }

   private:
    FrameGate& gate_;
    bool all_;
  };

  // One thread at a time.
  /// From the next closing on `lane` is waited for, until it is over.
  void add(std::shared_ptr<const FrameLane> lane) { lanes_.push_back(std::move(lane)); }
  /// Is there a lane that is not over?
  [[nodiscard]] bool is_used() const;

  // Any thread; lock-free.
  /// Grows whenever the gate opens or closes.
  [[nodiscard]] std::uint64_t turn() const noexcept { return turn_; }
  [[nodiscard]] static bool is_closed(std::uint64_t turn) noexcept { return turn % 2 != 0; }

 private:
  bool close(double patience);

  std::vector<std::shared_ptr<const FrameLane>> lanes_;
  std::atomic<std::uint64_t> turn_{0};
};

}  // namespace palpate::device
