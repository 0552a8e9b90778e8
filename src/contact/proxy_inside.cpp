// One step of the proxy: through free space, or along the surface, and what its spring does.
#include "contact/proxy_inside.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "contact/limit.hpp"
#include "contact/probe.hpp"

namespace palpate {
namespace {

constexpr double kLeastTime = 1e-9;    // s; friction divides by the time of a step
constexpr double kTextureStep = 0.25;  // of the wavelength, so that no sub-step skips a groove

bool in_range(const Eigen::Vector3d& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= Proxy::kLargestCoordinate;
}

// Clamps a share that a field gives: rounding or a wrong field may leave 0 to 1.
double factor(double value) {
  return value >= 0 ? std::min(value, 1.0) : 0.0;
}

Contact faulted(const Eigen::Vector3d& proxy) {
  Contact contact;
  contact.proxy = proxy;
  contact.notes = ContactNote::fault;
  return contact;
}

}  // namespace

void Proxy::Inside::reset(const Eigen::Vector3d& position) noexcept {
  fault_ = !in_range(position);
  started_ = !fault_;
  radius_ = 0;
  spring_.reset();
  escape_.reset();
  revision_.reset();
  release(fault_ ? Eigen::Vector3d::Zero().eval() : position);
  hand_ = position_;
}

Contact Proxy::Inside::step(const Field& field, const Eigen::Vector3d& hip, double dt) noexcept {
  if (!in_range(hip) || !std::isfinite(dt) || dt < 0) fault_ = true;
  if (fault_) return faulted(position_);
  if (!started_) reset(hip);
  Contact contact;
  Probe probe{field, options_.texture, radius_};
  const bool held = touch_.is_held();
  const Eigen::Vector3d before = position_;
  const Eigen::Vector3d side = touch_.normal;
  const EnergyTank tank = spring_.tank();
  if (!touch_.touching) follow(probe, hip, contact);
  if (touch_.touching) hold(probe, hip, std::max(dt, kLeastTime), contact);
  await(probe, before, side, held ? hand_ : touch_.pressed, hip);
  radius_ = probe.radius();
  const bool first = !revision_;  // step since a reset, which may put the proxy into a solid
  const bool changed = !first && probe.traits().revision != *revision_;
  free_hand(probe, before, hip, dt, contact, changed);
  revision_ = probe.traits().revision;
  field.end_step(position_, touch_.touching ? touch_.normal : Eigen::Vector3d::Zero().eval());
  contact.proxy = position_;
  contact.touching = touch_.is_held();
  contact.evaluations = probe.evaluations();
  const double jump = unexplained_jump(before, hip, dt);
  if (held && jump > Limit::kFall * (before - hand_).norm()) contact.notes |= ContactNote::fell;
  if (changed && jump > std::max(probe.traits().step, Limit::kFastest * dt)) {
    if (held) spring_.leave(before, tank.stiffness());
    take_over(held ? tank : spring_.tank(), hip, contact);
  } else if (!held && touch_.touching && !first && !changed) {
    // The surface may have come to the hand, and not the hand to it.
    if (initial_stiffness(position_, hip) < spring_.stiffness()) {
      take_over(spring_.tank(), hip, contact);
    }
  }
  spring_.add_fading(hip, dt, contact);
  if (!has(contact.notes, Limit::kUnfinished)) hand_ = hip;
  if (contact.force.allFinite() && in_range(position_)) return contact;
  fault_ = true;
  release(hip);
  return faulted(position_);
}

// How far the proxy went beyond what motion of hand and surface explains, m: on a plane no farther
// than the hand, on a bulge twice as far, up to half of its radius deep.
double Proxy::Inside::unexplained_jump(const Eigen::Vector3d& before, const Eigen::Vector3d& hip,
                                       double dt) const noexcept {
  const double explained = 2 * (hip - hand_).norm() + touch_.surface.velocity.norm() * dt;
  const double jump = ((touch_.waiting ? hip : position_) - before).norm() - explained;
  return jump > Limit::kLeastFall * radius_ ? jump : 0;
}

// Lets the contact that there is now go on with the tank of `before`.
void Proxy::Inside::take_over(const EnergyTank& before, const Eigen::Vector3d& hip,
                              Contact& contact) noexcept {
  spring_.go_on(before, touch_.is_held() ? initial_stiffness(position_, hip) : 0,
                touch_.waiting ? 0 : touch_.softened(options_), position_ - hip, contact);
}

// Free space: to the hand, or to the first contact on the path.
void Proxy::Inside::follow(Probe& probe, const Eigen::Vector3d& hip, Contact& contact) noexcept {
  if (path_is_free(probe, position_, hip)) return release(hip);
  if (standing_ == Standing::front && probe.inside(position_)) return touch(probe, position_, hip);
  const Sweep path = sweep(probe, position_, hip, standing_);
  if (path.end == Sweep::End::hit) return touch(probe, path.position, hip);
  if (path.end == Sweep::End::truncated) contact.notes |= ContactNote::sweep_truncated;
  release(path.position, path.standing);
}

// A spring that is stretched by more than the hand has moved begins as much softer.
double Proxy::Inside::initial_stiffness(const Eigen::Vector3d& position,
                                        const Eigen::Vector3d& hip) const noexcept {
  const double stretch = (position - hip).norm();
  const double moved = (hip - hand_).norm() + Limit::kLeastFall * radius_;
  return spring_.wanted(touch_.softened(options_)) * (stretch > moved ? moved / stretch : 1);
}

void Proxy::Inside::touch(Probe& probe, const Eigen::Vector3d& position,
                          const Eigen::Vector3d& hip) noexcept {
  release(position);
  touch_.touching = true;
  touch_.surface = probe.field().surface(position);
  radius_ = probe.radius();
  spring_.begin(initial_stiffness(position, hip));
}

void Proxy::Inside::release(const Eigen::Vector3d& position, Standing standing) noexcept {
  position_ = position;
  standing_ = standing;
  touch_.normal.setZero();
  touch_.side.setZero();
  spring_.rest();
  touch_.touching = false;
  touch_.sliding = false;
  search_ = {};
  touch_.waiting = false;
}

void Proxy::Inside::Search::cut_short(Contact& contact) noexcept {
  is_cut_short = true;
  contact.notes |= ContactNote::sweep_truncated;
}

void Proxy::Inside::hold(Probe& probe, const Eigen::Vector3d& hip, double dt,
                         Contact& contact) noexcept {
  const std::optional<SurfacePoint> at = find_surface(probe, hip, contact);
  if (!at) {
    if (touch_.is_held()) keep(probe, hip, dt, contact);
    return;
  }
  touch_.waiting = false;
  if (touch_.side.isZero(0)) touch_.side = at->normal;
  spring_.find();
  const FrictionLaw law = friction_law(options_.friction, factor(touch_.surface.friction_factor),
                                       spring_.stiffness(), dt);
  const SlideOptions options{.method = options_.method,
                             .max_iterations = options_.max_iterations,
                             .tangent_tolerance = options_.tangent_tolerance,
                             .longest_step = options_.texture.amplitude > 0
                                                 ? kTextureStep * options_.texture.wavelength
                                                 : 0,
                             .friction = law,
                             .moved = probe.traits().revision != revision_};
  const Slide motion = slide(probe, *at, hip, touch_.sliding, options);
  contact.iterations = motion.iterations;
  if (!settle(motion, contact)) return;
  // What goes farther than the hand explains was moved by a surface that folds.
  const double most = 2 * (hip - hand_).norm() + Limit::kLeastFall * radius_;
  if (motion.leapt || (position_ - at->position).norm() <= most) touch_.carry_side(at->normal);
  touch_.surface = probe.field().surface(position_);
  pull(hip, motion.dissipated, dt, contact);
}

// Where the surface is now, near where the proxy touched it. Empty: the contact ended, or is lost.
std::optional<SurfacePoint> Proxy::Inside::find_surface(Probe& probe, const Eigen::Vector3d& hip,
                                                        Contact& contact) noexcept {
  const Sample here = probe.sample(position_);
  const bool changed = probe.traits().revision != revision_;
  const bool moved = !search_.is_cut_short && surface_moved(probe, here, touch_.normal, changed);
  const double radius = probe.radius();  // at the proxy: Newton may end where it is another
  std::optional<SurfacePoint> at = project(probe, position_, here);
  const bool turned = changed && at && is_turned(*at, touch_.side);
  if (moved || turned) {
    const bool same = at && is_same_contact(*at, position_, touch_.side);
    bool cut = false;
    const auto found = same ? at : reanchor(probe, position_, touch_.side, radius, cut);
    // Else it may be the underside of something nearer, not yet swept, or a fold of the surface.
    if (cut || turned) at.reset();
    if (found) {
      at = found;
      contact.notes |= ContactNote::reanchored;
    }
  }
  if (at) {
    search_.looked = 0;
  } else if (!turned) {
    at = recover(probe, position_, touch_.normal, search_.looked);
  }
  search_.is_cut_short = false;
  if (at || !(here.value > 0) || here.averted) return at;
  const Sweep path = first_contact(probe, position_, hip);
  if (path.end == Sweep::End::hit) {
    touch_.side.setZero();  // another contact
    return land(probe, path);
  }
  if (path.end == Sweep::End::clear) {
    release(hip, path.standing);
  } else {
    search_.cut_short(contact);
    position_ = path.position;
  }
  return std::nullopt;
}

// Takes over where the motion ended. True while the proxy still touches.
bool Proxy::Inside::settle(const Slide& motion, Contact& contact) noexcept {
  if (motion.end == Slide::End::interrupted || motion.end == Slide::End::postponed) {
    search_.cut_short(contact);
  }
  if (motion.end == Slide::End::released || motion.end == Slide::End::interrupted) {
    release(motion.at.position, motion.standing);
    return false;
  }
  if (motion.end == Slide::End::unfinished) {
    contact.notes |= ContactNote::not_converged;
  }
  position_ = motion.at.position;
  touch_.normal = motion.at.normal;
  touch_.sliding = motion.sliding;
  contact.normal = touch_.normal;
  contact.sliding = touch_.sliding;
  return true;
}

void Proxy::Inside::pull(const Eigen::Vector3d& hip, double dissipated, double dt,
                         Contact& contact) noexcept {
  spring_.pull(touch_.softened(options_), position_ - hip, dissipated,
               {dt, dt / options_.rise_time}, contact);
  contact.drift = touch_.surface.velocity;
  contact.source = touch_.surface.source;
}

void Proxy::Inside::Touch::carry_side(const Eigen::Vector3d& from) noexcept {
  if (normal != from) {
    side = (Eigen::Quaterniond::FromTwoVectors(from, normal) * side).normalized();
  }
}

double Proxy::Inside::Touch::softened(const ProxyOptions& options) const noexcept {
  double presence = factor(surface.presence);
  if (std::isfinite(options.rise_time)) presence = presence > kFaded ? 1 : 0;
  return options.stiffness * factor(surface.stiffness_factor) * presence;
}

}  // namespace palpate
