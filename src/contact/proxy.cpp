// The proxy's public face: checks options, and hands each step to Proxy::Inside.
#include "palpate/contact/proxy.hpp"

#include <algorithm>
#include <cmath>

#include "base/requirement.hpp"
#include "contact/proxy_inside.hpp"

namespace palpate {
namespace {

constexpr int kMostIterations = 1000;  // fifty times the default; more is a mistake (judgement)

const ProxyOptions& checked(const ProxyOptions& options) {
  const Requirement require{"proxy"};
  // The remedy in errors about numbers.
  constexpr const char* kAtLeastZero = "give a number that is 0 or more";
  require.not_negative("stiffness (N/m)", options.stiffness, kAtLeastZero);
  const Friction& friction = options.friction;
  require.not_negative("static friction", friction.static_coefficient, kAtLeastZero);
  require.not_negative("dynamic friction", friction.dynamic_coefficient, kAtLeastZero);
  require.not_negative("viscous friction (N s/m)", friction.viscous, kAtLeastZero);
  require(friction.dynamic_coefficient <= friction.static_coefficient, "dynamic friction",
          friction.dynamic_coefficient, "give at most the static coefficient, or raise that");
  require.not_negative("texture amplitude (m)", options.texture.amplitude, kAtLeastZero);
  require.positive("texture wavelength (m)", options.texture.wavelength, "give a length above 0");
  require(options.max_iterations >= 1 && options.max_iterations <= kMostIterations,
          "max_iterations", options.max_iterations, "give 1 to 1000");
  require(options.tangent_tolerance >= 1e-6 && options.tangent_tolerance <= 0.1,
          "tangent_tolerance", options.tangent_tolerance, "give 1e-6 to 0.1 support radii");
  require(options.rise_time > 0, "rise_time (s)", options.rise_time,
          "give a time above 0, infinity for no rise that nothing pays for");
  return options;
}

}  // namespace

Proxy::Proxy(const ProxyOptions& options) : inside_(std::make_unique<Inside>(checked(options))) {}
Proxy::~Proxy() = default;
Proxy::Proxy(Proxy&&) noexcept = default;
Proxy& Proxy::operator=(Proxy&&) noexcept = default;

Contact Proxy::step(const Field& field, const Eigen::Vector3d& hip, double dt) noexcept {
  return inside_->step(field, hip, dt);
}

const Eigen::Vector3d& Proxy::position() const noexcept {
  return inside_->position();
}

const ProxyOptions& Proxy::options() const noexcept {
  return inside_->options();
}

int Proxy::max_evaluations() const noexcept {
  return 1100 + 20 * options().max_iterations + WayOut::kMostLooks;
}

bool Proxy::change(double stiffness, const Friction& friction, const Texture& texture) noexcept {
  const auto good = [](double x) { return std::isfinite(x) && x >= 0; };
  if (!good(stiffness) || !good(friction.static_coefficient) ||
      !good(friction.dynamic_coefficient) || !good(friction.viscous) ||
      friction.dynamic_coefficient > friction.static_coefficient || !good(texture.amplitude) ||
      !(good(texture.wavelength) && texture.wavelength > 0)) {
    return false;
  }
  ProxyOptions changed = options();
  changed.stiffness = stiffness;
  changed.friction = friction;
  changed.texture = texture;
  inside_->options() = changed;
  return true;
}

void Proxy::reset(const Eigen::Vector3d& position) noexcept {
  inside_->reset(position);
}

}  // namespace palpate
