#pragma once

#include <string>
#include <vector>

#include "events/event.hpp"

namespace palpate::events {

/// Of one event, from where it begins.
struct Score {
  double step = 0;    ///< largest change of force from one tick to the next, N
  double most = 0;    ///< largest force, N
  double least = 1;   ///< least force of those that should hold, of K times the depth
  double last = 1;    ///< the last force alike
  double lost = 0;    ///< share of ticks with less than 20 % of that
  double behind = 0;  ///< time in which the proxy is more than 8 mm inside of something, s
  double beyond = 0;  ///< farthest that a proxy which touches is from all solids, mm
  double rms = 0;     ///< of the force about its mean over 50 ms, N
};

[[nodiscard]] Score score(const Event& event, const Felt& felt);

/// A line of the table: medians and worst.
[[nodiscard]] std::string heading();
[[nodiscard]] std::string line(const std::string& name, const std::vector<Score>& scores);

}  // namespace palpate::events
