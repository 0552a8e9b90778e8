// Counts what hands felt beside what the ideal proxy feels.
#include <algorithm>

#include "eyes/view.hpp"

namespace palpate::eyes {
namespace {

constexpr double kHeld = 0.5;         // N
constexpr int kHeldTicks = 50;        // 50 ms
constexpr int kFading = 100;          // 100 ms: springs end softly in five times 20 ms
constexpr double kOutside = 0.01;     // m, of the hand from all solids and all that is seen
constexpr int kPixels = 8;            // around the hand
constexpr double kThrown = 5;         // N
constexpr double kThrownIdeal = 2;    // N
constexpr double kStep = 1;           // N in a tick
constexpr double kAsked = 1;          // N of the ideal
constexpr double kLost = 0.2;         // of it
constexpr double kSameDepth = 0.004;  // m: a camera sees the ideal proxy

/// Is the straight way from the proxy to the hand in one free space?
bool is_way_free(const View& view, const Vector3d& proxy, const Vector3d& hip) {
  constexpr int kPlaces = 200;
  constexpr double kGrazes = 3e-4;  // m: at the very edge either face may hold
  for (int k = 10; k <= kPlaces; ++k) {
    const Vector3d x = proxy + k * 1.0 / kPlaces * (hip - proxy);
    if (distance_and_normal(view.scene, x, 0).value < kGrazes) return false;
  }
  return true;
}

/// Is the hand in free air, in front of all that a camera sees around it?
bool is_before_all(const View& view, const std::vector<Picture>& pictures, const Vector3d& hip) {
  if (distance_and_normal(view.scene, hip, 0).value < kOutside) return false;
  return std::ranges::any_of(pictures, [&](const Picture& picture) {
    return picture.depth_at(hip, kPixels) > picture.depth_of(hip) + kOutside;
  });
}

bool is_seen(const std::vector<Picture>& pictures, const Vector3d& at) {
  return std::ranges::any_of(pictures, [&](const Picture& picture) {
    return std::abs(picture.depth_of(at) - picture.depth_at(at, 0)) < kSameDepth;
  });
}

}  // namespace

Score& Score::operator+=(const Score& other) {
  hands += other.hands;
  held += other.held;
  most = std::max(most, other.most);
  hidden += other.hidden;
  caught += other.caught;
  thrown += other.thrown;
  steps += other.steps;
  asked += other.asked;
  lost += other.lost;
  asked_in_shadow += other.asked_in_shadow;
  lost_in_shadow += other.lost_in_shadow;
  microseconds += other.microseconds;
  return *this;
}

Score score(const View& view, const std::vector<Picture>& pictures, const Hand& hand,
            const Felt& felt) {
  Score score;
  score.hands = 1;
  score.microseconds = felt.microseconds;
  score.hidden = hand.hidden ? 1 : 0;
  int run = 0;
  int free_for = kFading;  // ticks since the ideal let go
  bool shadowed = false;   // the contact has been where no camera sees anything
  bool astray = false;     // contact began where no camera sees anything
  for (std::size_t i = 1; i < hand.hip.size(); ++i) {
    const double now = felt.force[i].norm();
    const double ideal = felt.ideal[i].norm();
    free_for = ideal < kHeld ? free_for + 1 : 0;
    const bool forbidden = hand.hidden || hand.free ||
                           (free_for > kFading && is_before_all(view, pictures, hand.hip[i]));
    const bool held = forbidden && now > kHeld;
    run = held && (hand.hidden || is_way_free(view, felt.proxy[i], hand.hip[i])) ? run + 1 : 0;
    if (run >= kHeldTicks) {
      (hand.hidden ? score.caught : score.held) = 1;
      score.most = std::max(score.most, now);
    }
    if (hand.hidden) continue;
    const bool seen = is_seen(pictures, felt.ideal_proxy[i]);
    shadowed = ideal > 0 && (shadowed || !seen);
    astray = astray || (ideal > 0 && felt.ideal[i - 1].norm() == 0 && !seen);
    if (astray) continue;
    if (now > kThrown && ideal < kThrownIdeal) score.thrown = 1;
    const double step = (felt.force[i] - felt.force[i - 1]).norm();
    if (step > kStep && step > 2 * (felt.ideal[i] - felt.ideal[i - 1]).norm()) ++score.steps;
    if (ideal < kAsked) continue;
    (shadowed ? score.asked_in_shadow : score.asked) += 1;
    if (now < kLost * ideal) (shadowed ? score.lost_in_shadow : score.lost) += 1;
  }
  return score;
}

}  // namespace palpate::eyes
