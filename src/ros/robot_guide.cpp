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
constexpr Reason kLags = "the tool does not keep up with the hand";
constexpr Reason kLarge = "the tool is too large for the surface: give a larger --radius";
constexpr Reason kNotLoaded = "the cloud is not prepared yet where the tool is";
constexpr Reason kApart = "the tool has to come back to where the robot is";
constexpr Reason kPath = "the way to the tool is not seen free";
constexpr Reason kNotYet = "hand and tool have to be free for half a second";

// m from the robot to the first checked position of its path, and between them; a finger is thicker
// (judgement)
constexpr double kPathStep = 0.005;
// Balls that are looked at on a path at most, at all of its positions. 10 000 take 4 ms, and 12 on
// a busy machine: a path takes some 30 ms at most, a camera's interval. By so much what was seen of
// the target is older when it is told, and so long frames wait.
constexpr double kMostBalls = 25'000;
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
  if (has(state.contact.notes,
          ContactNote::lost | ContactNote::fell | ContactNote::freed | ContactNote::inside))
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

RobotGuide::RobotGuide(const Scene& scene, const RosBridgeOptions::Robot& options, RobotShape shape)
    : options_(options), shape_(std::move(shape)), sources_(sources_of(scene, options.sources)) {
  for (const Source* source : sources_) (void)source->seen(Ball{}, 0);  // requests frames
}

// The highest answer of the sources counts, in the order of Seen::Verdict. But free yields to solid
// where its frame is older than kStays, or than the moment when the solid came. `memory`: of that
// moment, of the tool or the robot, which stay where they are for long enough; it is renewed. The
// hand and the path bring copies. Where a part of a wide tool that is solid is not seen, all of it
// counts as not seen: one camera has to show all. Of a ball one ray does.
RobotGuide::Verdict RobotGuide::judge(const Pose& pose, double now, Memory& memory) const {
  const std::vector<Ball> balls = shape_.at(pose);
  const auto rank = [](const Seen& seen) {
    return std::tuple(seen.verdict, -seen.behind, -seen.age);
  };
  Verdict best;
  Verdict solid;
  Memory last = shape_.way(memory.where, pose) <= kJoin ? memory : Memory{};
  for (const Source* source : sources_) {
    std::optional<Seen> seen = source->seen(balls, now);
    if (!seen && !source->points()) seen = {.verdict = Seen::Verdict::old};  // nothing came yet
    if (!seen) continue;
    if (best.source == nullptr || rank(*seen) > rank(best.seen)) best = {source, *seen};
    if (seen->verdict != Seen::Verdict::solid) continue;
    const double stamp = now - seen->age;
    if (seen->came) {
      last = stamp > last.came ? Memory{source, stamp, pose} : Memory{last.source, last.came, pose};
      memory = last;
    }
    if (solid.source == nullptr || last.source == source) solid = {source, *seen};
  }
  const bool outdated = now - best.seen.age < last.came || best.seen.age > kStays;
  Verdict verdict = best.free() && solid.source != nullptr && outdated ? solid : best;
  if (verdict.solid() && shape_.is_wide())
    verdict.seen.verdict = std::min(verdict.seen.verdict, verdict.seen.rest);
  return verdict;
}

// Largest lag of the rendered surface behind the seen one, m. The seen one moves on while a frame
// is prepared; the rendered one takes an interval to get there, and waits if the next frame is
// late. In one frame the lag grows by at most one frame's motion; more has another cause. A wide
// tool's drift is no surface's.
double RobotGuide::allowed_ahead(const ServoState& state, const Verdict& proxy, double dt) {
  const double interval = proxy.source->state().interval;
  const bool moved = state.contact.touching && !shape_.is_wide();
  const double speed = moved ? state.contact.drift.dot(proxy.seen.towards) : 0;
  const double before = interval > 0 ? speed_ * std::max(1 - dt / (2 * interval), 0.0) : 0;
  speed_ = std::max({speed, before, 0.0});
  const double lag = speed_ * (proxy.seen.age + 2 * interval);
  return kJump + std::min(lag, ahead_ + speed_ * interval);
}

// Is it seen so late that tool or surface have gone on by more than a surface may come in a frame?
// That a camera's own frames are older is allowed for; a busy machine's are not.
bool RobotGuide::is_outrun(const Seen& seen, const ServoState& state) const {
  return seen.late * std::max(state.velocity.norm(), speed_) > kJump;
}

// Why the robot may not go straight to the target; empty: that path is seen to be free. A surface
// may have come over the robot in one frame, as far as it does slowly: as near to it the path may
// be so deep in it.
Reason RobotGuide::hindrance(const Pose& target, double now) const {
  if (!robot_.pose) return {};
  const double way = shape_.way(*robot_.pose, target);
  // Balls half a radius apart leave 3 % of the radius between them.
  const double step = std::max(kPathStep, shape_.thinnest() / 2);
  const double places = std::ceil((way - kPathStep) / step);
  if (places * static_cast<double>(shape_.size()) > kMostBalls) return kApart;
  Memory memory = robot_.memory;
  for (double gone = kPathStep; gone < way; gone += step) {
    const Pose there = RobotShape::between(*robot_.pose, target, gone / way);
    const Verdict verdict = judge(there, now, memory);
    const bool leaves = gone <= kJump && verdict.solid() && verdict.seen.behind <= kJump;
    if (!verdict.free() && !leaves) return kPath;
  }
  return {};
}

// A tool that is lifted goes aside from the rays to its parts: is all of it in front then? It is
// lifted farther where it is not quite.
bool RobotGuide::comes_out(Pose& target, double now) const {
  if (!shape_.is_wide()) return true;
  for (int k = 0; k < kTries; ++k) {
    Memory memory = tool_;
    const Verdict verdict = judge(target, now, memory);
    if (verdict.free()) return true;
    if (!verdict.solid() || verdict.seen.behind > kJump) return false;
    target.position += verdict.seen.lift * verdict.seen.towards;
  }
  return false;
}

RobotGuide::Answer RobotGuide::look(const ServoState& state, double now, bool pressed) {
  const double dt = std::clamp(now - std::exchange(looked_, now), 0.0, kLongestStep);
  if (options_.hand) return follow({state.hip, state.orientation}, now);
  if (has(state.field_notes, FieldNote::tool_too_large)) {
    pause();
    return {.reason = kLarge, .why = std::string(kLarge)};
  }
  Verdict proxy = judge(state.tool, now, tool_);
  if (proxy.source == nullptr) return without_view(state, dt, pressed);
  // What a cloud has there may hold the tool later, whatever a camera sees.
  if (has(state.field_notes, FieldNote::not_loaded)) {
    pause();
    return {.reason = kNotLoaded, .why = std::string(kNotLoaded)};
  }
  const double ahead = proxy.solid() ? proxy.seen.behind : 0;
  // Only a surface that the robot has followed may lag behind the seen one.
  const bool lags = robot_.pose && (follows_ || now - followed_ <= kFreeFor);
  const double allowed = allowed_ahead(state, proxy, dt);
  bool free = proxy.free() || (proxy.solid() && lags && ahead <= allowed);
  if (free && is_outrun(proxy.seen, state)) {
    proxy.seen.verdict = Seen::Verdict::old;
    free = false;
  }
  if (proxy.solid() && !free) followed_ = -kNever;
  Memory memory = tool_;
  note(free ? judge({state.hip, state.orientation}, now, memory) : proxy, free, dt, pressed);
  if (!follows_) return wait(proxy, now, dt, kNotYet);
  Pose target = state.tool;
  target.position += proxy.seen.lift * proxy.seen.towards;
  if (proxy.solid() && !comes_out(target, now)) return wait(proxy, now, dt, kPath);
  const Reason hindrance = pressed ? Reason{} : this->hindrance(target, now);
  if (!hindrance.empty()) return wait(proxy, now, dt, hindrance);
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

RobotGuide::Answer RobotGuide::follow(const Pose& target, double stamp, double ahead) {
  // It is where the tool is.
  robot_ = {.pose = target, .memory = tool_, .clear = stamp, .seen = looked_};
  ahead_ = ahead;
  followed_ = looked_;
  return {.target = target, .age = looked_ - stamp};
}

void RobotGuide::pause() {
  forget();
  follows_ = false;
}

void RobotGuide::miss_hand(double now) {
  if (now - looked_ > kLateHand) forget();
}

void RobotGuide::is_at(const std::optional<Pose>& pose) {
  robot_ = {.pose = pose, .memory = robot_.memory, .clear = -kNever, .seen = -kNever};
}

// Nothing was seen meanwhile.
void RobotGuide::forget() {
  is_at(robot_.pose);
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
  if (!reason.empty() && !robot_.pose) return waits(reason);
  if (!reason.empty()) followed_ = -kNever;
  if (reason.empty() && !state.contact.touching) {
    count_free(dt);
  } else {
    free_for_.reset();
  }
  follows_ = reason.empty() && (follows_ || may_start(pressed));
  if (!follows_) return waits(reason.empty() ? kNotYet : reason);
  if (!pressed && robot_.pose && shape_.way(*robot_.pose, state.tool) > kJoin) return waits(kApart);
  // In the step in which a surface moved over it, it may still be a little inside.
  if (has(state.contact.notes, ContactNote::reanchored | ContactNote::not_converged))
    return waits(kMoved);
  // Some part of a tool may not have been looked at.
  if (shape_.is_wide() && has(state.contact.notes, ContactNote::sweep_truncated))
    return waits(kLags);
  return follow(state.tool, looked_);
}

}  // namespace palpate::ros
