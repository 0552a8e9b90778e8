#pragma once

#include <array>
#include <atomic>

#include "device/openhaptics_codes.hpp"
#include "device/openhaptics_library.hpp"

namespace palpate::device {

/// The library keeps the errors of all devices in one list. Here each is filed under the device
/// that it belongs to, so that none takes another's. One that names a device that was never here is
/// the asker's; one of a device that is closed is dropped. Of each device one is kept, the first
/// that is found, until it is taken. Any thread; lock-free, and bounded work.
class OpenHapticsErrors {
 public:
  static constexpr int kDevices = 16;  ///< at once

  /// A device that is new, or opened again: nothing is filed yet. False: there are kDevices. One
  /// thread at a time.
  bool open(OpenHapticsLibrary::Device device) noexcept;
  void close(OpenHapticsLibrary::Device device) noexcept;

  /// Files what the library keeps, and takes what is filed under `asker`: a code, or hd::kSuccess.
  unsigned take(const OpenHapticsLibrary& library, OpenHapticsLibrary::Device asker) noexcept;

 private:
  struct File {
    std::atomic<OpenHapticsLibrary::Device> device{hd::kNoDevice};
    std::atomic<bool> is_open{false};
    std::atomic<unsigned> code{0};
  };

  File* find(OpenHapticsLibrary::Device device) noexcept;
  File* find_free() noexcept;
  void keep(const OpenHapticsLibrary::Failure& failure, OpenHapticsLibrary::Device asker) noexcept;

  std::array<File, kDevices> files_;
};

}  // namespace palpate::device
