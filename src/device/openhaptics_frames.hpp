#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "device/openhaptics_common.hpp"
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
///
/// While somebody opens or closes a device, the other devices' frames stand still: where the gate
/// is closed, a tick makes one frame without a force, and later ones none until it opens.
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

  /// `clock` is read in ticks, too; it and `common` outlive this.
  OpenHapticsFrames(const OpenHapticsLibrary& library, OpenHapticsLibrary::Device device,
                    const Clock& clock, OpenHapticsCommon& common)
      : library_(library), device_(device), clock_(clock), common_(common) {}

  // One other thread's.
  /// Asks for a force, N, as the operator sits.
  void ask(const Eigen::Vector3d& force) noexcept;
  /// Waits for the frame that takes what was asked last, no longer than `patience` (s) while the
  /// gate is open.
  [[nodiscard]] std::optional<Answer> answer(double patience) noexcept;
  /// What the first frame found; not before an answer.
  [[nodiscard]] const OpenHapticsFacts& facts() const noexcept { return facts_; }
  /// The next frame calibrates the device anew.
  void calibrate() noexcept { calibrate_ = true; }
  /// Lets the next tick be the last: a frame without a force. Waits for it, no longer than
  /// `patience` (s); whoever comes later leaves the device alone. A frame that is under way then is
  /// waited for as long again. Where it hangs even so, nobody can take back the call that it is in;
  /// it makes none after that.
  void end(double patience) noexcept;
  /// Whether frames may come.
  [[nodiscard]] std::shared_ptr<const FrameLane> lane() const noexcept { return lane_; }

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

  void frame() noexcept;
  void rest() noexcept;
  void leave() noexcept;
  bool begin() noexcept;
  void learn() noexcept;
  [[nodiscard]] LinkReading read() const noexcept;
  [[nodiscard]] Eigen::Vector3d permitted(const LinkReading& reading) const noexcept;
  void keep_failure() noexcept;
  void tell(const LinkReading& reading) noexcept;
  bool is_over_within(double patience) noexcept;

  OpenHapticsLibrary library_;
  OpenHapticsLibrary::Device device_;
  const Clock& clock_;
  OpenHapticsCommon& common_;

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
  std::shared_ptr<FrameLane> lane_ = std::make_shared<FrameLane>();
  Wakeup wakeup_;
};

}  // namespace palpate::device
