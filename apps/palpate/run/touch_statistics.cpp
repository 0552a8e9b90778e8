#include "apps/palpate/run/touch_statistics.hpp"

#include <algorithm>
#include <limits>

#include "palpate/servo/servo.hpp"

namespace palpate::app {

namespace {

constexpr std::array<ContactNote, 6> kContactNotes = {
    ContactNote::sweep_truncated, ContactNote::lost,  ContactNote::not_converged,
    ContactNote::reanchored,      ContactNote::fault, ContactNote::fell};
constexpr std::array<FieldNote, 5> kFieldNotes = {FieldNote::thinned, FieldNote::no_surface,
                                                  FieldNote::tool_too_large, FieldNote::work_spent,
                                                  FieldNote::behind};

constexpr std::array<NoteText, TouchStatistics::kNotes> kTexts = {{
    {"sweep_truncated",
     "the hand moved too far for one step, so the proxy caught up in the next ones; move slower or "
     "give shorter steps"},
    {"lost",
     "no surface could be found near the proxy, so the force faded; a larger --radius closes "
     "holes"},
    {"not_converged",
     "the proxy's iterations ran out before the closest point; it goes on in the next step"},
    {"reanchored", "the surface had moved over the proxy, which was taken along"},
    {"fault",
     "the hand or the surface was nowhere (not finite, or beyond 1e9 m from the origin), so the "
     "force "
     "was zero from there on; repair the trajectory or --pose"},
    {"fell",
     "the surface gave way: the hand came off an edge or through a gap (a larger --radius closes "
     "gaps), or what it touched had gone"},
    {"thinned",
     "more points than the patch holds lay near the tool, so some were left out; give a smaller "
     "--radius or a larger --voxel"},
    {"no_surface", "no source had a surface (yet)"},
    {"tool_too_large",
     "the tool is too large for the surface's R, so it counted for less; give a smaller "
     "--tool-radius"},
    {"work_spent",
     "looking for points took all the work that a step may do, so the proxy stopped short; give a "
     "larger --voxel, or clip the cloud"},
    {"behind",
     "the tool was behind what a camera sees, on the side that it never saw, which holds nothing"},
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

void TouchStatistics::add(const TouchStep& step) {
  const Contact& contact = step.contact;
  const bool first = steps_ == 0;
  if (first) first_time_ = step.time;
  if (!first) {
    const Eigen::Vector3d way = (step.hip - step.shift) - (last_.hip - last_.shift);  // the hand's
    given_energy_ += last_.contact.force.dot(way);
    path_energy_ += 0.5 * (last_.contact.force + contact.force).dot(way);
    largest_jump_ = std::max(largest_jump_, (contact.force - last_.contact.force).norm());
  }
  if (contact.touching) {
    ++touching_;
    if (first || !last_.contact.touching) ++contacts_;
  }
  largest_force_ = std::max(largest_force_, contact.force.norm());
  for (std::size_t i = 0; i < kContactNotes.size(); ++i) {
    if (has(contact.notes, kContactNotes[i])) ++notes_[i];
  }
  for (std::size_t i = 0; i < kFieldNotes.size(); ++i) {
    if (has(step.notes, kFieldNotes[i])) ++notes_[kContactNotes.size() + i];
  }
  times_.add(1e-6 * step.microseconds);
  ++steps_;
  last_ = step;
}

std::size_t TouchStatistics::faults() const {
  constexpr std::size_t kFault = 4;
  static_assert(kContactNotes[kFault] == ContactNote::fault);
  return notes_[kFault];
}

StepTimes TouchStatistics::times() const {
  const auto quantile = [this](double share) { return 1e6 * times_.quantile(share); };
  return {quantile(0.5), quantile(0.99), quantile(0.999), 1e6 * times_.longest};
}

const NoteText& note_text(std::size_t note) {
  return kTexts[note];
}

Unguarded::Unguarded(const GuardOptions& guard, const DeviceInfo& device, double scale)
    : guard_(limits_for(guard, device, scale)) {}

void Unguarded::add(const TouchStep& step) {
  GuardInput input;
  input.force = step.contact.force;
  input.normal = step.contact.normal;
  input.drift = step.contact.drift;
  input.hip = step.hip;
  input.stiffness = step.contact.stiffness;
  input.dt = counts().steps > 0 ? step.time - last_.time : 0;
  static_cast<void>(guard_.pass(input));
  if (has(guard_.state().notes, GuardNote::slewed)) {
    const double change = (step.contact.force - last_.contact.force).norm();
    largest_change_ = std::max(largest_change_, change);
  }
  last_ = step;
}

}  // namespace palpate::app
