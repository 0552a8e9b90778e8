#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/geometry/shapes.hpp"
#include "palpate/scene/source.hpp"
#include "scene/handoff.hpp"

namespace palpate {

/// Where a tool can be before the next frames: around hand and proxy. World frame. Fields publish
/// it, preparation clips to it and runs the costly fit in it.
using Reach = Ball;

/// Where fields write their reach, each in a slot of its own, and preparation reads it. Without
/// locks: a version that is odd while a position is being written makes readers look again.
class ReachTable {
 public:
  static constexpr std::size_t kSlots = Handoff<Snapshot>::kReaders;  // one a reader

  ReachTable() {
    for (std::size_t i = 0; i < kSlots; ++i) clear(i);
  }

  /// One thread a slot. Wait-free.
  void write(std::size_t slot, const Reach& reach) noexcept;

  /// The position is not valid from now on.
  void clear(std::size_t slot) noexcept { write(slot, {Eigen::Vector3d::Zero(), -1}); }

  /// Replaces `found` by all that is valid. Not real-time; allocates only to grow. A slot that is
  /// written faster than it can be read is left out.
  void read(std::vector<Reach>& found) const;

 private:
  static constexpr std::size_t kCacheLine = 64;  // bytes, on x86-64 and most Arm cores

  struct alignas(kCacheLine) Slot {
    std::atomic<std::uint32_t> version{0};
    std::array<std::atomic<double>, 4> values{};  // center, radius
  };

  std::array<Slot, kSlots> slots_;
};

/// Foresees where a tool can be until the next frames have become a surface. Real-time.
class ToolReach {
 public:
  /// `scale`: metres that the tool goes for one of the hand.
  explicit ToolReach(double scale = 1) : scale_(scale) {}

  /// `now`: s; hip and proxy are finite, m. `frame`: time between frames, s. `margin`: how far
  /// around itself the tool feels, m.
  [[nodiscard]] Reach update(double now, const Eigen::Vector3d& hip, const Eigen::Vector3d& proxy,
                             double frame, double margin) noexcept;

 private:
  double scale_;
  double last_time_ = 0;
  Eigen::Vector3d last_hip_ = Eigen::Vector3d::Zero();
  double speed_ = 0;  // recent, m/s
  bool started_ = false;
};

}  // namespace palpate
