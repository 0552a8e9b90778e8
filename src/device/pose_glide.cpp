#include "palpate/device/pose_glide.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr double kShare = 1.0 / 8;  // of a new interval in the mean

}  // namespace

void PoseGlide::rest(const Eigen::Vector3d& position, double time) noexcept {
  from_ = position;
  to_ = position;
  start_ = time;
  duration_ = 0;
  moving_ = false;
}

void PoseGlide::go(const Eigen::Vector3d& position, double stamp, double time) noexcept {
  const double since = stamp - stamp_;
  if (moving_ && since > 0 && since <= kLongest) {
    interval_ += kShare * (std::max(since, kShortest) - interval_);
  }
  from_ = at(time);
  to_ = position;
  start_ = time;
  duration_ = kReserve * interval_;
  stamp_ = stamp;
  moving_ = true;
}

Eigen::Vector3d PoseGlide::at(double time) const noexcept {
  const double gone = time - start_;
  if (gone >= duration_) return to_;
  return from_ + std::max(gone, 0.0) / duration_ * (to_ - from_);
}

}  // namespace palpate
