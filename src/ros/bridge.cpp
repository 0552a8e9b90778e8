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
#include "ros/topics.hpp"

namespace palpate {
namespace {

using namespace message;
using dds::Participant;
using dds::Quality;
using dds::Writer;
using Eigen::Vector3d;

constexpr Quality kTf{.reliable = true, .depth = 100};
constexpr Quality kStays{.reliable = true, .depth = 1, .stays = true};
constexpr std::size_t kSurfacePoints = 10'000;  // points of a published surface at most (judgement)
constexpr double kMarkerRate = 30;              // Hz, for a display (judgement)
constexpr double kSurfaceRate = 5;              // Hz, for a display (judgement)
constexpr double kFrameRate = 50;               // Hz of /tf (judgement)
constexpr double kReportRate = 1;               // Hz of diagnostics (judgement)

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

// The surfaces of a scene, each a topic.
struct SurfaceTopics {
  struct Surface {
    std::unique_ptr<Writer<PointCloud2>> writer;
    std::shared_ptr<const SurfacePoints> told = {};
  };

  const Scene& scene;
  std::vector<Surface> surfaces = {};  // one a source
  ros::Every due{kSurfaceRate};

  void tell(const Header& header);
};

// What went wrong last. Any thread.
struct LastProblem {
  mutable std::mutex mutex = {};
  std::string text = {};

  void set(const std::exception& error) {
    const std::lock_guard lock(mutex);
    text = error.what();
  }
};

struct RosBridge::Inside {
  Inside(const std::vector<Hand>& the_hands, const Scene& scene,
         std::function<std::vector<StreamState>()> the_streams, const RosBridgeOptions& the_options,
         ros::TopicNames topic)
      : options(checked(the_options, the_hands)),
        streams(std::move(the_streams)),
        participant(dds::environment_options()),
        surfaces{scene},
        markers{{participant, topic(options.ns + "/markers"), ros::kReported},
                ros::Every(kMarkerRate)},
        diagnostics{{participant, topic("/diagnostics"), ros::kReported}, ros::Every(kReportRate)},
        frames{{participant, topic("/tf"), kTf}, ros::Every(kFrameRate)} {
    for (const Hand& hand : the_hands) {
      hands.push_back(
          std::make_unique<ros::HandTopics>(participant, hand, [&](const std::string& name) {
            return topic(options.ns + "/" + hand.name + "/" + name);
          }));
    }
    for (std::size_t i = 0; i < scene.size(); ++i) {
      const std::string name = scene.size() == 1 ? "/surface" : "/surface_" + std::to_string(i);
      surfaces.surfaces.push_back(
          {std::make_unique<Writer<PointCloud2>>(participant, topic(options.ns + name), kStays)});
    }
    if (options.robot) robot.emplace(participant, *options.robot, scene, *the_hands.front().servo);
    if (!topic.unused.empty()) {
      throw Error(fmt::format("ROS bridge: no topic of palpate's is called {}, so it cannot be {}",
                              topic.unused.begin()->first, topic.unused.begin()->second));
    }
    thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  void run(const std::stop_token& stop);
  void look(double now);
  void take_forces(ros::HandTopics& topics);
  void tell_frames(const Header& header);
  void tell_markers(const Header& header);
  void tell_diagnostics(const Header& header);

  const RosBridgeOptions options;
  const std::function<std::vector<StreamState>()> streams;
  Participant participant;
  std::vector<std::unique_ptr<ros::HandTopics>> hands;
  ros::Every hand_due{options.rate};
  SurfaceTopics surfaces;
  ros::PacedTopic<MarkerArray> markers;
  ros::PacedTopic<DiagnosticArray> diagnostics;
  ros::PacedTopic<TFMessage> frames;
  std::optional<ros::RobotTarget> robot;
  LastProblem problem;
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
      problem.set(error);
    }
  }
}

void RosBridge::Inside::look(double now) {
  const Header header{to_time(system_now()), options.frame};
  if (robot) robot->look(now, header.stamp);
  if (hand_due.due(now)) {
    for (const auto& topics : hands) {
      if (const ServoState state = topics->hand.servo->state(); is_known(state))
        topics->tell(header, state);
      take_forces(*topics);
    }
  }
  if (frames.due.due(now)) tell_frames(header);
  if (markers.due.due(now) && markers.writer.readers() > 0) tell_markers(header);
  if (surfaces.due.due(now)) surfaces.tell(header);
  if (diagnostics.due.due(now)) tell_diagnostics(header);
}

// A bad message from one force sensor must not stop other hands or the publishing.
void RosBridge::Inside::take_forces(ros::HandTopics& topics) {
  try {
    WrenchStamped told;
    if (!topics.servo_cf.take(told)) return;
    const std::string& frame = told.header.frame_id;
    if (!frame.empty() && frame != options.frame) {
      throw Error(fmt::format("servo_cf of {}: a force in the frame '{}'; give it in '{}'",
                              topics.hand.name, frame, options.frame));
    }
    topics.hand.servo->add_force(eigen(told.wrench.force));
  } catch (const std::exception& error) {
    problem.set(error);
  }
}

void RosBridge::Inside::tell_frames(const Header& header) {
  TFMessage message;
  for (const auto& topics : hands) {
    if (const ServoState state = topics->hand.servo->state(); is_known(state))
      message.transforms.push_back(ros::proxy_frame(header, topics->hand.name, state));
  }
  if (!message.transforms.empty()) frames.writer.write(message);
}

void RosBridge::Inside::tell_markers(const Header& header) {
  MarkerArray message;
  const double extent = extent_of(surfaces.scene);
  for (std::size_t i = 0; i < hands.size(); ++i) {
    ros::add_markers(header, hands[i]->hand.servo->state(), static_cast<int>(i), extent, message);
  }
  markers.writer.write(message);
}

// Publishes a surface only when it changes; late readers get the last one.
void SurfaceTopics::tell(const Header& header) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    std::shared_ptr<const SurfacePoints> newest = scene.source(i).points();
    if (!newest || newest == surfaces[i].told) continue;
    surfaces[i].writer->write(ros::surface_message(header, scene.source(i), kSurfacePoints));
    surfaces[i].told = std::move(newest);
  }
}

void RosBridge::Inside::tell_diagnostics(const Header& header) {
  DiagnosticArray message{header, {}};
  for (const auto& topics : hands) {
    const Servo& servo = *topics->hand.servo;
    const StepDurations now = servo.durations();
    message.status.push_back(
        ros::hand_status(topics->hand.name, servo.state(), now.since(topics->reported)));
    topics->reported = now;
  }
  for (const StreamState& stream : streams ? streams() : std::vector<StreamState>()) {
    message.status.push_back(ros::stream_status(stream));
  }
  if (robot) message.status.push_back(ros::robot_status(robot->state()));
  diagnostics.writer.write(message);
}

RosBridge::RosBridge(const std::vector<Hand>& hands, const Scene& scene,
                     std::function<std::vector<StreamState>()> streams,
                     const RosBridgeOptions& options)
    : inside_(std::make_unique<Inside>(hands, scene, std::move(streams), options,
                                       ros::TopicNames{options.remap})) {}

RosBridge::~RosBridge() = default;

std::string RosBridge::problem() const {
  const std::lock_guard lock(inside_->problem.mutex);
  return inside_->problem.text;
}

std::optional<RosBridge::RobotState> RosBridge::robot() const {
  if (!inside_->robot) return std::nullopt;
  return inside_->robot->state();
}

}  // namespace palpate
