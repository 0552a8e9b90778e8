#pragma once

#include "palpate/base/clock.hpp"

namespace palpate::test {

/// A clock that is set by hand.
class HandClock final : public Clock {
 public:
  [[nodiscard]] double now() const noexcept override { return time; }
  double time = 1000;  ///< s
};

}  // namespace palpate::test
