#pragma once

#include <limits>
#include <optional>

namespace palpate::sensor {

/// A camera's clock may run ahead of the stream's by so much before a stamp is thought senseless.
inline constexpr double kAhead = 1;  // s (judgement)

/// Follows a camera's clock that somebody sets while it runs. Stamps count as they are until two in
/// a row are from before the newest one, or from the future: one alone is a frame that was late.
/// From then on no frame arrives sooner after it was taken than the quickest one did before.
class CameraClock {
 public:
  /// The time on the stream's clock at which a frame with this stamp was taken, s; `arrival`: when
  /// it came, on the same clock.
  [[nodiscard]] double on_stream(double stamp, double arrival);

  /// Has no stamp come yet?
  [[nodiscard]] bool is_new() const { return is_new_; }

  /// How far the last stamp showed the clock to be set back, s; below 0: forward; 0: it was not.
  [[nodiscard]] double set_back() const { return set_back_; }

 private:
  bool is_new_ = true;
  double shift_ = 0;     // from stamps to the stream's clock, s
  double set_back_ = 0;  // s
  double quickest_ = std::numeric_limits<double>::infinity();  // from its time to its arrival, s
  std::optional<double> newest_;                               // time of the newest frame, s
  std::optional<double> odd_;  // the last stamp, where it was from before that or the future
};

}  // namespace palpate::sensor
