#include "viewer/state_source.hpp"

#include <algorithm>
#include <array>

namespace palpate::viewer {
namespace {

constexpr double kRateTime = 0.5;  // s that a rate is counted over

std::array<float, 2> quantiles(const Durations& now, Durations& before) {
  const Durations since = now.since(before);
  before = now;
  return {static_cast<float>(since.quantile(0.5)), static_cast<float>(since.quantile(0.99))};
}

}  // namespace

std::optional<StateMessage> StateSource::next(double now, double radius, bool taken) {
  const ServoState state = servo_.state();
  if (state.step == 0) return std::nullopt;
  StateMessage message;
  message.device = device_;
  message.flags = flags(state, taken);
  message.time = state.time;
  const bool hip_is_known = state.hip.allFinite();  // no fault of the device
  message.hip = ((hip_is_known ? state.hip : state.contact.proxy) - origin_).cast<float>();
  message.proxy = (state.contact.proxy - origin_).cast<float>();
  message.normal = state.contact.normal.cast<float>();
  message.force = state.force.cast<float>();
  message.radius = static_cast<float>(radius);
  message.rate = static_cast<float>(rate(now, state.step));
  message.computing = quantiles(servo_.computing(), computing_);
  message.lateness = quantiles(servo_.lateness(), lateness_);
  message.interval = static_cast<float>(interval(state));
  message.forces = forces_until(state.step);
  if (servo_.device().info().has_orientation) {
    message.orientation = state.orientation.cast<float>();
  }
  return message;
}

// On average since the message before, so that samples do not overlap where steps came unevenly.
double StateSource::interval(const ServoState& state) {
  const std::uint64_t steps = state.step - step_;
  const double mean = steps > 0 ? (state.time - time_) / static_cast<double>(steps) : 0;
  const bool known = step_ > 0 && mean > 0;
  step_ = state.step;
  time_ = state.time;
  return known ? mean : state.dt;
}

// What was felt after the state was read waits for the next message.
std::vector<Eigen::Vector3f> StateSource::forces_until(std::uint64_t step) {
  std::vector<Eigen::Vector3f> forces = servo_.recent_forces().since(forces_seen_);
  if (forces_seen_ <= step) return forces;
  const std::uint64_t later = std::min<std::uint64_t>(forces_seen_ - step, forces.size());
  forces.resize(forces.size() - static_cast<std::size_t>(later));
  forces_seen_ -= later;
  return forces;
}

// What the guard did in any step since the message before, not in the last one alone.
std::uint32_t StateSource::flags(const ServoState& state, bool taken) {
  const GuardCounts& counts = state.guard.counts;
  std::uint32_t flags = 0;
  const auto set = [&flags](bool is, std::uint32_t flag) { flags |= is ? flag : 0; };
  set(state.contact.touching, state_flag::kTouching);
  set(state.paused, state_flag::kPaused);
  set(taken, state_flag::kTaken);
  set(counts.clamped > counts_.clamped, state_flag::kClamped);
  set(counts.slewed > counts_.slewed, state_flag::kSlewed);
  set(counts.silences > counts_.silences, state_flag::kWatchdog);
  set(counts.braked > counts_.braked, state_flag::kBraked);
  set(counts.starting > counts_.starting, state_flag::kStarting);
  set(counts.softened > counts_.softened, state_flag::kSoftened);
  set(state.clutched, state_flag::kClutched);
  set(state.guard.fault != GuardFault::none, state_flag::kFault);
  set(has(state.field_notes, FieldNote::thinned), state_flag::kThinned);
  set(has(state.contact.notes, ContactNote::softer), state_flag::kSofter);
  counts_ = counts;
  return flags;
}

double StateSource::rate(double now, std::uint64_t step) {
  steps_.emplace_back(now, step);
  while (steps_.size() > 2 && now - steps_[1].first >= kRateTime) steps_.pop_front();
  const double time = now - steps_.front().first;
  return time > 0 ? static_cast<double>(step - steps_.front().second) / time : 0;
}

}  // namespace palpate::viewer
