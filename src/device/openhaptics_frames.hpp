#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "device/openhaptics_facts.hpp"
#include "device/openhaptics_library.hpp"
#include "device/wakeup.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/latest.hpp"
#include "palpate/device/device_link.hpp"

namespace palpate::device {

/// What happens in the maker's scheduler, which calls tick() at 1 kHz on a thread of its own: a
/// frame that tells where the hand is and applies the force that was asked for last.
///
/// A tick does constant work; it takes no lock and no memory and waits for nobody but the device.
/// Errors are kept as numbers, for others to put into words. There is no force from the first error
/// on, none where the place is no number, and none that was asked for longer than kSilence ago.
class OpenHapticsFrames {
 public:
  static constexpr double kSilence = 5e-3;  ///< s

  /// What the frame told that took what was asked for last.
  struct Answer {
    LinkReading reading;
    std::uint64_t number = 0;  // of what was asked
    unsigned failure = 0;      // the first error's code
    unsigned calibration = 0;  // hd::kCalibrated and the like
  };

  /// `clock` is read in ticks, too; it outlives this.
  OpenHapticsFrames(const OpenHapticsLibrary& library, OpenHapticsLibrary::Device device,
                    const Clock& clock)
      : library_(library), device_(device), clock_(clock) {}

  // One other thread's.
  /// Asks for a force, N, as the operator sits.
  void ask(const Eigen::Vector3d& force) noexcept;
  /// Waits for the frame that takes what was asked last, no longer than `patience` (s).
  [[nodiscard]] std::optional<Answer> answer(double patience) noexcept;
  /// What the first frame found; not before an answer.
  [[nodiscard]] const OpenHapticsFacts& facts() const noexcept { return facts_; }
  /// The next frame calibrates the device anew.
  void calibrate() noexcept { calibrate_ = true; }
  /// Lets the next tick be the last: a frame without a force. Waits for it, no longer than
  /// `patience` (s); whoever comes later leaves the device alone.
  void end(double patience) noexcept;

  /// One frame; what the scheduler is to know. The scheduler's thread.
  [[nodiscard]] unsigned tick() noexcept;
  /// What the scheduler calls: tick() of a std::shared_ptr<OpenHapticsFrames>, which is deleted
  /// with the last: a scheduler that hangs may come back when everybody else has left.
  static unsigned call(void* frames) noexcept;

 private:
  struct Wanted {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    double time = 0;  // s
    std::uint64_t number = 0;
  };

  void learn() noexcept;
  [[nodiscard]] LinkReading read() const noexcept;
  [[nodiscard]] Eigen::Vector3d permitted(const LinkReading& reading) const noexcept;
  void keep_failure() noexcept;
  void tell(const LinkReading& reading) noexcept;
  unsigned leave() noexcept;

  OpenHapticsLibrary library_;
  OpenHapticsLibrary::Device device_;
  const Clock& clock_;

  // Of the scheduler's thread.
  std::uint64_t frames_ = 0;
  Wanted taken_;
  Answer newest_;
  OpenHapticsFacts facts_;  // does not change after the first frame

  std::uint64_t asked_ = 0;  // of the other thread

  // Between them.
  Latest<Wanted> wanted_;
  Latest<Answer> answers_;
  std::atomic<bool> calibrate_{false};
  std::atomic<bool> leaving_{false};
  std::atomic<bool> left_{false};
  std::atomic<bool> closed_{false};
  Wakeup wakeup_;
};

}  // namespace palpate::device
