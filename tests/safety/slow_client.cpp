#include "safety/slow_client.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "device/remote_protocol.hpp"
#include "geometry/turn.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 1e-3;       // s, of the servo
constexpr double kPeriod = 2;        // s, of the hand's motion
constexpr double kSteady = 4;        // s, when it repeats itself
constexpr double kStallEvery = 0.4;  // s

RemoteDeviceOptions remote(bool turns) {
  RemoteDeviceOptions options;
  options.path = "none";
  options.maximum_force = 12;
  options.turns = turns;
  if (turns) options.maximum_torque = 0.3;
  return options;
}

DeviceInfo info_of(const RemoteDeviceOptions& options) {
  DeviceInfo info;
  info.name = "remote";
  info.maximum_force = options.maximum_force;
  info.maximum_torque = options.maximum_torque;
  info.rate = options.rate;
  info.has_orientation = options.turns;
  return info;
}

// The remote device's protocol between a servo and a client in the same thread.
class Link final : public Device {
 public:
  Link(const RemoteDeviceOptions& options, bool tells_time)
      : info_(info_of(options)), protocol_(options), tells_time_(tells_time) {
    client_.size = 2;
    client_.path[0] = 'c';
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override {
    DeviceState state = protocol_.state(now_);
    if (!tells_time_) state.time = 0;
    return state;
  }
  void write(const Vector3d& force) noexcept override { write_wrench({.force = force}); }
  void write_wrench(const Wrench& wrench) noexcept override {
    if (const auto packet = protocol_.answer(wrench)) answers_.push_back(*packet);
  }
  [[nodiscard]] std::string reason() const override { return "simulated"; }

  void receive(const StatePacket& packet, double now) {
    now_ = now;
    static_cast<void>(protocol_.receive(encode(packet), client_, now));
  }
  void set_time(double now) { now_ = now; }
  // The newest answer, as a client takes it that empties its queue.
  [[nodiscard]] std::optional<ForcePacket> newest() {
    if (answers_.empty()) return std::nullopt;
    const ForcePacket packet = answers_.back();
    answers_.clear();
    return packet;
  }

 private:
  DeviceInfo info_;
  RemoteProtocol protocol_;
  SocketAddress client_;
  bool tells_time_;
  std::vector<ForcePacket> answers_;
  double now_ = 0;
};

// The moments at which a client runs.
class Moments {
 public:
  explicit Moments(const Sending& sending) : sending_(sending), stall_(kStallEvery) {}

  [[nodiscard]] double next() {
    due_ += 1 / sending_.rate;
    double time = due_ + sending_.jitter / sending_.rate * uniform_(random_);
    if (sending_.stall > 0 && time > stall_) {
      time = due_ = stall_ + sending_.stall;
      stall_ = time + kStallEvery * (1 + 0.3 * uniform_(random_));
    }
    now_ = std::max(now_ + 1e-5, time);
    return now_;
  }

 private:
  Sending sending_;
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> uniform_{-1, 1};
  double due_ = 0.3e-3;
  double now_ = 0;
  double stall_;
};

// A light grip on a device, as of SimulatedDevice.
constexpr double kGrip = 300;      // N/m
constexpr double kGripDamper = 3;  // N s/m
constexpr double kMass = 0.1;      // kg
constexpr double kFine = 1e-4;     // s, a step of its motion

// A hand that follows its way, whatever the force, or yields to it: what the force does on it is
// counted.
class Client {
 public:
  Client(const HandWay& way, const Sending& sending, bool turns)
      : way_(way), sending_(sending), moments_(sending), turns_(turns), next_(moments_.next()) {}

  // All that it does until `now`.
  void run(Link& link, double now) {
    for (; next_ <= now; next_ = moments_.next()) {
      go_to(next_);
      if (const auto answer = link.newest()) wrench_ = {answer->force, answer->torque, 0};
      waiting_.push_back(packet());
    }
    if (waiting_.empty() || now < waiting_.front().stamp + sending_.burst) return;
    for (const StatePacket& sent : waiting_) link.receive(sent, now);
    waiting_.clear();
  }

  // Work on the hand so far, J.
  [[nodiscard]] double work_at(double time) {
    go_to(time);
    return work_;
  }

 private:
  // Where the hand gets to from time_ on.
  [[nodiscard]] Pose pose_at(double time) {
    Pose pose = way_(time);
    if (!sending_.yields) return pose;
    Vector3d wanted = way_(time_).position;
    const Vector3d wanted_velocity = (pose.position - wanted) / std::max(time - time_, 1e-9);
    pose.position = pose_.position;
    for (double left = time - time_; left > 0; left -= kFine) {
      const double dt = std::min(left, kFine);
      wanted += dt * wanted_velocity;
      const Vector3d pull = kGrip * (wanted - pose.position) +
                            kGripDamper * (wanted_velocity - velocity_) + wrench_.force;
      velocity_ += dt / kMass * pull;
      pose.position += dt * velocity_;
    }
    return pose;
  }

  void go_to(double time) {
    const Pose pose = pose_at(time);
    work_ += wrench_.force.dot(pose.position - pose_.position) +
             wrench_.torque.dot(turn_between(pose_.orientation, pose.orientation));
    pose_ = pose;
    time_ = time;
  }

  [[nodiscard]] StatePacket packet() {
    StatePacket packet;
    packet.version = turns_ ? RemoteVersion::kTurns : RemoteVersion::kForces;
    packet.sequence = ++sequence_;
    packet.stamp = time_;
    packet.position = pose_.position;
    packet.turns.orientation = pose_.orientation;
    packet.turns.renders_torque = turns_;
    return packet;
  }

  const HandWay& way_;
  Sending sending_;
  Moments moments_;
  bool turns_;
  double next_;
  std::deque<StatePacket> waiting_;  // to arrive
  Pose pose_ = way_(0);
  Vector3d velocity_ = Vector3d::Zero();  // of a hand that yields
  Wrench wrench_;
  double time_ = 0;
  double work_ = 0;
  std::uint64_t sequence_ = 0;
};

// What of a change of force between two steps neither the way of the hand nor its velocity explain.
class Unexplained {
 public:
  explicit Unexplained(const GuardOptions& options) : damping_(options.damping) {}

  void add(const ServoState& state, const Pose& hand, double gyration, Pushed& pushed) {
    const Vector3d velocity = velocity_ + Guard::kSmoothing * (state.velocity - velocity_);
    const double way = (hand.position - hand_.position).norm() +
                       gyration * turn_between(hand_.orientation, hand.orientation).norm();
    const double stiffness = std::max(state.contact.stiffness, stiffness_);
    const double explained = stiffness * way + damping_ * (velocity - velocity_).norm();
    if (state.step > 1) {
      pushed.step = std::max(pushed.step, (state.force - force_).norm() - explained);
      if (gyration > 0) {
        pushed.torque_step =
            std::max(pushed.torque_step, (state.torque - torque_).norm() - gyration * explained);
      }
    }
    pushed.largest = std::max(pushed.largest, state.force.norm());
    hand_ = hand;
    velocity_ = velocity;
    stiffness_ = state.contact.stiffness;
    force_ = state.force;
    torque_ = state.torque;
  }

 private:
  double damping_;
  Pose hand_;
  Vector3d velocity_ = Vector3d::Zero();
  double stiffness_ = 0;
  Vector3d force_ = Vector3d::Zero();
  Vector3d torque_ = Vector3d::Zero();
};

}  // namespace

Pushed push(Scene& scene, const ServoOptions& options, const Sending& sending, const HandWay& way,
            double duration, bool turns) {
  Link link(remote(turns), sending.tells_time);
  Servo servo(link, scene, options);
  Client client(way, sending, turns);
  Unexplained unexplained(servo.options().guard);
  const double gyration = turns ? servo.options().gyration : 0;
  Pushed pushed;
  double begun = 0;  // J, when the motion was steady
  const int steps = static_cast<int>(duration / kStep);
  const int period = static_cast<int>(kPeriod / kStep);
  for (int i = 1; i <= steps; ++i) {
    const double now = i * kStep;
    client.run(link, now);
    link.set_time(now);
    const ServoState& state = servo.tick(now);
    unexplained.add(state, {state.hip, state.orientation, 0}, gyration, pushed);
    if (now < kSteady || i % period != 0) continue;
    const double work = client.work_at(now);
    if (now < kSteady + 0.5 * kStep) begun = work;
    pushed.energy = std::max({pushed.energy, work, work - begun});
  }
  return pushed;
}

}  // namespace palpate::test
