// Publishes hands, surfaces and reports to ROS 2, each at its rate, and takes forces from robots.
#include "palpate/ros/bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

#include "base/requirement.hpp"
#include "dds/endpoint.hpp"
#include "message/transforms.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "ros/hand_messages.hpp"
#include "ros/robot_target.hpp"

namespace palpate {
namespace {

using namespace message;
using dds::Participant;
using dds::Quality;
using dds::Writer;
using Eigen::Vector3d;

constexpr Quality kTold{.reliable = true, .depth = 1};
constexpr Quality kTf{.reliable = true, .depth = 100};
constexpr Quality kStays{.reliable = true, .depth = 1, .stays = true};
constexpr Quality kHeard{.reliable = false, .depth = 1};
constexpr std::size_t kSurfacePoints = 10'000;  // points of a published surface at most (judgement)
constexpr double kMarkerRate = 30;              // Hz, for a display (judgement)
constexpr double kSurfaceRate = 5;              // Hz, for a display (judgement)
constexpr double kFrameRate = 50;               // Hz of /tf (judgement)
constexpr double kReportRate = 1;               // Hz of diagnostics (judgement)

struct HandTopics {
  HandTopics(const Participant& with, const std::function<std::string(const std::string&)>& name)
      : pose(with, name("pose"), kTold),
        proxy(with, name("proxy"), kTold),
        twist(with, name("twist"), kTold),
        wrench(with, name("wrench"), kTold),
        joy(with, name("joy"), kTold),
        measured_cp(with, name("measured_cp"), kTold),
        measured_cv(with, name("measured_cv"), kTold),
        measured_cf(with, name("measured_cf"), kTold),
        servo_cf(with, name("servo_cf"), kHeard) {}

  void tell(const Header& header, const ServoState& state) {
    const PoseStamped position = ros::hand_pose(header, state);
    const TwistStamped velocity = ros::hand_twist(header, state);
    const WrenchStamped force = ros::hand_wrench(header, state);
    pose.write(position);
    measured_cp.write(position);
    proxy.write(ros::proxy_pose(header, state));
    twist.write(velocity);
    measured_cv.write(velocity);
    wrench.write(force);
    measured_cf.write(force);
    joy.write(ros::hand_joy(header, state));
  }

  Writer<PoseStamped> pose;
  Writer<PoseStamped> proxy;
  Writer<TwistStamped> twist;
  Writer<WrenchStamped> wrench;
  Writer<Joy> joy;
  Writer<PoseStamped> measured_cp;
  Writer<TwistStamped> measured_cv;
  Writer<WrenchStamped> measured_cf;
  dds::Reader<WrenchStamped> servo_cf;
};

const RosBridgeOptions& checked(const RosBridgeOptions& options,
                                const std::vector<RosBridge::Hand>& hands) {
  const Requirement require{"ROS bridge"};
  const bool servos =
      std::ranges::all_of(hands, [](const auto& hand) { return hand.servo != nullptr; });
  require(!hands.empty() && servos, "hands", hands.size(), "give one or more, with their servos");
  const auto check_rate = [&](const char* what, double rate) {
    require(rate >= 1 && rate <= 1000, what, rate, "give 1 to 1000 Hz");
  };
  check_rate("rate (Hz)", options.rate);
  if (!options.robot) return options;
  const RosBridgeOptions::Robot& robot = *options.robot;
  check_rate("the robot's rate (Hz)", robot.rate);
  require.positive("the robot's scale", robot.scale, "give a number above 0");
  const int button = robot.dead_man.value_or(0);
  require(button >= 0 && button < 32, "the dead man's button", button, "give 0 to 31");
  require(robot.retreat >= 0 && robot.retreat <= 1, "retreat (m/s)", robot.retreat, "give 0 to 1");
  return options;
}

// Is the hand's position in its last step valid?
bool is_known(const ServoState& state) {
  return state.step > 0 && state.device == DeviceState::Status::ok;
}

double extent_of(const Scene& scene) {
  Box box;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const auto points = scene.source(i).points();
    if (points) box.extend(points->bounds());
  }
  return box.empty() ? 0 : box.size().norm();
}

}  // namespace

struct RosBridge::Inside {
  Inside(std::vector<Hand> the_hands, const Scene& the_scene,
         std::function<std::vector<StreamState>()> the_streams, const RosBridgeOptions& the_options)
      : options(checked(the_options, the_hands)),
        hands(std::move(the_hands)),
        scene(the_scene),
        streams(std::move(the_streams)),
        participant(dds::environment_options()),
        markers(participant, topic(options.ns + "/markers"), kTold),
        diagnostics(participant, topic("/diagnostics"), kTold),
        frames(participant, topic("/tf"), kTf) {
    for (const Hand& hand : hands) {
      topics.push_back(std::make_unique<HandTopics>(participant, [&](const std::string& name) {
        return topic(options.ns + "/" + hand.name + "/" + name);
      }));
      reported.push_back({});
    }
    for (std::size_t i = 0; i < scene.size(); ++i) {
      const std::string name = scene.size() == 1 ? "/surface" : "/surface_" + std::to_string(i);
      surfaces.push_back(
          {std::make_unique<Writer<PointCloud2>>(participant, topic(options.ns + name), kStays),
           nullptr});
    }
    if (options.robot) robot.emplace(participant, *options.robot, scene, *hands.front().servo);
    if (!unused.empty()) {
      throw Error(fmt::format("ROS bridge: no topic of palpate's is called {}, so it cannot be {}",
                              unused.begin()->first, unused.begin()->second));
    }
    thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  struct Surface {
    std::unique_ptr<Writer<PointCloud2>> writer;
    std::shared_ptr<const SurfacePoints> told;
  };
  [[nodiscard]] std::string topic(const std::string& name) {
    unused.erase(name);
    const auto found = options.remap.find(name);
    return found == options.remap.end() ? name : found->second;
  }

  void run(const std::stop_token& stop);
  void look(double now);
  void take_forces(std::size_t hand);
  void tell_frames(const Header& header);
  void tell_markers(const Header& header);
  void tell_surfaces(const Header& header);
  void tell_diagnostics(const Header& header);

  const RosBridgeOptions options;
  std::map<std::string, std::string> unused = options.remap;  // of the other names
  const std::vector<Hand> hands;
  const Scene& scene;
  const std::function<std::vector<StreamState>()> streams;
  Participant participant;
  std::vector<std::unique_ptr<HandTopics>> topics;  // one a hand
  std::vector<StepDurations> reported;              // one a hand: what was told already
  std::vector<Surface> surfaces;                    // one a source
  Writer<MarkerArray> markers;
  Writer<DiagnosticArray> diagnostics;
  Writer<TFMessage> frames;
  std::optional<ros::RobotTarget> robot;
  ros::Every hand_due{options.rate};
  ros::Every frames_due{kFrameRate};
  ros::Every markers_due{kMarkerRate};
  ros::Every surfaces_due{kSurfaceRate};
  ros::Every diagnostics_due{kReportRate};
  mutable std::mutex mutex;
  std::string problem;
  std::jthread thread;  // last: it uses all of the above
};

void RosBridge::Inside::run(const std::stop_token& stop) {
  SteadyClock clock;
  const double rate = ros::look_rate(options);
  for (double next = clock.now(); !stop.stop_requested();
       next = std::max(next + 1 / rate, clock.now())) {
    clock.wait_until(next);
    try {
      look(clock.now());
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex);
      problem = error.what();
    }
  }
}

void RosBridge::Inside::look(double now) {
  const Header header{to_time(system_now()), options.frame};
  if (robot) robot->look(now, header.stamp);
  if (hand_due.due(now)) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      if (const ServoState state = hands[i].servo->state(); is_known(state))
        topics[i]->tell(header, state);
      take_forces(i);
    }
  }
  if (frames_due.due(now)) tell_frames(header);
  if (markers_due.due(now) && markers.readers() > 0) tell_markers(header);
  if (surfaces_due.due(now)) tell_surfaces(header);
  if (diagnostics_due.due(now)) tell_diagnostics(header);
}

// A bad message from one force sensor must not stop other hands or the publishing.
void RosBridge::Inside::take_forces(std::size_t hand) {
  try {
    WrenchStamped told;
    if (!topics[hand]->servo_cf.take(told)) return;
    const std::string& frame = told.header.frame_id;
    if (!frame.empty() && frame != options.frame) {
      throw Error(fmt::format("servo_cf of {}: a force in the frame '{}'; give it in '{}'",
                              hands[hand].name, frame, options.frame));
    }
    hands[hand].servo->add_force(eigen(told.wrench.force));
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex);
    problem = error.what();
  }
}

void RosBridge::Inside::tell_frames(const Header& header) {
  TFMessage message;
  for (const Hand& hand : hands) {
    if (const ServoState state = hand.servo->state(); is_known(state))
      message.transforms.push_back(ros::proxy_frame(header, hand.name, state));
  }
  if (!message.transforms.empty()) frames.write(message);
}

void RosBridge::Inside::tell_markers(const Header& header) {
  MarkerArray message;
  const double extent = extent_of(scene);
  for (std::size_t i = 0; i < hands.size(); ++i) {
    ros::add_markers(header, hands[i].servo->state(), static_cast<int>(i), extent, message);
  }
  markers.write(message);
}

// Publishes a surface only when it changes; late readers get the last one.
void RosBridge::Inside::tell_surfaces(const Header& header) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    std::shared_ptr<const SurfacePoints> newest = scene.source(i).points();
    if (!newest || newest == surfaces[i].told) continue;
    surfaces[i].writer->write(ros::surface_message(header, scene.source(i), kSurfacePoints));
    surfaces[i].told = std::move(newest);
  }
}

void RosBridge::Inside::tell_diagnostics(const Header& header) {
  DiagnosticArray message{header, {}};
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const Servo& servo = *hands[i].servo;
    const StepDurations now = servo.durations();
    message.status.push_back(
        ros::hand_status(hands[i].name, servo.state(), now.since(reported[i])));
    reported[i] = now;
  }
  for (const StreamState& stream : streams ? streams() : std::vector<StreamState>()) {
    message.status.push_back(ros::stream_status(stream));
  }
  if (robot) message.status.push_back(ros::robot_status(robot->state()));
  diagnostics.write(message);
}

RosBridge::RosBridge(std::vector<Hand> hands, const Scene& scene,
                     std::function<std::vector<StreamState>()> streams,
                     const RosBridgeOptions& options)
    : inside_(std::make_unique<Inside>(std::move(hands), scene, std::move(streams), options)) {}

RosBridge::~RosBridge() = default;

std::string RosBridge::problem() const {
  const std::lock_guard lock(inside_->mutex);
  return inside_->problem;
}

std::optional<RosBridge::RobotState> RosBridge::robot() const {
  if (!inside_->robot) return std::nullopt;
  return inside_->robot->state();
}

}  // namespace palpate
