#pragma once

#include <cstdint>

#include "device/device_name.hpp"
#include "device/forcedimension_library.hpp"
#include "palpate/device/device_link.hpp"

namespace palpate::device {

/// A device of Force Dimension, or a Novint Falcon, through the maker's library. Wrists and
/// grippers are read, and left without a force.
///
/// The device's own watchdog is armed: it takes the force away where nothing is heard for
/// kWatchdog. Its velocity threshold stays as it is.
class ForceDimensionLink final : public DeviceLink {
 public:
  static constexpr double kWatchdog = 5e-3;  ///< s

  /// `name`: device: its number, from 0; options: library=PATH, profile=NAME.
  /// @throws Error that says why there is none.
  explicit ForceDimensionLink(const DeviceName& name);
  ~ForceDimensionLink() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] LinkReading exchange(const Eigen::Vector3d& force) override;

 private:
  void prepare();
  void check_status() const;
  void check(int result, const char* what) const;
  [[nodiscard]] Eigen::Vector3d velocity();
  [[nodiscard]] Eigen::Quaterniond orientation() const;
  [[nodiscard]] double gripper() const;

  ForceDimensionLibrary library_;
  DeviceInfo info_;
  char id_ = -1;
  bool moves_ = false;           // a velocity has been told
  std::uint64_t exchanges_ = 0;  // since it was opened
};

}  // namespace palpate::device
