#include "contact/probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palpate {

FrictionLaw friction_law(const Friction& friction, double factor, double stiffness,
                         double dt) noexcept {
  return {.static_coefficient = factor * friction.static_coefficient,
          .dynamic_coefficient = factor * friction.dynamic_coefficient,
          .viscous_rate = factor * friction.viscous / dt,
          .stiffness = stiffness};
}

bool sticks(const FrictionLaw& law, bool sliding, double normal, double tangential) noexcept {
  return tangential <= (sliding ? law.dynamic_coefficient : law.static_coefficient) * normal;
}

double held_stretch(const FrictionLaw& law, double normal, double tangential,
                    double moved) noexcept {
  const double dry = law.dynamic_coefficient * normal;
  if (!(law.viscous_rate > 0)) return std::min(dry, tangential);
  const double held = (dry * law.stiffness + law.viscous_rate * (moved + tangential)) /
                      (law.stiffness + law.viscous_rate);
  return std::min(held, tangential);
}

namespace {

// Orthogonal, and oblique to the axes: on the axis-aligned planes that people build, all vary.
constexpr std::array<std::array<double, 3>, 3> kDirections{
    {{2. / 3, -1. / 3, 2. / 3}, {2. / 3, 2. / 3, -1. / 3}, {-1. / 3, 2. / 3, 2. / 3}}};

}  // namespace

Relief relief_at(const Texture& texture, const Eigen::Vector3d& x) noexcept {
  const double wave_number = 2 * std::numbers::pi / texture.wavelength;
  const double share = texture.amplitude / 3;
  Relief relief{.height = -texture.amplitude};
  for (const auto& components : kDirections) {
    const Eigen::Vector3d direction(components[0], components[1], components[2]);
    const double phase = wave_number * direction.dot(x);
    relief.height += share * std::sin(phase);
    relief.gradient += share * wave_number * std::cos(phase) * direction;
  }
  return relief;
}

Probe::Probe(const Field& field, const Texture& texture, double step_length) noexcept
    : field_(field),
      texture_(texture),
      traits_(field.traits()),
      step_length_(step_length > 0 ? step_length : 16 * traits_.resolution) {
  field_.begin_step();
}

Sample Probe::sample(const Eigen::Vector3d& x) noexcept {
  ++evaluations_;
  Sample sample = field_.sample(x);
  if (sample.radius > 0) step_length_ = sample.radius;
  if (sample.support <= 0 && sample.value <= 0) sample.value = step_length_;  // nothing known
  if (texture_.amplitude > 0) {
    const Relief relief = relief_at(texture_, x);
    sample.value -= relief.height;
    sample.gradient -= relief.gradient;
  }
  return sample;
}

bool Probe::is_free(const Ball& ball) noexcept {
  ++evaluations_;
  return field_.is_free(ball);
}

namespace {

constexpr int kSteps = 10;
constexpr double kClamp = 0.3;       // of R
constexpr double kTolerance = 1e-6;  // of R
constexpr double kLastStep = 2e-4;  // of R: a step so short leaves its square, which needs no proof
constexpr double kAccept = 1e-4;    // of R, when the steps have run out
constexpr double kLeastGradient = 1e-8;
constexpr double kLeastSupport = 1e-6;

}  // namespace

std::optional<double> first_order_distance(const Sample& sample) noexcept {
  const double slope = sample.gradient.norm();
  if (!(slope >= kLeastGradient) || !(sample.support >= kLeastSupport)) return std::nullopt;
  return sample.value / slope;
}

std::optional<SurfacePoint> project(Probe& probe, const Eigen::Vector3d& x) noexcept {
  return project(probe, x, probe.sample(x));
}

std::optional<SurfacePoint> project(Probe& probe, const Eigen::Vector3d& x,
                                    const Sample& first) noexcept {
  Eigen::Vector3d place = x;
  Sample here = first;
  for (int step = 0;; ++step) {
    const std::optional<double> distance = first_order_distance(here);
    if (!distance) return std::nullopt;
    const double radius = probe.step_length();
    const Eigen::Vector3d normal = here.gradient.normalized();
    const double tolerance = (step < kSteps ? kTolerance : kAccept) * radius;
    if (std::abs(*distance) < tolerance) return SurfacePoint{place, normal, radius};
    if (step == kSteps) return std::nullopt;
    if (std::abs(*distance) < kLastStep * radius) {
      return SurfacePoint{place - *distance * normal, normal, radius};
    }
    place -= std::clamp(*distance, -kClamp * radius, kClamp * radius) * normal;
    here = probe.sample(place);
  }
}

}  // namespace palpate
