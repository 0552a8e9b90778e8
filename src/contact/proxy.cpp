// The proxy's public face: checks options, and hands each step to Proxy::Inside.
#include "palpate/contact/proxy.hpp"

#include <algorithm>
#include <cmath>

#include "base/requirement.hpp"
#include "contact/description.hpp"
#include "contact/proxy_inside.hpp"

namespace palpate {
namespace {

const ProxyOptions& checked(const ProxyOptions& options) {
  check_described("proxy", options);
  const Friction& friction = options.friction;
  const Requirement require{"proxy"};
  require(friction.dynamic_coefficient <= friction.static_coefficient, "friction.dynamic",
          friction.dynamic_coefficient, "give at most the static coefficient, or raise that");
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

bool Proxy::has_begun() const noexcept {
  return inside_->has_begun();
}

const Eigen::Vector3d& Proxy::position() const noexcept {
  return inside_->position();
}

const ProxyOptions& Proxy::options() const noexcept {
  return inside_->options();
}

int Proxy::max_evaluations() const noexcept {
  return 1100 + 20 * options().max_iterations + EscapeSearch::kMostLooks;
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
