#pragma once

#include <optional>

namespace palpate::sensor {

/// Brings the times of a device's own clock to the host's. A frame arrives no earlier than it was
/// taken, so the smallest difference between arrival and the device's time is the best guess of how
/// the clocks differ; it may grow slowly, as clocks drift. What every frame takes at least to
/// arrive is not known, and stays in the stamps. A device's time that goes back or jumps by a
/// second begins anew.
class HostStamps {
 public:
  /// The host's time of a frame taken at `device` (s, the device's clock) that came at `arrival`
  /// (s, the host's clock). Never after `arrival`.
  [[nodiscard]] double host(double device, double arrival);

 private:
  std::optional<double> difference_;  // host - device, s
  double arrival_ = 0;                // of the frame before
  double device_ = 0;                 // likewise
};

}  // namespace palpate::sensor
