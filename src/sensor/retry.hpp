#pragma once

#include <algorithm>

namespace palpate::sensor {

/// How long to wait before a camera that failed is asked again: not at all after one failure, then
/// ever longer.
class Retry {
 public:
  Retry(double first, double longest) : first_(first), longest_(longest) {}

  void succeeded() { failures_ = 0; }

  /// Another failure; s to wait.
  [[nodiscard]] double failed() {
    ++failures_;
    if (failures_ == 1) return 0;
    wait_ = failures_ == 2 ? first_ : std::min(2 * wait_, longest_);
    return wait_;
  }

  /// More than one failure in a row.
  [[nodiscard]] bool repeatedly() const { return failures_ > 1; }

 private:
  double first_;
  double longest_;
  double wait_ = 0;
  int failures_ = 0;  // in a row
};

}  // namespace palpate::sensor
