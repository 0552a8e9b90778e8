#pragma once

#include <string>

#include "device/openhaptics_library.hpp"

namespace palpate::device {

/// A device that OpenHaptics has opened, and its scheduler, which is one for all of a program's
/// devices: it runs from the first that asks for it to the last that goes. Any thread.
class OpenHapticsSession {
 public:
  /// `configuration`: the device's name in the maker's set-up.
  /// @throws Error that says why it does not open.
  OpenHapticsSession(const OpenHapticsLibrary& library, const std::string& configuration);
  /// Callbacks are to be over.
  ~OpenHapticsSession();
  OpenHapticsSession(const OpenHapticsSession&) = delete;
  OpenHapticsSession& operator=(const OpenHapticsSession&) = delete;

  [[nodiscard]] OpenHapticsLibrary::Device device() const noexcept { return device_; }

  /// Has `callback` called in every tick, until it answers hd::kDone.
  /// @throws Error when the scheduler does not take it.
  void schedule(OpenHapticsLibrary::Callback* callback, void* data);
  /// Lets the scheduler run. Once.
  /// @throws Error when it does not start.
  void start();

 private:
  void check(const std::string& what) const;

  OpenHapticsLibrary library_;
  std::string name_;
  OpenHapticsLibrary::Device device_;
  bool runs_ = false;
};

}  // namespace palpate::device
