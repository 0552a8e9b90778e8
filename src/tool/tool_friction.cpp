// Solves for normal and tangential forces of all contacts at once, one contact after the other
// (Jean 1999, "The non-smooth contact dynamics method"). What was held in the step before begins.
#include "tool/tool_friction.hpp"

#include <algorithm>
#include <cmath>

#include "tool/constraint_list.hpp"

namespace palpate {
namespace {

// What is not held after so many sweeps breaks loose: a box did so at 0.92 of its cone after 32.
constexpr int kPatience = 128;
constexpr int kSweeps = 32;  // over the contacts; what is left open is taken up in the next step
// m: a sweep that changes the motion by less is the last one; in a second at 1 kHz a tool at rest
// creeps by a micrometre
constexpr double kStill = 1e-9;
// m in a step: what slides by less rests, as sweeps come that near. At 1 kHz it is 0.1 mm/s, slower
// than a hand that is held still.
constexpr double kCreep = 1e-7;

}  // namespace

ToolFriction::Contact ToolFriction::contact_of(const Look& look,
                                               const Constraint& constraint) const noexcept {
  Contact contact;
  contact.sample = constraint.sample;
  contact.normal = constraint.normal;
  contact.bound = constraint.bound;
  if (contact.sample < 0) return contact;  // no surface
  const Tool::Point& sample = look.tool.samples()[static_cast<std::size_t>(contact.sample)];
  const Eigen::Vector3d normal = constraint.normal.head<3>();
  const Eigen::Vector3d at =
      look.tool.in_world(sample.position, sample.side, look.pose) - sample.radius * normal;
  contact.axes.col(0) = normal.unitOrthogonal();
  contact.axes.col(1) = normal.cross(contact.axes.col(0));
  for (int i = 0; i < 2; ++i) {
    contact.along.col(i) =
        constraint_on(look.tool, contact.sample, at, contact.axes.col(i), look.pose, look.metric)
            .normal;
  }
  contact.moved = contact.along.transpose() * look.metric.between(start_, look.pose);
  const Eigen::Matrix2d square = contact.along.transpose() * contact.along;
  contact.weight = std::max(square(0, 0), square(1, 1)) + std::abs(square(0, 1));
  if (const Contact* const before = contacts_.of(contact.sample)) {
    contact.held = contact.axes.transpose() * (before->axes * before->held);
  }
  return contact;
}

// Null: it has none.
const ToolFriction::Contact* ToolFriction::Contacts::of(int sample) const noexcept {
  const auto found = std::ranges::find(span(), sample, &Contact::sample);
  return found == span().end() ? nullptr : &*found;
}

bool ToolFriction::add(const Look& look, const LeastMotion& least) noexcept {
  const std::span<Contact> all = contacts_.span();
  contacts_.count = static_cast<std::size_t>(
      std::remove_if(all.begin(), all.end(), [](const Contact& c) { return !(c.pressed > 0); }) -
      all.begin());
  const std::size_t known = contacts_.count;
  for (int k = 0; k < least.count; ++k) {
    const ActiveConstraint& active = least.active[static_cast<std::size_t>(k)];
    const Constraint& constraint = look.constraints[static_cast<std::size_t>(active.index)];
    if (contacts_.of(constraint.sample) == nullptr) {
      contacts_.append(contact_of(look, constraint));
    }
  }
  return contacts_.count > known;
}

// A constraint that holds with equality, as far as it pushes. Returns the length of the change.
double ToolFriction::press(Contact& contact, Motion& motion) const noexcept {
  const double lacking = contact.bound - contact.normal.dot(motion);
  const double square = contact.normal.squaredNorm();
  const double change = std::max(-contact.pressed, lacking / square);
  contact.pressed += change;
  motion += change * contact.normal;
  return std::abs(change) * std::sqrt(square);
}

// Holds the contact where it was when the step began, or as far as the cone lets it; the viscous
// part is implicit in time.
double ToolFriction::rub(Contact& contact, double coefficient, Motion& motion) const noexcept {
  const Along slip = contact.moved + contact.along.transpose() * motion;
  const Along unheld = slip - contact.weight * contact.held;
  const double most = coefficient * contact.pressed;
  Along held = -unheld / contact.weight;
  const double length = held.norm();
  if (length > most) {
    const Along dry = most / length * held;
    const double viscous = law_.stiffness > 0 ? law_.viscous_rate / law_.stiffness : 0;
    held = dry - viscous / (1 + viscous * contact.weight) * (unheld + contact.weight * dry);
  }
  const Along change = held - contact.held;
  contact.held = held;
  motion += contact.along * change;
  return (contact.along * change).norm();
}

// True: a contact slides.
bool ToolFriction::relax(double coefficient, int sweeps, Motion& motion) noexcept {
  slides_ = false;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double changed = 0;
    for (Contact& contact : contacts_.span()) {
      changed += press(contact, motion);
      if (contact.sample >= 0) changed += rub(contact, coefficient, motion);
    }
    if (!(changed > kStill)) break;
  }
  for (const Contact& contact : contacts()) {
    slides_ = slides_ || slip_of(contact, motion).norm() > kCreep;
  }
  return slides_;
}

// How far a contact that presses moves along the surface in this step, m.
ToolFriction::Along ToolFriction::slip_of(const Contact& contact,
                                          const Motion& motion) const noexcept {
  if (contact.sample < 0 || !(contact.pressed > 0)) return Along::Zero();
  return contact.moved + contact.along.transpose() * motion;
}

double ToolFriction::dissipated(const Metric& metric, const Pose& end) const noexcept {
  const Motion moved = metric.between(start_, end);
  double sum = 0;
  for (const Contact& contact : contacts()) {
    if (contact.sample < 0 || !(contact.pressed > 0)) continue;
    sum += law_.stiffness * std::max(0.0, -contact.held.dot(contact.along.transpose() * moved));
  }
  return sum;
}

Motion ToolFriction::hold(const Look& look, const LeastMotion& least) noexcept {
  slid_ = slid_ || slides_;
  Contacts placed;
  for (int k = 0; k < least.count; ++k) {
    const ActiveConstraint& active = least.active[static_cast<std::size_t>(k)];
    Contact contact = contact_of(look, look.constraints[static_cast<std::size_t>(active.index)]);
    contact.pressed = active.multiplier;
    placed.append(contact);
  }
  for (const Constraint& near : look.constraints) {
    const bool known = near.sample >= 0 && contacts_.of(near.sample) != nullptr;
    if (known && placed.of(near.sample) == nullptr) placed.append(contact_of(look, near));
  }
  contacts_ = placed;
  return hold_again(look);
}

Motion ToolFriction::hold_again(const Look& look) noexcept {
  Motion motion = look.wanted;
  for (const Contact& contact : contacts()) {
    motion += contact.pressed * contact.normal;
    if (contact.sample >= 0) motion += contact.along * contact.held;
  }
  const bool at_rest = !slid_ && !relax(law_.static_coefficient, kPatience, motion);
  if (!at_rest) static_cast<void>(relax(law_.dynamic_coefficient, kSweeps, motion));
  Motion wanted = look.wanted;
  for (const Contact& contact : contacts()) {
    if (contact.sample >= 0) wanted += contact.along * contact.held;
  }
  return wanted;
}

}  // namespace palpate
