#include "palpate/scene/snapshot.hpp"

#include <algorithm>

namespace palpate {

double progress(const Snapshot& snapshot, double time) noexcept {
  const double duration = snapshot.end - snapshot.start;
  if (!(duration > 0)) return time < snapshot.start ? 0 : 1;
  return std::clamp((time - snapshot.start) / duration, 0.0, 1.0);
}

double presence(const Snapshot& snapshot, double time) noexcept {
  const double own = snapshot.presence_start +
                     progress(snapshot, time) * (snapshot.presence_end - snapshot.presence_start);
  const double silence = time - snapshot.silent_from;
  if (!(silence > 0)) return own;
  return snapshot.fade > 0 ? own * std::clamp(1 - silence / snapshot.fade, 0.0, 1.0) : 0;
}

}  // namespace palpate
