// Moves a simulated hand after remote commands, or along its trajectory when none come.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/latest.hpp"
#include "base/requirement.hpp"
#include "device/target_motion.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// s in which a hand that nothing holds is at its target: five time constants of 10 ms, the usual
// hand's damping over its stiffness (SimulatedDeviceOptions::Hand)
constexpr double kSettled = 0.05;

// m: what turns as fast as the hand may move has its edge there. A hand is some 80 mm wide.
constexpr double kLever = 0.08;

// A unit quaternion's length is off by no more than the rounding of texts of seven digits.
constexpr double kUnit = 1e-6;

bool is_valid(const TargetSource::Target& target) noexcept {
  return target.position.allFinite() && target.maximum_force > 0 && std::isfinite(target.opening) &&
         std::abs(target.orientation.norm() - 1) < kUnit;
}

TeleoperatedHandOptions checked(const TeleoperatedHandOptions& o) {
  const Requirement require{"teleoperated hand"};
  require.positive("speed", o.speed, "give a positive speed in m/s");
  require.positive("braking", o.braking, "give a positive acceleration in m/s^2");
  require.positive("command_timeout", o.command_timeout, "give a positive time in seconds");
  require.positive("release_time", o.release_time, "give a positive time in seconds");
  require.not_negative("return_after", o.return_after, "give 0 or more seconds");
  double last = -std::numeric_limits<double>::infinity();
  for (const Press& p : o.presses) {
    const bool ordered = last <= p.begin && p.begin <= p.end && p.end <= p.resume;
    require(ordered, "presses' begin", p.begin,
            "give presses one after the other, begin to resume");
    require.not_negative("presses' pull", p.pull, "give 0 or more metres");
    last = p.end;
  }
  return o;
}

}  // namespace

struct RemoteTarget::Inside {
  Command newest;  // of the sender
  Latest<Command> shared;
};

RemoteTarget::RemoteTarget() : inside_(std::make_unique<Inside>()) {}

RemoteTarget::~RemoteTarget() = default;

bool RemoteTarget::move(const TargetSource::Target& target, double stamp) noexcept {
  if (!is_valid(target) || !std::isfinite(stamp)) return false;
  Command& newest = inside_->newest;
  newest = {target, stamp, true, newest.moves + 1};
  inside_->shared.set(newest);
  return true;
}

void RemoteTarget::keep_alive() noexcept {
  if (inside_->newest.held) inside_->shared.set(inside_->newest);
}

void RemoteTarget::release() noexcept {
  if (!inside_->newest.held) return;
  inside_->newest.held = false;
  inside_->shared.set(inside_->newest);
}

std::optional<RemoteTarget::Command> RemoteTarget::command() const noexcept {
  return inside_->shared.look();
}

std::uint64_t RemoteTarget::generation() const noexcept {
  return inside_->shared.generation();
}

// The trajectory that is played, without those presses that the hand does not hold.
struct PlayedTrajectory {
  Playback rows;
  std::vector<Press> presses;
  double time = 0;             // on the trajectory
  double held_at = 0;          // on the trajectory, when a press was held back last
  std::size_t next_press = 0;  // that is not over

  [[nodiscard]] Pose pose() noexcept { return rows.empty() ? Pose() : rows.at(time); }
  [[nodiscard]] Vector3d position() noexcept { return pose().position; }
  [[nodiscard]] bool ends() noexcept;
  [[nodiscard]] bool skips(double pull) noexcept;
};

struct TeleoperatedHand::Inside {
  enum class Mode { returning, playing, following, released };

  Inside(const RemoteTarget& from, Trajectory rows, const TeleoperatedHandOptions& the_options)
      : remote(from), options(checked(the_options)), played{Playback(), options.presses} {
    if (!rows.empty()) check(rows);
    played.rows = Playback(std::move(rows));
  }

  void begin(double now, const Vector3d& position) noexcept;
  void receive(double now, const Vector3d& position) noexcept;
  void choose_mode(double now) noexcept;
  void advance(double now, const Vector3d& position) noexcept;
  void play(double dt, const Vector3d& position) noexcept;
  void approach(const Vector3d& goal, double dt) noexcept;
  void go(const Vector3d& goal, double speed, double dt) noexcept;
  void turn(double dt) noexcept;

  const RemoteTarget& remote;
  TeleoperatedHandOptions options;
  PlayedTrajectory played;
  TargetInterpolator interpolator;
  RemoteTarget::Command command;
  TargetSource::Target target;
  Mode mode = Mode::released;
  double time = 0;      // of the last call
  double received = 0;  // when the last command came
  double released = 0;  // when the tool was released
  std::uint64_t generation = 0;
  bool started = false;
};

TeleoperatedHand::TeleoperatedHand(const RemoteTarget& remote, Trajectory trajectory,
                                   const TeleoperatedHandOptions& options)
    : inside_(std::make_unique<Inside>(remote, std::move(trajectory), options)) {}

TeleoperatedHand::~TeleoperatedHand() = default;

TargetSource::Target TeleoperatedHand::target(double time, const Vector3d& position) noexcept {
  Inside& in = *inside_;
  if (!in.started) in.begin(time, position);
  in.receive(time, position);
  in.choose_mode(time);
  in.advance(time, position);
  in.turn(time - in.time);
  in.time = time;
  return in.target;
}

void TeleoperatedHand::Inside::begin(double now, const Vector3d& position) noexcept {
  started = true;
  time = now;
  received = now;
  target.position = position;
  if (played.rows.empty()) return;
  target.position = played.rows.front().position;
  played.time = played.rows.front().time;
  target.orientation = played.pose().orientation;
  target.opening = played.pose().opening;
  mode = Mode::playing;
}

// Commands are dated by when they are received: the device's clock is the only one that counts.
// Where a hand of limited force wanted to be may be far from where it could pull to; without the
// limit it begins where it is.
void TeleoperatedHand::Inside::receive(double now, const Vector3d& position) noexcept {
  const std::uint64_t newest = remote.generation();
  if (newest == generation) return;
  const std::optional<RemoteTarget::Command> copy = remote.command();
  if (!copy) return;
  generation = newest;
  received = now;
  const bool moved = copy->moves != command.moves;
  command = *copy;
  if (!command.held || !moved) return;
  const bool freed =
      std::isfinite(target.maximum_force) && std::isinf(command.target.maximum_force);
  if (freed) target.position = position;
  if (freed || mode != Mode::following) interpolator.rest(target.position, now);
  interpolator.go(command.target.position, command.stamp, now);
}

void TeleoperatedHand::Inside::choose_mode(double now) noexcept {
  const bool held = command.held && now - received <= options.command_timeout;
  if (held) {
    mode = Mode::following;
  } else if (mode == Mode::following) {
    mode = Mode::released;
    released = now;
  } else if (mode == Mode::released && !played.rows.empty() &&
             now - released >= options.return_after) {
    mode = Mode::returning;
  }
  target.buttons = held ? command.target.buttons : 0;
  if (held) target.maximum_force = command.target.maximum_force;
  if (mode == Mode::returning || mode == Mode::playing)
    target.maximum_force = TargetSource::Target().maximum_force;
}

void TeleoperatedHand::Inside::advance(double now, const Vector3d& position) noexcept {
  const double dt = now - time;
  switch (mode) {
    case Mode::following:
      approach(interpolator.at(now), dt);
      return;
    case Mode::released:
      go(target.position + std::min(1.0, dt / options.release_time) * (position - target.position),
         options.speed, dt);
      return;
    case Mode::returning:
      approach(played.position(), dt);
      if (target.position == played.position()) mode = Mode::playing;
      return;
    case Mode::playing:
      play(dt, position);
      return;
  }
}

void TeleoperatedHand::Inside::play(double dt, const Vector3d& position) noexcept {
  played.time += dt;
  target.position = played.position();
  const bool skips = played.skips((target.position - position).norm());
  if (played.ends() || skips) mode = Mode::returning;
}

// Is it over? Then it begins again.
bool PlayedTrajectory::ends() noexcept {
  if (time < rows.end()) return false;
  rows.rewind();
  next_press = 0;
  time = rows.front().time;
  return true;
}

// Is a press in progress that the hand, `pull` m from its target, does not hold? Goes on behind it.
bool PlayedTrajectory::skips(double pull) noexcept {
  while (next_press < presses.size() && presses[next_press].end < time) ++next_press;
  if (next_press == presses.size()) return false;
  const Press& press = presses[next_press];
  if (pull > press.pull || time < press.begin) held_at = time;
  if (time - held_at < kSettled) return false;
  time = press.resume;
  return true;
}

// Goes to the goal so fast that it can come to rest there.
void TeleoperatedHand::Inside::approach(const Vector3d& goal, double dt) noexcept {
  const double length = (goal - target.position).norm();
  go(goal, std::min(options.speed, std::sqrt(2 * options.braking * length)), dt);
}

void TeleoperatedHand::Inside::go(const Vector3d& goal, double speed, double dt) noexcept {
  const Vector3d path = goal - target.position;
  const double length = path.norm();
  const double reach = speed * dt;
  if (length <= reach) {
    target.position = goal;
  } else {
    target.position += reach / length * path;
  }
}

void TeleoperatedHand::Inside::turn(double dt) noexcept {
  if (mode == Mode::released) return;
  Pose goal = played.pose();
  if (mode == Mode::following) {
    goal.orientation = command.target.orientation;
    goal.opening = command.target.opening;
  }
  const double angle = target.orientation.angularDistance(goal.orientation);
  const double reach = options.speed * dt;
  if (kLever * angle <= reach) {
    target.orientation = goal.orientation;
  } else {
    target.orientation =
        target.orientation.slerp(reach / (kLever * angle), goal.orientation).normalized();
  }
  target.opening += std::clamp(goal.opening - target.opening, -reach, reach);
}

}  // namespace palpate
