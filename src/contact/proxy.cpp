// The proxy's public face, the tank that pays for stiffness, and springs that fade.
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
  inside_->change(changed);
  return true;
}

void Proxy::reset(const Eigen::Vector3d& position) noexcept {
  inside_->reset(position);
}

namespace {

constexpr double kGone = 0.002;  // of the stiffness: 3 mN of 1.5 N

}  // namespace

void EnergyTank::restart(double stiffness) noexcept {
  stiffness_ = stiffness;
  energy_ = 0;
}

double EnergyTank::follow(double wanted, double stretch, double dissipated, double dt) noexcept {
  const double half_square = 0.5 * stretch * stretch;
  fill(dissipated);
  if (wanted < stiffness_) fall(wanted, half_square, dt);
  if (wanted > stiffness_) rise(wanted, half_square, dt);
  return stiffness_;
}

void EnergyTank::fall(double wanted, double half_square, double dt) noexcept {
  const double next = std::max(wanted, stiffness_ * std::exp(-dt / kTime));
  fill((stiffness_ - next) * half_square);
  stiffness_ = next;
}

void EnergyTank::rise(double wanted, double half_square, double dt) noexcept {
  const double step = std::min(wanted - stiffness_, wanted * std::min(1.0, dt / kTime));
  const double price = step * half_square;
  const double paid = std::min(price, energy_);
  if (paid < price) {
    stiffness_ += step * (paid / price);
  } else {
    stiffness_ = step < wanted - stiffness_ ? stiffness_ + step : wanted;
  }
  energy_ -= paid;
}

void EnergyTank::fill(double energy) noexcept {
  energy_ = std::min(kCapacity, energy_ + energy);
}

void FadingSpring::take(const Eigen::Vector3d& place, double stiffness) noexcept {
  const double both = stiffness_ + stiffness;
  if (both > 0) place_ += stiffness / both * (place - place_);
  stiffness_ = both;
  gone_ = kGone * both;
}

double FadingSpring::fade(const Eigen::Vector3d& hip, double dt) noexcept {
  const double left = stiffness_ * std::exp(-dt / EnergyTank::kTime);
  const double energy = 0.5 * (stiffness_ - left) * (place_ - hip).squaredNorm();
  stiffness_ = left > gone_ ? left : 0;
  return energy;
}

}  // namespace palpate
