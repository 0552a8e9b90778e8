// Decides where a robot is sent, from what the sources know about proxy, hand and robot position.
#include "ros/robot_guide.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate::ros {
namespace {

using Eigen::Vector3d;
using Reason = std::string_view;

// In the order of Seen::Says.
constexpr std::array<Reason, 5> kReasons = {
    "no camera sees where the tool is", "nothing is measured where the tool is",
    "the tool is behind what a camera sees", "",
    "a camera that looks where the tool is shows nothing new"};
constexpr Reason kBehind = kReasons[2];
constexpr Reason kPassed = "the surface passed over the tool";
constexpr Reason kCame = "something came between camera and tool";
constexpr Reason kNotYet = "hand and tool have to be free for half a second";
constexpr Reason kMoved = "a surface moved over the tool";
constexpr Reason kWay = "the way to the tool is not seen free";
constexpr Reason kLarge = "the tool is too large for the surface: give a larger --radius";
constexpr Reason kApart = "the tool has to come back to where the robot is";

constexpr double kBlink = 0.3;    // s; after a shorter loss of sight it resumes at once (judgement)
constexpr double kFreeFor = 0.5;  // s, so that a hand that passes does not start it (judgement)
constexpr double kWayStep = 0.005;  // m between checked positions; a finger is thicker (judgement)
constexpr double kJoin = 0.02;      // m; a hand finds a place again to that (judgement)
// m that a surface comes nearer in one frame; a hand or tool in between is thicker (judgement)
constexpr double kJump = 0.01;
// s counted between two looks at most, so that a retreat makes no leap after a pause (judgement)
constexpr double kLongestStep = 0.1;
constexpr double kStays = 1;  // s; frames of working cameras are younger (judgement)
constexpr double kNever = std::numeric_limits<double>::infinity();

// Why the proxy's own path no longer proves that the robot can follow it; empty if it still does.
Reason broken_way(const ServoState& state) {
  if (has(state.field_notes, FieldNote::no_surface)) return "no source has a surface";
  if (has(state.field_notes, FieldNote::behind)) return kBehind;
  if (has(state.contact.notes, ContactNote::lost | ContactNote::fell | ContactNote::freed))
    return "the surface let the tool go";
  return {};
}

}  // namespace

std::vector<RobotGuide::Witness> RobotGuide::witnesses_of(const Scene& scene,
                                                          const std::vector<std::string>& names) {
  std::vector<Witness> found;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Source& source = scene.source(i);
    if (names.empty() || std::ranges::count(names, source.name()) > 0) found.push_back({&source});
  }
  for (const std::string& name : names) {
    const auto is_it = [&](const Witness& witness) { return witness.source->name() == name; };
    if (std::ranges::none_of(found, is_it))
      throw Error(fmt::format("robot: no source is called '{}'; name one of the run's", name));
  }
  return found;
}

RobotGuide::RobotGuide(const Scene& scene, const RosBridgeOptions::Robot& options,
                       double tool_radius)
    : options_(options),
      tool_radius_(tool_radius),
      witnesses_(witnesses_of(scene, options.sources)) {
  for (const Witness& witness : witnesses_) (void)witness.source->seen({}, 0);  // asks for frames
}

// The highest answer of the sources counts, in the order of Seen::Says. But free gives way to solid
// where its frame is older than kStays, or than the moment when the solid came. Only the tool and
// the robot stay where they are for long enough to remember that moment for them.
RobotGuide::Place RobotGuide::judge(const Vector3d& x, double now, Asked asked) {
  const auto rank = [](const Seen& seen) { return std::tuple(seen.says, -seen.behind, -seen.age); };
  Place place;
  Place solid;
  double came = -kNever;
  for (Witness& witness : witnesses_) {
    std::optional<Seen> seen = witness.source->seen({x, tool_radius_}, now);
    if (!seen && !witness.source->points()) seen = {.says = Seen::Says::old};  // nothing came yet
    if (!seen) continue;
    if (place.source == nullptr || rank(*seen) > rank(place.seen)) place = {witness.source, *seen};
    if (seen->says != Seen::Says::solid) continue;
    const double before = (x - witness.where).norm() <= kJoin ? witness.came : -kNever;
    const double here = seen->came ? now - seen->age : before;
    if (seen->came && asked == Asked::stays) witness = {witness.source, here, x};
    if (solid.source == nullptr || here > came) solid = {witness.source, *seen};
    came = std::max(came, here);
  }
  const bool outdated = now - place.seen.age < came || place.seen.age > kStays;
  return place.free() && solid.source != nullptr && outdated ? solid : place;
}

// Largest lag of the rendered surface behind the seen one, m. The seen one moves on while a frame
// is prepared; the rendered one takes an interval to get there, and waits if the next frame is
// late. In one frame the lag grows by at most one frame's motion; more has another cause.
double RobotGuide::allowed_ahead(const ServoState& state, const Place& proxy, double dt) {
  const double interval = proxy.source->state().interval;
  const double speed = state.contact.touching ? state.contact.drift.dot(proxy.seen.towards) : 0;
  const double before = interval > 0 ? speed_ * std::max(1 - dt / (2 * interval), 0.0) : 0;
  speed_ = std::max({speed, before, 0.0});
  const double lag = speed_ * (proxy.seen.age + 2 * interval);
  return kJump + std::min(lag, ahead_ + speed_ * interval);
}

// Is the straight way from the robot to the target seen to be free?
bool RobotGuide::may_go_to(const Vector3d& target, double now) {
  if (!place_ || (target - *place_).norm() <= kWayStep) return true;
  const auto steps = static_cast<int>(std::ceil((target - *place_).norm() / kWayStep));
  for (int i = 0; i < steps; ++i) {
    if (!judge(*place_ + (target - *place_) * i / steps, now, Asked::passes).free()) return false;
  }
  return true;
}

RobotGuide::Answer RobotGuide::look(const ServoState& state, double now, bool pressed) {
  const double dt = std::clamp(now - std::exchange(looked_, now), 0.0, kLongestStep);
  if (options_.hand) return follow(state.hip);
  if (has(state.field_notes, FieldNote::tool_too_large)) {
    pause();
    return {.reason = kLarge, .why = std::string(kLarge)};
  }
  const Place proxy = judge(state.contact.proxy, now, Asked::stays);
  if (proxy.source == nullptr) return without_view(state, now, pressed);
  const double ahead = proxy.solid() ? proxy.seen.behind : 0;
  // Only a surface that the robot has followed may lag behind the seen one.
  const bool lags = place_ && (follows_ || now - followed_ <= kBlink);
  const double allowed = allowed_ahead(state, proxy, dt);
  const bool free = proxy.free() || (proxy.solid() && lags && ahead <= allowed);
  if (proxy.solid() && !free) followed_ = -kNever;
  note(free, free && judge(state.hip, now, Asked::passes).free(), now, pressed);
  if (!follows_) return wait(proxy, now, dt);
  const Vector3d target = state.contact.proxy + ahead * proxy.seen.towards;
  return pressed || may_go_to(target, now) ? follow(target, ahead) : wait(proxy, now, dt);
}

// Stops following when the proxy is not free. Starts again when proxy and hand have been free for
// kFreeFor, when the button is pressed again, or after a loss of sight shorter than kBlink.
void RobotGuide::note(bool proxy_free, bool both_free, double now, bool pressed) {
  free_since_ = both_free ? std::min(free_since_, now) : kNever;
  const bool may =
      follows_ || pressed || now - free_since_ >= kFreeFor || now - followed_ <= kBlink;
  follows_ = proxy_free && may;
}

RobotGuide::Answer RobotGuide::follow(const Vector3d& target, double ahead) {
  place_ = target;
  ahead_ = ahead;
  followed_ = looked_;
  held_ = 0;
  over_ = {};
  return {.target = target};
}

void RobotGuide::pause() {
  held_ = -kNever;  // not seen meanwhile
  free_since_ = kNever;
  followed_ = -kNever;
  ahead_ = 0;
}

RobotGuide::Answer RobotGuide::wait(const Place& proxy, double now, double dt) {
  ahead_ = 0;
  const Place held = place_ ? judge(*place_, now, Asked::stays) : Place{};
  note_held(held, now);
  Answer answer;
  if (!over_.what.empty()) {
    answer.reason = over_.what;
    answer.why = fmt::format("{} {:.1f} s ago", over_.what, now - over_.since);
  } else if (!proxy.free()) {
    answer.reason = kReasons[static_cast<std::size_t>(proxy.seen.says)];
    answer.why = fmt::format("{} ({})", answer.reason, proxy.source->name());
  } else {
    answer.reason = follows_ ? kWay : kNotYet;
    answer.why = answer.reason;
  }
  if (over_.what != kPassed || !(options_.retreat > 0)) return answer;
  const double step = std::min(options_.retreat * dt, held.seen.behind);
  place_ = *place_ + step * held.seen.towards;
  answer.target = place_;
  answer.retreats = true;
  return answer;
}

// Lets the robot go back only from what came steadily over its position. What came in a jump, or
// unseen, stands between it and the camera: the way back would lead into it.
void RobotGuide::note_held(const Place& held, double now) {
  const double known = held.free() ? 0 : -kNever;
  const double before = std::exchange(held_, held.solid() ? held.seen.behind : known);
  if (!held.solid()) {
    over_ = {};
    return;
  }
  followed_ = -kNever;
  if (over_.what.empty()) over_.since = now;
  if (over_.what == kCame) return;
  over_.what = held_ - before <= kJump ? kPassed : kCame;
}

// Clouds do not show what is free; only the tool's own path proves it. So the robot follows the
// tool until a surface comes over it or lets it go. It follows again once nothing has held the hand
// for kFreeFor and the tool is where the robot is.
RobotGuide::Answer RobotGuide::without_view(const ServoState& state, double now, bool pressed) {
  const auto waits = [](Reason reason) {
    return Answer{.reason = reason, .why = std::string(reason)};
  };
  const Reason reason = broken_way(state);
  if (!reason.empty() && !place_) return waits(reason);
  if (!reason.empty()) followed_ = -kNever;
  note(reason.empty(), reason.empty() && !state.contact.touching, now, pressed);
  if (!follows_) return waits(reason.empty() ? kNotYet : reason);
  if (!pressed && place_ && (state.contact.proxy - *place_).norm() > kJoin) return waits(kApart);
  // In the step in which a surface moved over it, it may still be a little inside.
  if (has(state.contact.notes, ContactNote::reanchored | ContactNote::not_converged))
    return waits(kMoved);
  return follow(state.contact.proxy);
}

}  // namespace palpate::ros
