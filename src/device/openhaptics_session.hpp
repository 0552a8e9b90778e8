#pragma once

#include <memory>
#include <string>

#include "device/openhaptics_frames.hpp"
#include "device/openhaptics_library.hpp"

namespace palpate::device {

/// A device that OpenHaptics has opened, and its scheduler, which is one for all of a program's
/// devices: it runs from the first that asks for it to the last that goes. Any thread.
///
/// Whoever opens a device makes it the library's current one, whatever a frame is doing: so the
/// frames of all other devices stand still, without a force, while a device is opened, scheduled or
/// closed.
class OpenHapticsSession {
 public:
  static constexpr double kPatience = 0.5;  ///< s for the other devices to stand still
  /// s before a device is opened again while others are held, as that takes their force.
  static constexpr double kPause = 10;

  /// `configuration`: the device's name in the maker's set-up. `now`: s.
  /// @throws Error that says why it does not open.
  OpenHapticsSession(const OpenHapticsLibrary& library, const std::string& configuration,
                     double now);
  /// Callbacks are to be over.
  ~OpenHapticsSession();
  OpenHapticsSession(const OpenHapticsSession&) = delete;
  OpenHapticsSession& operator=(const OpenHapticsSession&) = delete;

  [[nodiscard]] OpenHapticsLibrary::Device device() const noexcept { return device_; }

  /// Has the scheduler make a frame in every tick, until they are over. Once.
  /// @throws Error when it does not start, or takes no callback.
  void run(const std::shared_ptr<OpenHapticsFrames>& frames);

 private:
  void require_pause(double now) const;
  void open(const std::string& configuration);
  void require(bool all_still) const;
  void check(const std::string& what) const;
  [[noreturn]] void fail(const std::string& words) const;

  OpenHapticsLibrary library_;
  std::string name_;
  OpenHapticsLibrary::Device device_;
  bool runs_ = false;
};

}  // namespace palpate::device
