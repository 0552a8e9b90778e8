#include "contact/energy_tank.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
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
