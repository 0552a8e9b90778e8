// The spring between proxy and hand, the tank that pays for its stiffness, and springs that fade.
#include "contact/spring.hpp"

#include <algorithm>
#include <cmath>

#include "contact/limit.hpp"

namespace palpate {

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

void EnergyTank::give(double wanted, double risen) noexcept {
  if (stiffness_ < wanted) stiffness_ = std::min(wanted, stiffness_ + risen * wanted);
}

void EnergyTank::fill(double energy) noexcept {
  energy_ = std::min(kCapacity, energy_ + energy);
}

void FadingSpring::take(const Eigen::Vector3d& anchor, double stiffness) noexcept {
  const double both = stiffness_ + stiffness;
  if (both > 0) anchor_ += stiffness / both * (anchor - anchor_);
  stiffness_ = both;
  gone_ = Limit::kGone * both;
}

double FadingSpring::fade(const Eigen::Vector3d& hip, double dt) noexcept {
  const double left = stiffness_ * std::exp(-dt / EnergyTank::kTime);
  const double energy = 0.5 * (stiffness_ - left) * (anchor_ - hip).squaredNorm();
  stiffness_ = left > gone_ ? left : 0;
  return energy;
}

double Spring::wanted(double full) const noexcept {
  if (is_lost()) return 0;
  return std::max(0.0, away_.left() * full - fading_.stiffness());
}

void Spring::go_on(const EnergyTank& before, double stiffness, double full,
                   const Eigen::Vector3d& stretch, Contact& contact) noexcept {
  tank_ = before;
  tank_.take_over(stiffness);
  pull(full, stretch, contact);
}

void Spring::wait(const Eigen::Vector3d& stretch) noexcept {
  tank_.fill(0.5 * tank_.stiffness() * stretch.squaredNorm());
  tank_.take_over(0);
}

void Spring::pull(double full, const Eigen::Vector3d& stretch, double dissipated, Step step,
                  Contact& contact) noexcept {
  tank_.follow(wanted(full), stretch.norm(), dissipated, step.dt);
  tank_.give(wanted(full), step.risen);
  pull(full, stretch, contact);
}

void Spring::pull(double full, const Eigen::Vector3d& stretch, Contact& contact) const noexcept {
  contact.stiffness = tank_.stiffness();
  contact.force = contact.stiffness * stretch;
  if (contact.stiffness < Limit::kMuchSofter * wanted(full)) contact.notes |= ContactNote::softer;
}

void Spring::add_fading(const Eigen::Vector3d& hip, double dt, Contact& contact) noexcept {
  tank_.fill(fading_.fade(hip, dt));
  contact.force += fading_.force(hip);
  contact.stiffness += fading_.stiffness();
}

}  // namespace palpate
