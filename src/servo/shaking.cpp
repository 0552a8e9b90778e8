#include "palpate/servo/shaking.hpp"

#include <cmath>

namespace palpate {

double Shaking::add(double place, double dt) noexcept {
  if (!started_) turned_at_ = farthest_ = place;
  started_ = true;
  since_farthest_ += dt;
  const double back = place - farthest_;
  if (direction_ * back >= 0 && back != 0) {  // goes on, or begins
    if (direction_ == 0) direction_ = back > 0 ? 1 : -1;
    farthest_ = place;
    since_turn_ += since_farthest_;
    since_farthest_ = 0;
  } else if (std::abs(back) > kSmallest) {  // has turned
    swing_ = since_turn_ < kSlowest ? std::abs(farthest_ - turned_at_) : 0;
    turned_at_ = farthest_;
    farthest_ = place;
    direction_ = -direction_;
    since_turn_ = since_farthest_;
    since_farthest_ = 0;
  }
  if (since_turn_ + since_farthest_ > 2 * kSlowest) swing_ = 0;
  return swing_;
}

}  // namespace palpate
