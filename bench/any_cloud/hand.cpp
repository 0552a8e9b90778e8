// Draws the path of a hand, tick by tick.
#include "any_cloud/hand.hpp"

#include <algorithm>
#include <cmath>

#include "accuracy/path.hpp"

namespace palpate::any_cloud {

HandPath& HandPath::start(const Eigen::Vector3d& place) {
  ticks.push_back({place, Wanted::ignored, true});
  return *this;
}

HandPath& HandPath::to(const Eigen::Vector3d& goal, double speed, Wanted wanted) {
  const Eigen::Vector3d from = ticks.back().hand;
  const double seconds = (goal - from).norm() / speed;
  const int n = std::max(1, static_cast<int>(std::lround(seconds / accuracy::kTick)));
  for (int i = 1; i <= n; ++i) {
    tick(from + (goal - from) * (static_cast<double>(i) / n), wanted);
  }
  return *this;
}

HandPath& HandPath::tick(const Eigen::Vector3d& place, Wanted wanted) {
  ticks.push_back({place, wanted});
  return *this;
}

HandPath& HandPath::poke() {
  ticks.back().poke = true;
  return *this;
}

}  // namespace palpate::any_cloud
