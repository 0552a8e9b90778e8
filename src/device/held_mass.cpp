// Integrates a simulated mass exactly between its stops and starts.
#include "device/held_mass.hpp"

#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kParts = 16;  // of a step; dry friction's direction is constant in each (judgement)
constexpr int kEvents = 4;  // stops and starts followed in one part (judgement)
constexpr int kBisections = 48;    // of a part, to find when the device stops (judgement)
constexpr double kAtRest = 1e-12;  // m/s; slower counts as at rest (judgement)

// e^A by Taylor's series of A / 2^n, squared n times: exact to rounding for these small matrices.
Eigen::Matrix4d exponential(const Eigen::Matrix4d& a) {
  const double norm = a.cwiseAbs().rowwise().sum().maxCoeff();
  const int squarings = norm > 0.5 ? std::ilogb(norm) + 2 : 0;
  const Eigen::Matrix4d scaled = std::ldexp(1.0, -squarings) * a;
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d sum = term;
  for (int i = 1; i <= 16; ++i) {
    term = Eigen::Matrix4d(term * scaled) / i;
    sum += term;
  }
  for (int i = 0; i < squarings; ++i) sum = Eigen::Matrix4d(sum * sum);
  return sum;
}

// Matrix A of d/dt (x, v, push, push rate) = A (x, v, push, push rate).
Eigen::Matrix4d generator_of(const SimulatedDeviceOptions& options) {
  Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
  generator(0, 1) = 1;
  generator(1, 0) = -options.hand.stiffness / options.mass;
  generator(1, 1) = -(options.damping + options.hand.damping) / options.mass;
  generator(1, 2) = 1 / options.mass;
  generator(2, 3) = 1;
  return generator;
}

}  // namespace

HeldMass::HeldMass(const SimulatedDeviceOptions& the_options)
    : options(the_options),
      generator(generator_of(options)),
      whole_step(exponential(generator / options.rate)),
      part_step(exponential(generator / (options.rate * kParts))),
      position(options.position),
      velocity(options.velocity) {}

void HeldMass::advance(const Vector3d& force, const Vector3d& push,
                       const Vector3d& push_rate) noexcept {
  const Vector3d before = position;
  if (options.coulomb == 0) {
    flow(whole_step, push, push_rate);
  } else {
    const double part = 1 / (options.rate * kParts);
    for (int i = 0; i < kParts; ++i) slide(part, push + i * part * push_rate, push_rate);
  }
  work += force.dot(position - before);
}

// Advances one part of a step. The device may stop in it, and start again.
void HeldMass::slide(double duration, Vector3d push, const Vector3d& push_rate) noexcept {
  const double whole = duration;
  for (int event = 0; event < kEvents && duration > 0; ++event) {
    Vector3d direction = velocity;
    if (velocity.norm() <= kAtRest) {
      velocity.setZero();
      direction = push - options.hand.stiffness * position;
      if (direction.norm() <= options.coulomb) return;  // held by dry friction
    }
    direction.normalize();
    const Vector3d sliding_push = push - options.coulomb * direction;
    const Vector3d x = position;
    const Vector3d v = velocity;
    flow(duration == whole ? part_step : exponential(generator * duration), sliding_push,
         push_rate);
    if (velocity.dot(direction) > 0) return;
    double moving = 0;
    double stopped = duration;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (moving + stopped);
      position = x;
      velocity = v;
      flow(exponential(generator * middle), sliding_push, push_rate);
      (velocity.dot(direction) > 0 ? moving : stopped) = middle;
    }
    velocity -= direction.dot(velocity) * direction;
    push += stopped * push_rate;
    duration -= stopped;
  }
}

void HeldMass::flow(const Eigen::Matrix4d& transition, const Vector3d& push,
                    const Vector3d& push_rate) noexcept {
  const Vector3d x = transition(0, 0) * position + transition(0, 1) * velocity +
                     transition(0, 2) * push + transition(0, 3) * push_rate;
  velocity = transition(1, 0) * position + transition(1, 1) * velocity + transition(1, 2) * push +
             transition(1, 3) * push_rate;
  position = x;
}

}  // namespace palpate
