#pragma once

#include <functional>

#include "palpate/contact/proxy.hpp"
#include "support/rates.hpp"

namespace palpate::test {

/// Moves the hand from `from` to `to` in a straight line at `speed` (m/s) and tells `visit` of
/// every step. Returns the last one.
inline Contact drive(
    Proxy& proxy, const Field& field, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
    double speed, const std::function<void(const Eigen::Vector3d&, const Contact&)>& visit = {}) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / (speed * kTick))));
  Contact contact;
  for (int i = 1; i <= steps; ++i) {
    const Eigen::Vector3d hip = from + (to - from) * (static_cast<double>(i) / steps);
    contact = proxy.step(field, hip, kTick);
    if (visit) visit(hip, contact);
  }
  return contact;
}

/// Lets the hand rest for `steps` steps.
inline Contact rest(Proxy& proxy, const Field& field, const Eigen::Vector3d& hip, int steps = 50) {
  Contact contact;
  for (int i = 0; i < steps; ++i) contact = proxy.step(field, hip, kTick);
  return contact;
}

}  // namespace palpate::test
