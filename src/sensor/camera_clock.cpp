// Keeps a camera's stamps on the stream's clock where the camera's clock is set.
#include "sensor/camera_clock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::sensor {

double CameraClock::on_stream(double stamp, double arrival) {
  is_new_ = false;
  set_back_ = 0;
  if (!std::isfinite(stamp)) return stamp;
  const double time = stamp + shift_;
  const bool ahead = time > arrival + kAhead;
  const bool odd = newest_ && (ahead || time < *newest_);
  const bool lasts = odd && odd_ && stamp >= *odd_;
  odd_ = odd ? std::optional(stamp) : std::nullopt;
  if ((odd && !lasts) || (ahead && !newest_)) return time;
  // A first guess of the shift is too large where that frame was slow: a quicker one corrects it.
  const double latest = arrival - quickest_;
  const bool corrects = lasts || (shift_ != 0 && time > latest);
  const double taken = corrects ? latest : time;
  if (lasts) set_back_ = taken - time;
  odd_.reset();
  shift_ += taken - time;
  quickest_ = std::min(quickest_, arrival - taken);
  newest_ = taken;
  return taken;
}

}  // namespace palpate::sensor
