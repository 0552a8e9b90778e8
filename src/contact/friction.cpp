#include "contact/friction.hpp"

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

}  // namespace palpate
