// Counts what happens in the steps of a run.
#include "apps/palpate/run/touch_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/turn.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

namespace {

// A note of a contact or of a field.
struct Note {
  const char* name;
  const char* text;
  ContactNote contact;
  FieldNote field;
  const char* of_tool = nullptr;  // the text where it is another for a tool that turns

  [[nodiscard]] bool is_in(const ServoState& step) const {
    return has(step.contact.notes, contact) || has(step.field_notes, field);
  }
};

constexpr std::array<Note, 17> kNotes = {{
    {"sweep_truncated",
     "the hand moved too far in one step, so the proxy caught up over the next steps; move slower "
     "or use shorter steps",
     ContactNote::sweep_truncated, FieldNote::none,
     "the tool could not follow the hand within one step, as with a fast hand or over an edge, so "
     "it went on in the next steps; move slower or press less deep"},
    {"lost",
     "no surface was found near the proxy, so the force faded; a larger --radius closes holes",
     ContactNote::lost, FieldNote::none},
    {"not_converged",
     "the proxy reached its iteration limit before the closest point; it continues in the next "
     "step",
     ContactNote::not_converged, FieldNote::none},
    {"reanchored", "the surface moved past the proxy, so the proxy was moved back onto it",
     ContactNote::reanchored, FieldNote::none},
    {"fault",
     "a hand or surface position was not finite or beyond 1e9 m, so the force was zero from then "
     "on; fix the trajectory or --pose",
     ContactNote::fault, FieldNote::none},
    {"softer",
     "the surface was softer than requested: stiffness rises only as fast as the hand's motion "
     "supplies the energy",
     ContactNote::softer, FieldNote::none},
    {"fell",
     "contact was lost: the hand slid off an edge or went through a gap (a larger --radius closes "
     "gaps), or the touched surface disappeared",
     ContactNote::fell, FieldNote::none},
    {"freed",
     "the hand was held in free air, far from where it touched, so it was let go; it went through "
     "a "
     "hole or something thin",
     ContactNote::freed, FieldNote::none,
     "the tool was held in free air, or hard inside of something, so it was let go; something went "
     "between its samples (a smaller --tool-spacing helps), or a surface came around it"},
    {"inside",
     "the tool was inside the surface or across it where it began or was let go, so it touched "
     "nothing until it had been outside; begin farther away",
     ContactNote::inside, FieldNote::none},
    {"thinned",
     "there were more points near the tool than the patch holds, so some were ignored; give a "
     "smaller --radius or a larger --voxel",
     ContactNote::none, FieldNote::thinned},
    {"no_surface", "no source had a surface (yet)", ContactNote::none, FieldNote::no_surface},
    {"time_not_finite",
     "a timestamp was not finite, so the surface was not updated; fix the device's or the "
     "recording's clock",
     ContactNote::none, FieldNote::time_not_finite},
    {"other_kernel",
     "the points were prepared for a different kernel than the field uses; prepare them with the "
     "same kernel",
     ContactNote::none, FieldNote::other_kernel},
    {"tool_too_large",
     "the tool is too large for the surface's R, so a smaller radius was used; give a smaller "
     "--tool-radius",
     ContactNote::none, FieldNote::tool_too_large},
    {"work_spent",
     "the point search reached its work limit for one step, so the proxy stopped early; give a "
     "larger --voxel, or crop the cloud",
     ContactNote::none, FieldNote::work_spent},
    {"behind",
     "the tool was behind the surface that a camera sees; the unseen side exerts no force",
     ContactNote::none, FieldNote::behind,
     "a part of the tool was behind the surface that a camera sees; there the unseen side exerts "
     "no force"},
    {"not_loaded",
     "the tool was where the cloud was not prepared yet, so there was no surface; move more slowly "
     "until all of it is",
     ContactNote::none, FieldNote::not_loaded},
}};

// Simulated steps may be as far apart as the rows of a trajectory: that is no silence.
GuardOptions limits_for(const GuardOptions& guard, const DeviceInfo& device, double scale) {
  GuardOptions limits = guard_for(device, guard);
  limits.damping = 0;
  limits.soft_start = 0;
  limits.silence = std::numeric_limits<double>::infinity();
  return in_world(limits, scale);
}

}  // namespace

void TouchStatistics::add(const ServoState& step) {
  const Contact& contact = step.contact;
  const bool first = steps_ == 0;
  if (first) first_time_ = step.time;
  if (!first) {
    Eigen::Vector3d path = (step.hip - step.shift) - (last_.hip - last_.shift);  // the hand's
    const Eigen::Vector3d turn = turn_between(last_.orientation, step.orientation);
    // What a wrist that feels no torque has the surface do is no gift to the hand.
    if (!step.wrench.torque.isZero(0)) path -= step.contact.drift * (step.time - last_.time);
    given_energy_ += last_.force.dot(path) + last_.torque.dot(turn);
    path_energy_ +=
        0.5 * ((last_.force + step.force).dot(path) + (last_.torque + step.torque).dot(turn));
    largest_.jump = std::max(largest_.jump, (step.force - last_.force).norm());
  }
  if (contact.touching) {
    ++touching_;
    if (first || !last_.contact.touching) ++contacts_;
  }
  largest_.force = std::max(largest_.force, step.force.norm());
  largest_.torque = std::max(largest_.torque, step.wrench.torque.norm());
  largest_.grip = std::max(largest_.grip, std::abs(step.wrench.grip));
  static_assert(std::tuple_size_v<decltype(notes_)> == kNotes.size());
  for (std::size_t i = 0; i < kNotes.size(); ++i) notes_[i] += kNotes[i].is_in(step) ? 1 : 0;
  if (has(contact.notes, ContactNote::fault)) ++faults_;
  times_.add(step.timing.computing);
  ++steps_;
  last_ = step;
}

std::vector<CountedNote> TouchStatistics::notes(bool of_tool) const {
  std::vector<CountedNote> counted;
  for (std::size_t i = 0; i < kNotes.size(); ++i) {
    const Note& note = kNotes[i];
    const char* const text = of_tool && note.of_tool ? note.of_tool : note.text;
    if (notes_[i] > 0) counted.push_back({note.name, text, notes_[i]});
  }
  return counted;
}

StepTimes TouchStatistics::times() const {
  const auto quantile = [this](double share) { return 1e6 * times_.quantile(share); };
  return {quantile(0.5), quantile(0.99), quantile(0.999), 1e6 * times_.longest};
}

Unguarded::Unguarded(const GuardOptions& guard, const DeviceInfo& device, double scale)
    : guard_(limits_for(guard, device, scale)) {}

void Unguarded::add(const ServoState& step) {
  Guard::Input input;
  input.force = step.force;
  input.normal = step.contact.normal;
  input.drift = step.contact.drift;
  input.hip = step.hip;
  input.stiffness = step.contact.stiffness;
  input.dt = counts().steps > 0 ? step.time - last_.time : 0;
  static_cast<void>(guard_.pass(input));
  if (has(guard_.state().notes, GuardNote::slewed)) {
    const double change = (step.force - last_.force).norm();
    largest_change_ = std::max(largest_change_, change);
  }
  last_ = step;
}

}  // namespace palpate::app
