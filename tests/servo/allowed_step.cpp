#include "servo/allowed_step.hpp"

#include <algorithm>

namespace palpate::test {

using Eigen::Vector3d;

double AllowedStep::operator()(const Guard::Input& input, GuardNote notes) {
  if (!begun_) begin(input);
  if (input.stiffness > 0) spring_ = input.stiffness;
  const Vector3d velocity =
      velocity_ + Guard::kSmoothing * (input.velocity - input.drift - velocity_);
  const double braked = has(notes, GuardNote::braked) ? brake(input) : 0;
  const double allowed = stiffness(input) * (input.hip - before_.hip).norm() +
                         options_.damping * (velocity - velocity_).norm() +
                         options_.slew * input.dt + braked + brake_;
  before_ = input;
  velocity_ = velocity;
  brake_ = braked;
  return allowed;
}

void AllowedStep::begin(const Guard::Input& input) {
  before_ = input;
  velocity_ = input.velocity - input.drift;
  spring_ = brake_ = 0;
  begun_ = true;
}

double AllowedStep::stiffness(const Guard::Input& input) const {
  const double loose = input.normal.isZero(0) ? spring_ : 0;
  return std::max({input.stiffness, before_.stiffness, loose});
}

double AllowedStep::brake(const Guard::Input& input) const {
  const Vector3d way = input.hip - before_.hip - input.drift * input.dt;
  const int steps = std::max(2, options_.passivity.delay + 1);
  return options_.passivity.mass / (2 * steps * input.dt * input.dt) * way.norm();
}

}  // namespace palpate::test
