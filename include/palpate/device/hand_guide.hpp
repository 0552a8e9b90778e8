#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace palpate {

/// Where a hand wants to be.
struct HandWish {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, device frame
  std::uint32_t buttons = 0;                           ///< bit k: button k is down
};

/// Tells a simulated device's hand where to be, one step after the other: for hands that follow
/// something of which no trajectory is known before.
class HandGuide {
 public:
  virtual ~HandGuide() = default;

  /// The wish at `time`, s on the device's clock, which grows from call to call; the device is at
  /// `position` now, m, device frame. Called on the servo's thread: no allocation, lock, throw or
  /// system call. A wish that is not finite is a failure of the device.
  [[nodiscard]] virtual HandWish wanted(double time, const Eigen::Vector3d& position) noexcept = 0;

 protected:
  HandGuide() = default;
  HandGuide(const HandGuide&) = default;
  HandGuide& operator=(const HandGuide&) = default;
};

}  // namespace palpate
