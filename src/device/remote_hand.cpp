#include "palpate/device/remote_hand.hpp"

#include <cmath>

namespace palpate {

bool RemoteHand::move(const HandPose& pose) noexcept {
  if (!pose.wish.position.allFinite() || !std::isfinite(pose.stamp)) return false;
  said_.pose = pose;
  said_.held = true;
  ++said_.poses;
  word_.set(said_);
  return true;
}

void RemoteHand::keep() noexcept {
  if (said_.held) word_.set(said_);
}

void RemoteHand::release() noexcept {
  if (!said_.held) return;
  said_.held = false;
  word_.set(said_);
}

}  // namespace palpate
