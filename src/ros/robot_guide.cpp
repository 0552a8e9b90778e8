// Decides where a robot is sent, from what the sources report of proxy, hand and robot position.
#include "ros/robot_guide.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "palpate/base/error.hpp"
#include "ros/robot_limits.hpp"

namespace palpate::ros {
namespace {

using Eigen::Vector3d;
constexpr Reason kMoved = "a surface moved over the tool";
constexpr Reason kLarge = "the tool is too large for the surface: give a larger --radius";
constexpr Reason kNotLoaded = "the cloud is not prepared yet where the tool is";
constexpr Reason kApart = "the tool has to come back to where the robot is";

// m from the robot to the first checked position of its path, and between them; a finger is thicker
// (judgement)
constexpr double kPathStep = 0.005;
constexpr double kJoin = 0.02;  // m; how exactly a hand returns to a position (judgement)
// s counted between two looks at most, so that a retreat makes no leap after a pause (judgement)
constexpr double kLongestStep = 0.1;
// s without news of the hand that change nothing: no hand gets anywhere in it (0.5 m/s: 10 mm, as
// kJump)
constexpr double kLateHand = 0.02;

// Why the proxy's own path no longer proves that the robot can follow it; empty if it still does.
Reason broken_path(const ServoState& state) {
  if (has(state.field_notes, FieldNote::no_surface)) return "no source has a surface";
  if (has(state.field_notes, FieldNote::not_loaded)) return kNotLoaded;
  if (has(state.field_notes, FieldNote::behind)) return kBehind;
  if (has(state.contact.notes, ContactNote::lost | ContactNote::fell | ContactNote::freed))
    return "the surface let the tool go";
  return {};
}

std::vector<const Source*> sources_of(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<const Source*> found;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Source& source = scene.source(i);
    if (names.empty() || std::ranges::count(names, source.name()) > 0) found.push_back(&source);
  }
  for (const std::string& name : names) {
    const auto is_it = [&](const Source* source) { return source->name() == name; };
    if (std::ranges::none_of(found, is_it))
      throw Error(fmt::format("robot: no source is called '{}'; name one of the run's", name));
  }
  return found;
}

}  // namespace

RobotGuide::RobotGuide(const Scene& scene, const RosBridgeOptions::Robot& options,
                       double tool_radius)
    : options_(options), tool_radius_(tool_radius), sources_(sources_of(scene, options.sources)) {
  for (const Source* source : sources_) (void)source->seen({}, 0);  // requests frames
}

// The highest answer of the sources counts, in the order of Seen::Verdict. But free yields to solid
// where its frame is older than kStays, or than the moment when the solid came. `memory`: of that
// moment, of the tool or the robot, which stay where they are for long enough; it is renewed. The
// hand and the path bring copies.
RobotGuide::Verdict RobotGuide::judge(const Vector3d& x, double now, Memory& memory) const {
  const auto rank = [](const Seen& seen) {
    return std::tuple(seen.verdict, -seen.behind, -seen.age);
  };
  Verdict best;
  Verdict solid;
  Memory last = (x - memory.where).norm() <= kJoin ? memory : Memory{};
  for (const Source* source : sources_) {
    std::optional<Seen> seen = source->seen({x, tool_radius_}, now);
    if (!seen && !source->points()) seen = {.verdict = Seen::Verdict::old};  // nothing came yet
    if (!seen) continue;
    if (best.source == nullptr || rank(*seen) > rank(best.seen)) best = {source, *seen};
    if (seen->verdict != Seen::Verdict::solid) continue;
    const double stamp = now - seen->age;
    if (seen->came) {
      last = stamp > last.came ? Memory{source, stamp, x} : Memory{last.source, last.came, x};
      memory = last;
    }
    if (solid.source == nullptr || last.source == source) solid = {source, *seen};
  }
  const bool outdated = now - best.seen.age < last.came || best.seen.age > kStays;
  return best.free() && solid.source != nullptr && outdated ? solid : best;
}

// Largest lag of the rendered surface behind the seen one, m. The seen one moves on while a frame
// is prepared; the rendered one takes an interval to get there, and waits if the next frame is
// late. In one frame the lag grows by at most one frame's motion; more has another cause.
double RobotGuide::allowed_ahead(const ServoState& state, const Verdict& proxy, double dt) {
  const double interval = proxy.source->state().interval;
  const double speed = state.contact.touching ? state.contact.drift.dot(proxy.seen.towards) : 0;
  const double before = interval > 0 ? speed_ * std::max(1 - dt / (2 * interval), 0.0) : 0;
  speed_ = std::max({speed, before, 0.0});
  const double lag = speed_ * (proxy.seen.age + 2 * interval);
  return kJump + std::min(lag, ahead_ + speed_ * interval);
}

// Is the straight path from the robot to the target seen to be free? A surface may have come over
// the robot in one frame, as far as it does slowly: as near to it the path may be so deep in it.
bool RobotGuide::may_go_to(const Vector3d& target, double now) const {
  if (!robot_.position) return true;
  const Vector3d path = target - *robot_.position;
  // Balls half a radius apart leave 3 % of the radius between them.
  const double step = std::max(kPathStep, tool_radius_ / 2);
  Memory memory = robot_.memory;
  for (double gone = kPathStep; gone < path.norm(); gone += step) {
    const Verdict verdict = judge(*robot_.position + gone * path.normalized(), now, memory);
    const bool leaves = gone <= kJump && verdict.solid() && verdict.seen.behind <= kJump;
    if (!verdict.free() && !leaves) return false;
  }
  return true;
}

RobotGuide::Answer RobotGuide::look(const ServoState& state, double now, bool pressed) {
  const double dt = std::clamp(now - std::exchange(looked_, now), 0.0, kLongestStep);
  if (options_.hand) return follow(state.hip, now);
  if (has(state.field_notes, FieldNote::tool_too_large)) {
    pause();
    return {.reason = kLarge, .why = std::string(kLarge)};
  }
  const Verdict proxy = judge(state.contact.proxy, now, tool_);
  if (proxy.source == nullptr) return without_view(state, dt, pressed);
  // What a cloud has there may hold the tool later, whatever a camera sees.
  if (has(state.field_notes, FieldNote::not_loaded)) {
    pause();
    return {.reason = kNotLoaded, .why = std::string(kNotLoaded)};
  }
  const double ahead = proxy.solid() ? proxy.seen.behind : 0;
  // Only a surface that the robot has followed may lag behind the seen one.
  const bool lags = robot_.position && (follows_ || now - followed_ <= kFreeFor);
  const double allowed = allowed_ahead(state, proxy, dt);
  const bool free = proxy.free() || (proxy.solid() && lags && ahead <= allowed);
  if (proxy.solid() && !free) followed_ = -kNever;
  Memory memory = tool_;
  note(free ? judge(state.hip, now, memory) : proxy, free, dt, pressed);
  if (!follows_) return wait(proxy, now, dt);
  const Vector3d target = state.contact.proxy + proxy.seen.lift * proxy.seen.towards;
  if (!pressed && !may_go_to(target, now)) return wait(proxy, now, dt);
  return follow(target, now - proxy.seen.age, ahead);
}

// After a loss of sight shorter than kFreeFor it goes on at once.
bool RobotGuide::may_start(bool pressed) const {
  return pressed || free_for_.value_or(0) >= kFreeFor || looked_ - followed_ <= kFreeFor;
}

// The first look counts no time.
void RobotGuide::count_free(double dt) {
  free_for_ = free_for_ ? *free_for_ + dt : 0;
}

// Stops following when the proxy is not free. Counts how long hand and proxy were seen free. A
// shorter loss of sight than kFreeFor suspends the count; `hand`: what is seen of the hand or,
// where the proxy is not free, of the proxy.
void RobotGuide::note(const Verdict& hand, bool proxy_free, double dt, bool pressed) {
  if (hand.sighted()) sighted_ = looked_;
  if (proxy_free && hand.free()) {
    count_free(dt);
  } else if (hand.sighted() || looked_ - sighted_ > kFreeFor) {
    free_for_.reset();
  }
  follows_ = proxy_free && (follows_ || may_start(pressed));
}

RobotGuide::Answer RobotGuide::follow(const Vector3d& target, double stamp, double ahead) {
  // It is where the tool is.
  robot_ = {.position = target, .memory = tool_, .clear = stamp, .seen = looked_};
  ahead_ = ahead;
  followed_ = looked_;
  return {.target = target};
}

void RobotGuide::pause() {
  forget();
  follows_ = false;
}

void RobotGuide::miss_hand(double now) {
  if (now - looked_ > kLateHand) forget();
}

void RobotGuide::is_at(const std::optional<Vector3d>& position) {
  robot_ = {.position = position, .memory = robot_.memory, .clear = -kNever, .seen = -kNever};
}

// Nothing was seen meanwhile.
void RobotGuide::forget() {
  is_at(robot_.position);
  free_for_.reset();
  followed_ = -kNever;
  ahead_ = 0;
}

// Clouds do not show what is free; only the tool's own path proves it. So the robot follows the
// tool until a surface comes over it or lets it go. It follows again once nothing has held the hand
// for kFreeFor and the tool is where the robot is.
RobotGuide::Answer RobotGuide::without_view(const ServoState& state, double dt, bool pressed) {
  const auto waits = [](Reason reason) {
    return Answer{.reason = reason, .why = std::string(reason)};
  };
  const Reason reason = broken_path(state);
  if (!reason.empty() && !robot_.position) return waits(reason);
  if (!reason.empty()) followed_ = -kNever;
  if (reason.empty() && !state.contact.touching) {
    count_free(dt);
  } else {
    free_for_.reset();
  }
  follows_ = reason.empty() && (follows_ || may_start(pressed));
  if (!follows_) return waits(reason.empty() ? kNotYet : reason);
  if (!pressed && robot_.position && (state.contact.proxy - *robot_.position).norm() > kJoin)
    return waits(kApart);
  // In the step in which a surface moved over it, it may still be a little inside.
  if (has(state.contact.notes, ContactNote::reanchored | ContactNote::not_converged))
    return waits(kMoved);
  return follow(state.contact.proxy, looked_);
}

}  // namespace palpate::ros
