#include "palpate/servo/deadlines.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {

double Deadlines::begin(double now) noexcept {
  const double late = std::max(now - next(), 0.0);
  const auto missed = static_cast<std::uint64_t>(std::floor(late / period_));
  index_ += missed + 1;
  skipped_ += missed;
  while (next() <= now) {  // rounding
    ++index_;
    ++skipped_;
  }
  return late;
}

void Deadlines::restart(double now) noexcept {
  start_ = now;
  index_ = 1;
}

}  // namespace palpate
