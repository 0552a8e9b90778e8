// Looks for a path from a proxy, and from its hand, to open air.
#include "contact/escape_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate {
namespace {

// The first path, along the normal, is open for most who press deep: they pay for little
// (judgement).
constexpr int kFirstLooks = 4;   // a step
constexpr int kFirstWork = 1;    // points: one sample a step
constexpr int kMostWork = 8000;  // points, a step on the other paths: some 50 us (measured: dragon)

constexpr double kOpenAir = 256;      // of R (judgement): who has so much room is in no body
constexpr double kFirstBall = 0.5;    // of R (judgement); later ones double where there is room
constexpr double kLeastBall = 0.25;   // of R (judgement): with less room the field is evaluated
constexpr double kSurfaceEnds = 0.3;  // of W: the default of FieldOptions::minimum_support
constexpr double kAir = std::numeric_limits<double>::infinity();  // m: higher than any field
constexpr double kStride = 0.3;   // of R (derived): single surfaces are solid for over half an R
constexpr double kClear = 0.1;    // of R (judgement): roughness below it bars no path
constexpr double kDeep = 1;       // of R (judgement), from the proxy: less is not held hard
constexpr double kElsewhere = 1;  // of R that a proxy moves before it is checked again (judgement)
// Times that a path turns. Measured before surfaces barred paths whatever their sides: of 288 hands
// in tilted tubes 1 to 4 R in radius, up to 20 R deep, smooth or rough by 0.1 R, 94 are let go with
// 2, two with 6, none with 12.
constexpr int kTurns = 12;
constexpr double kLeastTurn = 0.2;   // sine (12 degrees) of what is left of a path (judgement)
constexpr int kAround = 8;           // slanting directions, 45 degrees apart (judgement)
constexpr int kPaths = 1 + kAround;  // derived

/// The k-th direction from a surface: along its normal, or slanting by 45 degrees.
Eigen::Vector3d direction_from(const Eigen::Vector3d& normal, int k) noexcept {
  if (k == 0) return normal;
  const Eigen::Vector3d side = normal.unitOrthogonal();
  const double angle = 2 * std::numbers::pi / kAround * k;
  return (std::cos(angle) * side + std::sin(angle) * normal.cross(side) + normal).normalized();
}

}  // namespace

EscapeSearch::Ray EscapeSearch::ray(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                                    double radius) noexcept {
  return {.from = from, .along = along, .radius = radius, .ball = kFirstBall * radius};
}

/// May the path go on over this position? It leaves the surface that it begins at while the field
/// does not fall again. Once it is in air, every surface blocks it, whatever its sides: one that
/// let the proxy pass would let the path pass, too.
bool EscapeSearch::Ray::passes(const Sample& here) noexcept {
  const double least = std::max(0.0, highest - kClear * radius);
  if (!(here.value > 0) || !(here.support < kSurfaceEnds || here.value > least)) return false;
  highest = here.support < kSurfaceEnds ? kAir : std::max(highest, here.value);
  return true;
}

void EscapeSearch::Ray::go(double stride) noexcept {
  before = gone;
  gone += stride;
  if (turns == 0) room = gone;
}

/// Goes on along the surface that is in its path, from the last position before it; false where
/// that leads no further.
bool EscapeSearch::Ray::turn(const Eigen::Vector3d& gradient) noexcept {
  const Eigen::Vector3d normal = gradient.normalized();
  const Eigen::Vector3d next = along - std::min(0.0, along.dot(normal)) * normal;
  const double length = next.norm();
  if (++turns > kTurns || !(length > kLeastTurn)) return false;
  from += before * along + kClear * radius * normal;
  along = next / length;
  gone = before = 0;
  ball = kFirstBall * radius;
  return true;
}

EscapeSearch::End EscapeSearch::walk(Probe& probe, const Effort& effort) noexcept {
  const double least = kLeastBall * ray_.radius;
  const int before = probe.work();
  for (int look = 0; look < effort.looks; ++look) {
    const Eigen::Vector3d x = ray_.from + ray_.gone * ray_.along;
    if (probe.is_free({x, ray_.ball})) {
      ray_.highest = kAir;
      ray_.go(ray_.ball);
      ray_.ball *= 2;
      if (ray_.gone > kOpenAir * ray_.radius) return End::open;
    } else if (ray_.ball > least) {
      ray_.ball = std::max(least, 0.5 * ray_.ball);
    } else if (effort.work == 0) {
      return End::blocked;
    } else {
      const Sample here = probe.sample(x);
      if (ray_.passes(here)) {
        ray_.go(kStride * ray_.radius);
      } else if (!ray_.turn(here.gradient)) {
        return End::blocked;
      }
      if (probe.work() - before >= effort.work) break;
    }
  }
  return End::none;
}

void EscapeSearch::wander(Probe& probe, const Eigen::Vector3d& position) noexcept {
  if (state_ != State::free) search(position);
  state_ = State::free;
  if (was_out_) return;
  const double radius = probe.radius();
  if (direction_ == kPaths) {
    if ((position - last_).norm() < kElsewhere * radius) return;
    search(position);
  }
  if (!ray_.any()) {
    const double side = direction_ % 2 == 0 ? 1 : -1;
    ray_ = ray(position, direction_from(side * Eigen::Vector3d::UnitZ(), direction_), radius);
  }
  const End end = walk(probe, {kFirstLooks, 0});
  was_out_ = end == End::open;
  if (end == End::none) return;
  ray_ = {};
  ++direction_;
}

/// Forgets what was found of the proxy's escape: it is searched for from `position`.
void EscapeSearch::search(const Eigen::Vector3d& position) noexcept {
  state_ = State::searching;
  direction_ = 0;
  has_room_ = false;
  last_ = position;
  ray_ = {};
}

/// Looks on for the path of a proxy that touches.
void EscapeSearch::look_around(Probe& probe, const Eigen::Vector3d& position,
                               const Eigen::Vector3d& normal) noexcept {
  const double radius = probe.radius();
  if (!ray_.any()) {
    ray_ = ray(position + kClear * radius * normal, direction_from(normal, direction_), radius);
  }
  const bool first = direction_ == 0 && ray_.turns == 0;
  const Effort effort = first ? Effort{kFirstLooks, kFirstWork} : Effort{kMostLooks - 1, kMostWork};
  const End end = walk(probe, effort);
  if (end == End::none) return;
  has_room_ = has_room_ || ray_.room >= kStride * radius;
  last_ = position;
  ray_ = {};
  if (end == End::open) {
    state_ = State::open;
  } else if (++direction_ == kPaths) {
    state_ = has_room_ ? State::trapped : State::open;
  }
}

bool EscapeSearch::is_trapped(Probe& probe, const Eigen::Vector3d& position,
                              const Eigen::Vector3d& normal, const Eigen::Vector3d& hip) noexcept {
  const double radius = probe.radius();
  const bool moved = state_ != State::searching && (position - last_).norm() >= kElsewhere * radius;
  if (state_ == State::free || moved) search(position);
  if (!was_out_ || state_ == State::open || (position - hip).norm() < kDeep * radius) return false;
  if (state_ != State::trapped) {
    look_around(probe, position, normal);
    return false;
  }
  if (!probe.is_free({hip, kLeastBall * radius})) return false;
  ray_ = ray(hip, (hip - position).normalized(), radius);
  return walk(probe, {kMostLooks - 1, 0}) == End::open;
}

}  // namespace palpate
