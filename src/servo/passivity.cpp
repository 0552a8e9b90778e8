// Keeps the ledger of energy given to the hand and brakes while it is above zero.
#include "servo/passivity.hpp"

#include <algorithm>

#include "tool/motion.hpp"

namespace palpate {

template <int kAxes>
const typename PassivityOf<kAxes>::Sent& PassivityOf<kAxes>::sent(int readings_ago) const noexcept {
  return sent_[(newest_ + sent_.size() - static_cast<std::size_t>(readings_ago)) % sent_.size()];
}

// How many readings ago was the force sent that acted since the last one, `steps` ago?
template <int kAxes>
int PassivityOf<kAxes>::acting(int steps) const noexcept {
  if (options_.delay == 0 && steps == 1) return 0;
  int readings = 1;
  for (int before = 1; before < options_.delay && readings < kMaximumDelay; ++readings) {
    before += sent(readings).steps;
  }
  return readings;
}

// Is no force acting, and none in the delay line?
template <int kAxes>
bool PassivityOf<kAxes>::rests() const noexcept {
  for (int i = 0; i <= delay_; ++i) {
    if (!sent(i).force.isZero(0)) return false;
  }
  return true;
}

template <int kAxes>
void PassivityOf<kAxes>::account(const Vector& force, const Vector& displacement, double stored,
                                 double dt, int steps) noexcept {
  if (!options_.on) return;
  newest_ = (newest_ + 1) % sent_.size();
  sent_[newest_] = {force, steps};
  energy_ += sent(acting(steps)).force.dot(displacement);
  delay_ = steps == 1 ? options_.delay : std::max(1, (options_.delay + steps - 1) / steps);
  const double dissipated = -energy_ - stored;
  if (dissipated <= 0) return;
  if (stored == 0 && rests()) {
    energy_ = 0;
    return;
  }
  energy_ = -stored - std::min(dissipated / (1 + dt / options_.forget), options_.memory);
}

template <int kAxes>
void PassivityOf<kAxes>::reset() noexcept {
  energy_ = 0;
  sent_.fill({});
  delay_ = options_.delay;
}

template <int kAxes>
double PassivityOf<kAxes>::committed(const Vector& displacement) const noexcept {
  double energy = energy_;
  for (int i = 0; i < delay_; ++i) energy += sent(i).force.dot(displacement);
  return energy;
}

template <int kAxes>
typename PassivityOf<kAxes>::Vector PassivityOf<kAxes>::brake(const Vector& force,
                                                              const Vector& displacement, double dt,
                                                              double damping) const noexcept {
  const double square = displacement.squaredNorm();
  if (!options_.on || !(square > 0) || !(dt > 0)) return Vector::Zero();
  const double energy = committed(displacement) + force.dot(displacement);
  if (!(energy > 0)) return Vector::Zero();
  // With the displacement d and v = d / dt: E / (|v|^2 dt) v = E / |d|^2 d, B v = B / dt d.
  return -std::min(energy / square, strongest(dt, damping) / dt) * displacement;
}

template <int kAxes>
double PassivityOf<kAxes>::strongest(double dt, double damping) const noexcept {
  return std::max(0.0, options_.mass / (2 * std::max(2, delay_ + 1) * dt) - damping);
}

template class PassivityOf<3>;
template class PassivityOf<kFreedoms>;

}  // namespace palpate
