// Reports why a robot waits, and leads it back from what comes over it.
#include <fmt/format.h>

#include <algorithm>

#include "ros/robot_guide.hpp"
#include "ros/robot_limits.hpp"

namespace palpate::ros {
namespace {

constexpr Reason kPassed = "the surface passed over the tool";
constexpr Reason kCame = "something came between camera and tool";
constexpr Reason kFast = "a surface came over the tool faster than the robot may go back";

}  // namespace

RobotGuide::Answer RobotGuide::wait(const Verdict& proxy, double now, double dt, Reason hindrance) {
  ahead_ = 0;
  const Verdict held = robot_.pose ? judge(*robot_.pose, now, robot_.memory) : Verdict{};
  note_held(held, now);
  Answer answer;
  if (held.solid()) {
    answer.reason = robot_.over.what;
    answer.why = fmt::format("{} {:.1f} s ago", robot_.over.what, now - robot_.over.since);
  } else if (!proxy.free()) {
    answer.reason = kReasons[static_cast<std::size_t>(proxy.seen.verdict)];
    const bool dated = proxy.seen.verdict == Seen::Verdict::old && proxy.seen.age > 0;
    const std::string age = dated ? fmt::format(", {:.2f} s ago", proxy.seen.age) : "";
    answer.why = fmt::format("{} ({}{})", answer.reason, proxy.source->name(), age);
  } else {
    answer.reason = hindrance;
    answer.why = answer.reason;
  }
  if (answer.reason != kPassed || !(options_.retreat > 0)) return answer;
  const Robot before = robot_;
  if (!goes_back(held, now, dt)) {
    robot_ = before;  // nobody is told
    return answer;
  }
  answer.target = robot_.pose;
  answer.retreats = true;
  return answer;
}

// Moves the robot in front of what was measured at once, and of what is foreseen at its speed. A
// ball's rim may still be behind what it is beside: then it goes farther. False: it is not seen to
// be in front.
bool RobotGuide::goes_back(Verdict held, double now, double dt) {
  double step = std::max(std::min(options_.retreat * dt, held.seen.behind), held.seen.measured);
  const bool clears = held.seen.measured > 0 && note_clear(now - held.seen.age);
  robot_.gone += clears ? step - held.seen.measured : step;
  for (int k = 0; k < kTries; ++k) {
    robot_.pose->position += step * held.seen.towards;
    held = judge(*robot_.pose, now, robot_.memory);
    if (!held.solid() || !(held.seen.measured > 0)) return held.sighted();
    step = held.seen.measured;
    robot_.gone += step;
  }
  return false;
}

// Lets the robot go back only from what comes over it no faster than it may go back: by
// what is seen and foreseen of it since a frame that showed nothing there. What came by more than
// kJump at once, or unseen, stands between it and the camera: the path back would lead into it. A
// shorter loss of sight than kFreeFor changes nothing.
void RobotGuide::note_held(const Verdict& held, double now) {
  if (held.sighted()) robot_.seen = now;
  if (robot_.seen < now && now - robot_.seen <= kFreeFor) return;
  if (!held.sighted()) robot_.clear = -kNever;
  if (held.sighted() && !(held.seen.measured > 0)) note_clear(now - held.seen.age);
  if (!held.solid()) {
    robot_.over = {};
    return;
  }
  followed_ = -kNever;
  const bool begins = robot_.over.what.empty();
  if (begins) robot_.over.since = now;
  if (robot_.over.what == kCame) return;
  const bool leaps = held.seen.behind > kJump;
  const double moved = held.seen.behind + robot_.gone;
  const double foreseen = held.seen.behind - held.seen.measured;
  const bool fast = leaps || moved > options_.retreat * (now - robot_.clear) ||
                    foreseen > options_.retreat * held.seen.age;
  const bool came = begins && (leaps || now - robot_.clear > kStays);
  robot_.over.what = came ? kCame : fast && options_.retreat > 0 ? kFast : kPassed;
}

// Notes that a frame showed nothing over the robot's position. False: a later one did, too.
bool RobotGuide::note_clear(double stamp) {
  if (stamp <= robot_.clear) return false;
  robot_.clear = stamp;
  robot_.gone = 0;
  return true;
}

}  // namespace palpate::ros
