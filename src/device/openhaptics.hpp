#pragma once

#include <string>

#include "device/drivers.hpp"
#include "device/openhaptics_scheduler.hpp"

namespace palpate::device {

/// A Touch or a Phantom of 3D Systems, through the maker's library. An exchange leaves a force for
/// the scheduler's next frame and waits for the result of that frame (OpenHapticsFrames).
class OpenHapticsDriver final : public DeviceDriver {
 public:
  static constexpr const char* kDefault = "Default Device";
  static constexpr double kPatience = 0.5;  ///< s without a frame after which it is given up

  /// `name`: device: as the maker's set-up calls it, kDefault without; options: library=PATH,
  /// profile=NAME. `clock` outlives it.
  /// @throws Error that says why it does not open.
  OpenHapticsDriver(const DeviceName& name, const Clock& clock);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState exchange(const Eigen::Vector3d& force) override;

  // The two halves of an exchange.
  void ask(const Eigen::Vector3d& force) noexcept { session_.frames().ask(force); }
  /// @throws Error as exchange().
  [[nodiscard]] DeviceState answer() { return checked_answer().state; }

 private:
  void prepare();
  [[nodiscard]] OpenHapticsFrames::Answer checked_answer();
  [[noreturn]] void fail(const std::string& words) const;

  OpenHapticsLibrary library_;
  DeviceInfo info_;
  OpenHapticsSession session_;
};

}  // namespace palpate::device
