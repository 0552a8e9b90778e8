#include "contact/texture.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace palpate {
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
