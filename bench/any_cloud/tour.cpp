// Draws a tour: one hand that pokes a closed body from all sides.
#include "any_cloud/tour.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "any_cloud/ways.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr int kPokes = 25;
constexpr double kAway = 14;        // of the ball that a hand travels on
constexpr double kNear = 8;         // from here on a poke is slow
constexpr double kLean = 0.6;       // at most, of a poke to the normal
constexpr int kTries = 400;         // for a poke that is free as far as the surface
constexpr double kClearance = 1;    // of a way from anything, but for its last
constexpr double kLastStretch = 2;  // spacings

struct Poke {
  Vector3d outside;  // on the ball
  Vector3d near;
  Vector3d deepest;
};

// Is the way from `from` in `direction` clear of the truth?
bool is_clear(const Draft& draft, const Vector3d& from, const Vector3d& direction, double length) {
  for (double t = kLastStretch; t < length; t += 0.5) {
    const double value = draft.truth(from + t * direction).value;
    if (value < std::min(kClearance, 0.4 * t)) return false;
  }
  return true;
}

std::optional<Poke> draw_poke(Draft& draft, double ball) {
  for (int i = 0; i < kTries; ++i) {
    const std::size_t at = draft.random.bits() % draft.points.size();
    const Vector3d& p = draft.points[at];
    const double lean = kLean * draft.random.uniform();
    const Vector3d out = (draft.normals[at] + lean * draft.direction()).normalized();
    const double along = p.dot(out);
    const double reach = -along + std::sqrt(along * along + ball * ball - p.squaredNorm());
    if (!is_clear(draft, p, out, reach)) continue;
    const double wanted = draft.between(2, 3);
    double depth = 0.5;  // never out of the other side
    while (depth < wanted && draft.truth(p - (depth + 0.5) * out).value < 0) depth += 0.25;
    return Poke{p + reach * out, p + std::min(kNear, reach) * out, p - depth * out};
  }
  return std::nullopt;
}

void travel(Draft& draft, const Vector3d& to, double ball) {
  const Vector3d from = draft.hand.ticks.back().hand / ball;
  const Vector3d end = to / ball;
  const double angle = std::acos(std::clamp(from.dot(end), -1.0, 1.0));
  const int n = std::max(1, static_cast<int>(angle * ball / (kReach * 1e-3)));
  Vector3d side = end - from.dot(end) * from;
  if (side.norm() < 1e-6) side = from.cross(draft.direction());
  side.normalize();
  for (int i = 1; i < n; ++i) {
    const double a = angle * i / n;
    draft.hand.tick(ball * (std::cos(a) * from + std::sin(a) * side));
  }
  draft.hand.tick(to);
}

// From the origin.
double reach_of(const Draft& draft) {
  double reach = 0;
  for (const Vector3d& p : draft.points) reach = std::max(reach, p.norm());
  return reach;
}

}  // namespace

void roam_around(Draft& draft) {
  constexpr double kDeepest = 3;  // spacings
  if (draft.points.empty()) return;
  const double ball = reach_of(draft) + kNear;
  Vector3d at = ball * draft.direction();
  draft.hand.start(at);
  const auto ticks = static_cast<std::size_t>(draft.roam);
  while (draft.hand.ticks.size() < ticks) {
    const Vector3d goal = ball * draft.random.uniform() * draft.direction();
    const Vector3d stride = 1e-3 * draft.between(kPush, kReach) * (goal - at).normalized();
    const auto strides = static_cast<int>((goal - at).norm() / stride.norm());
    for (int i = 0; i < strides && draft.hand.ticks.size() < ticks; ++i) {
      const Distance next = draft.truth(at + stride);
      if (next.value < -kDeepest && next.gradient.dot(stride) < 0) break;
      draft.hand.tick(at += stride);
    }
  }
}

void poke_around(Draft& draft) {
  if (draft.roam > 0) return roam_around(draft);
  if (draft.points.empty()) return;
  const double ball = reach_of(draft) + kAway;
  for (int i = 0; i < kPokes; ++i) {
    const std::optional<Poke> poke = draw_poke(draft, ball);
    if (!poke) continue;
    if (draft.hand.ticks.empty()) draft.hand.start(poke->outside);
    travel(draft, poke->outside, ball);
    draft.hand.poke();
    draft.hand.to(poke->near, kReach).to(poke->deepest, kPush);
    draft.hand.to(poke->near, kPush).to(poke->outside, kReach);
  }
}

}  // namespace palpate::any_cloud
