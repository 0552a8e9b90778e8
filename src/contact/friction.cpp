#include "contact/friction.hpp"

#include <algorithm>

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

}  // namespace palpate
