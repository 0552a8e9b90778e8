#include "contact/side.hpp"

#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

// The level of a metaball, 0.49 R above a plane (docs/method.md 2.2): with less there is no side.
constexpr double kLevel = 0.4;
constexpr double kScale = 0.35 / 0.3;  // of R: a metaball's height for its weight (2.3)

constexpr double kOften = 0.03;  // of R: half a step of a sweep, after which it is looked again
constexpr double kTurn = 0.5;    // cosine: within that a plane turns by less than 60 degrees
constexpr double kHigh = 0.1;  // of R above the plane of its points a place is surely on this side:
                               // as far as noise of a quarter of the spacing goes
constexpr double kOver = 0.7;  // a place is beyond points that lie 0.07 R over it (judgement)

}  // namespace

bool Side::pass(const Field& field, const Vector3d& place, const Sample& sample) noexcept {
  if (sample.support < (doubts() ? 0.5 : 1) * kLevel) {  // clear of a metaball, too
    forget();
    return true;
  }
  if (lost_ || (place - looked_).norm() < kOften * sample.radius) return true;
  const bool first = !looked_.allFinite();
  looked_ = place;
  const Nearby nearby = field.nearby(place, up_);
  if (known()) {
    const bool elsewhere = first && field.nearby(place_, up_).over > 0.5 * kOver;
    const bool clear = !first && !(nearby.beside > 0) && nearby.way.dot(up_) > 0;
    lost_ = elsewhere || clear || (place - place_).norm() > sample.radius;
    if (lost_) return true;
  }
  if (nearby.axis.isZero(0)) return true;
  const double cosine = known() ? nearby.axis.dot(up_) : -nearby.axis.dot(nearby.way);
  if (known() && std::abs(cosine) < kTurn) return true;
  const Vector3d up = cosine < 0 ? (-nearby.axis).eval() : nearby.axis;
  const double height = -nearby.way.dot(up);
  if (height < 0 && is_beyond(place, nearby)) return false;
  if (known()) up_ = up;
  if (height < kHigh * sample.radius) return true;
  up_ = up;
  place_ = place;
  return true;
}

void Side::touch(const Vector3d& place, const Vector3d& normal) noexcept {
  place_ = place;
  up_ = normal;
  looked_ = kNowhere;
  lost_ = false;
}

bool Side::is_beyond(const Vector3d& place, const Nearby& nearby) const noexcept {
  return known() && !doubts() && (place - place_).dot(up_) < 0 && nearby.over > kOver;
}

Sample Side::felt(const Sample& sample) const noexcept {
  if (!doubts() || !(sample.support > 0)) return sample;
  const double height = kScale * radius_ * (kLevel - sample.support);
  if (height >= sample.value) return sample;
  Sample felt = sample;
  felt.value = height;
  felt.gradient = -kScale * radius_ * sample.slope;
  return felt;
}

}  // namespace palpate
