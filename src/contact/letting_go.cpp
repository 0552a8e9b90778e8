// Ends contacts whose surface is gone, and lets go of hands that nothing should hold.

#include "contact/limit.hpp"
#include "contact/probe.hpp"
#include "contact/proxy_inside.hpp"

namespace palpate {
namespace {

constexpr double kWaits = 2;   // of R: a hand that moves farther ends the wait (judgement)
constexpr double kFast = 0.1;  // of R a step: the reserve of a patch (SceneField)

}  // namespace

// Waits where a contact's surface vanished: a sensor that does not see what the hand presses takes
// it away and brings it back. Until then the proxy keeps its side, on the plane that it touched
// (`position`, `normal`), without force. The tank keeps what the spring held, which pays for the
// stiffness that comes back. A hand that moves on is free.
void Proxy::Inside::await(Probe& probe, const Eigen::Vector3d& position,
                          const Eigen::Vector3d& normal, const Eigen::Vector3d& pressed,
                          const Eigen::Vector3d& hip) noexcept {
  const double depth = normal.dot(position - hip);
  if (touch_.touching || !(depth > 0) || (hip - pressed).norm() > kWaits * radius_) return;
  if (touch_.surface.presence > kFaded && probe.sample(position).support > 0) return;
  release(hip + depth * normal);
  touch_.touching = touch_.waiting = true;
  touch_.normal = touch_.side = normal;
  touch_.pressed = pressed;
  spring_.wait(position - hip);
}

// Keeps the spring of a contact whose surface was not found in this step, at the position to which
// the proxy came. It fades once the surface is lost for long, unless a sweep had only run out of
// its budget.
void Proxy::Inside::keep(Probe& probe, const Eigen::Vector3d& hip, double dt,
                         Contact& contact) noexcept {
  contact.normal = touch_.normal;
  if (!search_.is_cut_short) {
    contact.notes |= ContactNote::lost;
    spring_.lose(dt);
  }
  pull(hip, 0, dt, contact);
  if (contact.stiffness <= kFaded * options_.stiffness) let_go(probe, hip);
}

// Lets go of a hand whose proxy passed through a surface and is held by it from within: the spring
// fades with a time constant of 20 ms. A proxy that moves fast is not looked at: what a step saw
// beyond its patch hands the sides to the next one (SceneField), and looking elsewhere would forget
// it. Lets go as well of a hand that is held hard in free air for long; the inside of a scanned
// body is free air, too.
void Proxy::Inside::free_hand(Probe& probe, const Eigen::Vector3d& before,
                              const Eigen::Vector3d& hip, double dt, Contact& contact,
                              bool changed) noexcept {
  if (changed) escape_.reset();
  if (!changed && !touch_.touching) escape_.wander(probe, position_);
  const bool slow = (position_ - before).norm() <= kFast * probe.radius();
  if (!changed && slow && touch_.is_held() &&
      escape_.is_trapped(probe, position_, touch_.normal, hip)) {
    spring_.leave(position_, spring_.stiffness());
    release(hip);
    contact = {.iterations = contact.iterations, .notes = contact.notes | ContactNote::freed};
  }
  const double stretch = (hip - position_).norm();
  const bool hard = touch_.touching && stretch > Limit::kFar * radius_ &&
                    options_.stiffness * stretch > Limit::kHardest;
  if (!spring_.hold_away(hard && probe.is_free({hip, 0}), dt)) return;
  contact.notes |= ContactNote::freed;
  if (spring_.stiffness() <= kFaded * options_.stiffness) release(hip);
}

// Ends a contact that is lost, and never takes the proxy through what cannot be found. From a free
// position it goes to the first contact; from inside only when the hand has come out again in front
// of where it went in. Until then the proxy waits there, without force.
void Proxy::Inside::let_go(Probe& probe, const Eigen::Vector3d& hip) noexcept {
  if (!spring_.is_lost()) return;
  if (!probe.inside(position_)) return release(first_contact(probe, position_, hip).position);
  if ((hip - position_).dot(touch_.normal) >= 0 && !probe.inside(hip)) release(hip);
}

}  // namespace palpate
