#include "contact/side.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// The level of a metaball, 0.49 R above a plane (docs/method.md 2.2): with less there is no side.
constexpr double kLevel = 0.4;
constexpr double kScale = 0.35 / 0.3;  // of R: a metaball's height for its weight (2.3)

// R d support / support from which on the slope tells where the points are. On a plane that is 0.07
// R above it: the tilt that irregular points give the slope is less there (judgement).
constexpr double kTells = 0.5;
constexpr double kAgainst = 0.5;  // cosine: the slope has turned round by 120 degrees

// The mean way to the nearest points, of their reach of 0.35 R: so far up, and steeper than 45
// degrees. That is 0.1 R beyond them: three times what a surface is off points without noise.
constexpr double kOver = 0.3;
constexpr double kSteep = 0.7;

}  // namespace

bool Side::pass(const Field& field, const Vector3d& place, const Sample& sample) noexcept {
  if (sample.support < kLevel) {
    forget();
    return true;
  }
  const Nearby nearby = field.nearby(place);
  const double steepness = nearby.slope.norm();
  if (!(steepness * sample.radius > kTells * sample.support)) return true;
  if (is_beyond(place, nearby)) return false;
  if (known() && nearby.slope.dot(up_) >= 0) return true;  // in a crease, or in the midst of points
  place_ = place;
  up_ = -nearby.slope / steepness;
  return true;
}

void Side::touch(const Vector3d& place, const Vector3d& normal) noexcept {
  place_ = place;
  up_ = normal;
}

bool Side::is_beyond(const Vector3d& place, const Nearby& nearby) const noexcept {
  if (!known() || doubts() || (place - place_).dot(up_) >= 0) return false;
  const double up = nearby.way.dot(up_);
  return nearby.slope.dot(up_) > kAgainst * nearby.slope.norm() && up > kOver &&
         up > kSteep * nearby.way.norm();
}

void Side::doubt(const Field& field) noexcept {
  radius_ = field.sample(place_).radius;
}

Sample Side::felt(const Field& field, const Vector3d& place, const Sample& sample) const noexcept {
  if (!doubts() || !(sample.support > 0)) return sample;
  const Nearby nearby = field.nearby(place);
  const double height = kScale * radius_ * (kLevel - nearby.weight);
  if (height >= sample.value) return sample;
  Sample felt = sample;
  felt.value = height;
  felt.gradient = -kScale * radius_ * nearby.slope;
  return felt;
}

}  // namespace palpate
