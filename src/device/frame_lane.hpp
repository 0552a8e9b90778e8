#pragma once

#include <atomic>
#include <cstdint>

namespace palpate::device {

/// Whether the frames of one device may speak to a library. A frame speaks between enter() and
/// leave(); once the lane is over, none enters any more. It can stand still for a turn of a
/// FrameGate. Nothing here waits or locks.
class FrameLane {
 public:
  // The thread that makes the frames.
  /// False: the lane is over.
  bool enter() noexcept { return change(Phase::free, Phase::speaking); }
  void leave() noexcept { change(Phase::speaking, Phase::free); }
  /// Tells that no frame speaks in this turn of the gate any more.
  void stand(std::uint64_t turn) noexcept { stood_ = turn; }

  // Any thread.
  /// Lets it be over, unless a frame speaks now. True: it is, and none speaks.
  bool give_up() noexcept { return change(Phase::free, Phase::over) || is_over(); }
  /// Lets it be over, whoever speaks.
  void end() noexcept { phase_ = Phase::over; }
  [[nodiscard]] bool is_over() const noexcept { return phase_ == Phase::over; }
  [[nodiscard]] bool stands(std::uint64_t turn) const noexcept { return stood_ == turn; }

 private:
  enum class Phase { free, speaking, over };
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

  bool change(Phase from, Phase to) noexcept { return phase_.compare_exchange_strong(from, to); }

  std::atomic<Phase> phase_{Phase::free};
  std::atomic<std::uint64_t> stood_{kNever};
};

}  // namespace palpate::device
