// Keeps the ledger of energy given to the hand and brakes while it is above zero.
#include "servo/passivity.hpp"

#include <algorithm>

namespace palpate {

using Eigen::Vector3d;

const Vector3d& Passivity::sent(int steps_ago) const noexcept {
  return sent_[(newest_ + sent_.size() - static_cast<std::size_t>(steps_ago)) % sent_.size()];
}

// Is no force acting or on its way?
bool Passivity::rests() const noexcept {
  for (int i = 0; i <= options_.delay; ++i) {
    if (!sent(i).isZero(0)) return false;
  }
  return true;
}

void Passivity::account(const Vector3d& force, const Vector3d& way, double stored,
                        double dt) noexcept {
  if (!options_.on) return;
  newest_ = (newest_ + 1) % sent_.size();
  sent_[newest_] = force;
  energy_ += sent(options_.delay).dot(way);
  const double dissipated = -energy_ - stored;
  if (dissipated <= 0) return;
  if (stored == 0 && rests()) {
    energy_ = 0;
    return;
  }
  energy_ = -stored - std::min(dissipated / (1 + dt / options_.forget), options_.memory);
}

void Passivity::reset() noexcept {
  energy_ = 0;
  sent_.fill(Vector3d::Zero());
}

double Passivity::committed(const Vector3d& way) const noexcept {
  double energy = energy_;
  for (int i = 0; i < options_.delay; ++i) energy += sent(i).dot(way);
  return energy;
}

Vector3d Passivity::brake(const Vector3d& force, const Vector3d& way, double dt,
                          double damping) const noexcept {
  const double square = way.squaredNorm();
  if (!options_.on || !(square > 0) || !(dt > 0)) return Vector3d::Zero();
  const double energy = committed(way) + force.dot(way);
  if (!(energy > 0)) return Vector3d::Zero();
  // With v = way / dt: E / (|v|^2 dt) v = E / |way|^2 way, B v = B / dt way.
  return -std::min(energy / square, strongest(dt, damping) / dt) * way;
}

// Strongest brake, as a damper beside another of `damping`, N s/m.
double Passivity::strongest(double dt, double damping) const noexcept {
  return std::max(0.0, options_.mass / (2 * std::max(2, options_.delay + 1) * dt) - damping);
}

}  // namespace palpate
