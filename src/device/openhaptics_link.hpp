#pragma once

#include <memory>

#include "device/device_name.hpp"
#include "device/openhaptics_frames.hpp"
#include "device/openhaptics_library.hpp"
#include "device/openhaptics_session.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/device_link.hpp"

namespace palpate::device {

/// A Touch or a Phantom of 3D Systems, through the maker's library. What happens in its scheduler
/// is in OpenHapticsFrames; an exchange leaves a force for its next frame and waits for what that
/// tells.
class OpenHapticsLink final : public DeviceLink {
 public:
  static constexpr const char* kDefault = "Default Device";
  static constexpr double kPatience = 0.5;  ///< s without a frame: the scheduler is given up

  /// `name`: device: as it is called in the maker's set-up, kDefault without; options:
  /// library=PATH, profile=NAME. `clock` outlives it.
  /// @throws Error that says why there is none.
  OpenHapticsLink(const DeviceName& name, const Clock& clock);
  ~OpenHapticsLink() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] LinkReading exchange(const Eigen::Vector3d& force) override;

  // The two halves of an exchange.
  void ask(const Eigen::Vector3d& force) noexcept { frames_->ask(force); }
  /// @throws Error as exchange().
  [[nodiscard]] LinkReading answer() { return checked_answer().reading; }

 private:
  void prepare();
  [[nodiscard]] OpenHapticsFrames::Answer checked_answer();
  [[noreturn]] void fail(const std::string& words) const;

  OpenHapticsLibrary library_;
  DeviceInfo info_;
  OpenHapticsSession session_;
  std::shared_ptr<OpenHapticsFrames> frames_;
};

}  // namespace palpate::device
