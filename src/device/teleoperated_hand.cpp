// Moves a simulated hand after remote commands, or along its trajectory when none come.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "base/requirement.hpp"
#include "device/flight.hpp"
#include "device/played_trajectory.hpp"
#include "device/target_motion.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// N that a hand on its way pulls with at most. At the usual travel speed the usual hand and device
// take 0.93 N (3.5 N s/m and 0.05 N of friction).
constexpr double kTravelForce = 1;

// N/s by which the limit of a press grows, and N with which it begins after a way: 0.1 kg on
// 500 N/m swing in 0.09 s, and a limit that takes as long for a newton is hardly exceeded.
constexpr double kRise = 10;
constexpr double kFirstForce = 0.1;

// m from its target within which a hand has caught up: the usual one lags by 0.6 mm at the usual
// travel speed (0.18 N of the device's damping and friction at 300 N/m).
constexpr double kCaughtUp = 1e-3;

// m: what turns as fast as the hand may move has its edge there. A hand is some 80 mm wide.
constexpr double kLever = 0.08;

TeleoperatedHandOptions checked(const TeleoperatedHandOptions& o) {
  const Requirement require{"teleoperated hand"};
  require.positive("speed", o.speed, "give a positive speed in m/s");
  require.positive("travel_speed", o.travel_speed, "give a positive speed in m/s");
  require(o.force > 0, "force", o.force, "give a positive force in newtons");
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

Trajectory checked(Trajectory rows) {
  if (!rows.empty()) check(rows);
  return rows;
}

}  // namespace

struct TeleoperatedHand::Inside {
  enum class Mode { returning, playing, following, released };

  // Who takes the tool, and when: on the device's clock, the only one that counts.
  struct Heard {
    RemoteTarget::Command command;
    std::uint64_t generation = 0;
    double received = 0;  // when the last command came, s
    double released = 0;  // when the tool was released, s

    [[nodiscard]] std::span<const Vector3d> way() const noexcept {
      return {command.way.corners.data(), command.way.size};
    }
  };

  Inside(const RemoteTarget& from, Trajectory rows, const TeleoperatedHandOptions& the_options)
      : remote(from),
        options(checked(the_options)),
        played(checked(std::move(rows)), options.presses) {}

  void begin(double now, const Vector3d& position) noexcept;
  void receive(double now, const Vector3d& position) noexcept;
  void follow(const RemoteTarget::Command& before, double now, const Vector3d& position) noexcept;
  void choose_mode(double now, const Vector3d& position) noexcept;
  void limit_force(double dt) noexcept;
  void advance(double now, const Vector3d& position) noexcept;
  void come_back(std::span<const Vector3d> way, const Vector3d& position) noexcept;
  void play(double dt, const Vector3d& position) noexcept;
  void approach(const Vector3d& goal, double speed, double dt) noexcept;
  void go(const Vector3d& goal, double speed, double dt) noexcept;
  void turn(double dt) noexcept;

  const RemoteTarget& remote;
  TeleoperatedHandOptions options;
  PlayedTrajectory played;
  TargetInterpolator interpolator;
  Flight flight;
  Heard heard;
  TargetSource::Target target;
  Mode mode = Mode::released;
  double time = 0;  // of the last call
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
  in.choose_mode(time, position);
  in.advance(time, position);
  in.turn(time - in.time);
  in.time = time;
  return in.target;
}

void TeleoperatedHand::Inside::begin(double now, const Vector3d& position) noexcept {
  started = true;
  time = now;
  heard.received = now;
  target.position = position;
  if (played.empty()) return;
  const Pose first = played.pose();
  target.position = first.position;
  target.orientation = first.orientation;
  target.opening = first.opening;
  target.maximum_force = options.force;
  mode = Mode::playing;
}

void TeleoperatedHand::Inside::receive(double now, const Vector3d& position) noexcept {
  const std::uint64_t newest = remote.generation();
  if (newest == heard.generation) return;
  const std::optional<RemoteTarget::Command> copy = remote.command();
  if (!copy) return;
  heard.generation = newest;
  heard.received = now;
  const bool moved = copy->moves != heard.command.moves;
  const RemoteTarget::Command before = std::exchange(heard.command, *copy);
  if (copy->held && moved) follow(before, now, position);
}

// Where a hand of limited force wanted to be may be far from where it could pull to; without the
// limit, and on a way, it begins where it is.
void TeleoperatedHand::Inside::follow(const RemoteTarget::Command& before, double now,
                                      const Vector3d& position) noexcept {
  const RemoteTarget::Command& command = heard.command;
  const bool followed = mode == Mode::following;
  const bool flew = followed && before.way.size > 0;
  if (command.way.size > 0) {
    if (!flew) target.position = position;
    if (!flew || command.ways != before.ways) flight.begin(heard.way(), position, 1);
    flight.lead(heard.way());
    return;
  }
  const bool freed =
      std::isfinite(target.maximum_force) && std::isinf(command.target.maximum_force);
  if (freed) target.position = position;
  if (freed || flew || !followed) interpolator.rest(target.position, now);
  if (flew) target.maximum_force = kFirstForce;
  interpolator.go(command.target.position, command.stamp, now);
}

void TeleoperatedHand::Inside::choose_mode(double now, const Vector3d& position) noexcept {
  const RemoteTarget::Command& command = heard.command;
  const bool held = command.held && now - heard.received <= options.command_timeout;
  if (held) {
    mode = Mode::following;
  } else if (mode == Mode::following) {
    mode = Mode::released;
    heard.released = now;
  } else if (mode == Mode::released && !played.empty() &&
             now - heard.released >= options.return_after) {
    played.leave_press();
    come_back({}, position);
  }
  target.buttons = held ? command.target.buttons : 0;
  if (held) limit_force(now - time);
}

// A press becomes harder no faster than what is pressed can follow, and softer at once.
void TeleoperatedHand::Inside::limit_force(double dt) noexcept {
  const double wanted = heard.command.target.maximum_force;
  const bool presses = heard.command.way.size == 0 && std::isfinite(wanted);
  if (presses && std::isfinite(target.maximum_force)) {
    target.maximum_force = std::min(wanted, target.maximum_force + kRise * dt);
  } else {
    target.maximum_force = wanted;
  }
}

void TeleoperatedHand::Inside::advance(double now, const Vector3d& position) noexcept {
  const double dt = now - time;
  switch (mode) {
    case Mode::following:
      if (heard.command.way.size > 0)
        return flight.go(target.position, heard.command.way.speed, dt);
      return approach(interpolator.at(now), options.speed, dt);
    case Mode::released:
      return go(
          target.position + std::min(1.0, dt / options.release_time) * (position - target.position),
          options.speed, dt);
    case Mode::returning:
      if (!flight.over()) return flight.go(target.position, options.travel_speed, dt);
      approach(played.pose().position, options.travel_speed, dt);
      if (target.position == played.pose().position) mode = Mode::playing;
      return;
    case Mode::playing:
      return play(dt, position);
  }
}

// Begins where the hand is, so that nothing pulls it into what it may touch there.
void TeleoperatedHand::Inside::come_back(std::span<const Vector3d> way,
                                         const Vector3d& position) noexcept {
  mode = Mode::returning;
  target.position = position;
  target.maximum_force = std::min(kTravelForce, options.force);
  flight.begin(way, position, way.size());
}

void TeleoperatedHand::Inside::play(double dt, const Vector3d& position) noexcept {
  played.advance(dt);
  target.position = played.pose().position;
  const double pull = (target.position - position).norm();
  if (pull < kCaughtUp) target.maximum_force = options.force;
  if (const Press* const lost = played.lost(pull)) return come_back(lost->over, position);
  if (played.ends()) come_back({}, position);
}

// Goes to the goal so fast that it can come to rest there.
void TeleoperatedHand::Inside::approach(const Vector3d& goal, double speed, double dt) noexcept {
  const double length = (goal - target.position).norm();
  go(goal, std::min(speed, std::sqrt(2 * options.braking * length)), dt);
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
  const TargetSource::Target& wanted = heard.command.target;
  const Pose goal = mode == Mode::following
                        ? Pose{wanted.position, wanted.orientation, wanted.opening}
                        : played.pose();
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
