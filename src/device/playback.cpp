#include "palpate/device/playback.hpp"

namespace palpate {

Eigen::Vector3d Playback::at(double time) noexcept {
  while (cursor_ + 1 < rows_.size() && rows_[cursor_ + 1].time <= time) ++cursor_;
  const TrajectoryRow& a = rows_[cursor_];
  if (cursor_ + 1 == rows_.size() || time <= a.time) return a.position;
  const TrajectoryRow& b = rows_[cursor_ + 1];
  return a.position + (time - a.time) / (b.time - a.time) * (b.position - a.position);
}

}  // namespace palpate
