// Options of ROS 2 and of robots that follow the tool.
#include "apps/palpate/options/ros_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/option_table.hpp"

namespace palpate::app {

namespace {

constexpr std::array<Named<const char*>, 2> kRanges = {
    {{"localhost", "localhost"}, {"subnet", "subnet"}}};
constexpr Scope kRobot{&RunFacts::robot,
                       "applies only to runs with --robot; add that or remove it"};
constexpr std::array<std::string_view, 5> kRobots = {"crisp", "cartesian", "servo", "crtk",
                                                     "generic"};

double number_of(const std::string& key, const std::string& text, double least, double most) {
  const double value = parse_numbers(text, 1, "--robot: " + key, "a number").front();
  if (value >= least && value <= most) return value;
  throw UsageError(
      fmt::format("--robot: {}={} is out of range; give {} to {}", key, text, least, most));
}

std::string text_of(const std::string& key, const std::string& text) {
  if (!text.empty()) return text;
  throw UsageError(fmt::format("--robot: {}= has no value", key));
}

// X/Y/Z[/QX/QY/QZ/QW].
Eigen::Isometry3d pose_in(std::string text) {
  const auto slashes = std::ranges::count(text, '/');
  std::ranges::replace(text, '/', ',');
  const std::string form = "X/Y/Z or X/Y/Z/QX/QY/QZ/QW: metres and a unit quaternion";
  std::vector<double> v = parse_numbers(text, slashes == 6 ? 7 : 3, "--robot: origin", form);
  if (v.size() == 3) v.insert(v.end(), {0, 0, 0, 1});
  return pose_of(v, "--robot: origin");
}

void take(RosBridgeOptions::Robot& robot, const std::string& key, const std::string& value) {
  if (key == "ns") {
    robot.ns = text_of(key, value);
  } else if (key == "topic") {
    robot.topic = text_of(key, value);
  } else if (key == "frame") {
    robot.frame = text_of(key, value);
  } else if (key == "rate") {
    robot.rate = number_of(key, value, 1, 1000);
  } else if (key == "scale") {
    robot.scale = number_of(key, value, 1e-6, 1e6);
  } else if (key == "origin") {
    robot.T_robot_world = pose_in(value);
  } else if (key == "button") {
    const double number = number_of(key, value, 0, 31);
    if (number != std::floor(number))
      throw UsageError(fmt::format("--robot: button={} is not a whole number", value));
    robot.dead_man = static_cast<int>(number);
  } else if (key == "follow" && (value == "proxy" || value == "hand")) {
    robot.hand = value == "hand";
  } else {
    throw UsageError(fmt::format(
        "--robot: '{}={}' is not an option; there are ns=, topic=, frame=, rate=, scale=, "
        "origin=X/Y/Z, button=N and follow=proxy or hand",
        key, value));
  }
}

void remap(RosBridgeOptions& bridge, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || text.front() != '/' || text.size() < equals + 2) {
    throw UsageError(
        fmt::format("--ros-remap: '{}' is not FROM=TO; write whole names, e.g. "
                    "/palpate/hand/wrench=/fd/wrench",
                    text));
  }
  bridge.remap[text.substr(0, equals)] = text.substr(equals + 1);
}

}  // namespace

RosBridgeOptions::Robot parse_robot(const std::string& text) {
  RosBridgeOptions::Robot robot;
  std::size_t comma = std::min(text.find(','), text.size());
  robot.preset = text.substr(0, comma);
  if (std::ranges::find(kRobots, robot.preset) == kRobots.end()) {
    throw UsageError(
        fmt::format("--robot: '{}' is not a preset; give crisp, cartesian, servo, crtk or generic",
                    robot.preset));
  }
  while (comma < text.size()) {
    const std::size_t end = std::min(text.find(',', comma + 1), text.size());
    const std::string option = text.substr(comma + 1, end - comma - 1);
    const std::size_t equals = std::min(option.find('='), option.size());
    take(robot, option.substr(0, equals), option.substr(std::min(equals + 1, option.size())));
    comma = end;
  }
  if (robot.preset == "generic" && robot.topic.empty()) {
    throw UsageError("--robot: generic needs topic=TOPIC, which takes a PoseStamped");
  }
  return robot;
}

void add_bridge_options(OptionTable& table, RosPlan& plan) {
  table.under("ROS 2", "ros");
  table
      .add_flag("--publish", plan.published,
                "tell ROS 2 where hand and proxy are and what is felt, under /palpate "
                "(docs/ros2.md)")
      .only_for(kGuarded);
  table
      .add_text(
          "--robot", KeyKind::text, "PRESET[,KEY=VALUE]",
          [&plan](const std::string& text) { plan.bridge.robot = parse_robot(text); },
          "let a robot follow the first hand's proxy, where cameras see that it is free: crisp, "
          "cartesian, servo, crtk, generic. Options: ,ns=NAMESPACE; ,topic=TOPIC; ,frame=FRAME; "
          ",scale=S and ,origin=X/Y/Z: from the world to the robot; ,rate=HZ; ,button=N: only "
          "while "
          "it is held; ,follow=hand: the hand in place of the proxy. Publishes as --publish does")
      .only_for(kGuarded);
  table
      .add("--robot-retreat", plan.robot_retreat, "M/S",
           number("a speed from 0 to 1 m/s", [](double x) { return x >= 0 && x <= 1; }),
           "how fast the robot goes back towards the camera from where a surface came over it; 0: "
           "it stands still (default 0.05 m/s)")
      .only_for(kRobot);
  table
      .add_texts(
          "--robot-sources", KeyKind::texts, "NAME",
          [&plan](const std::string& name) { plan.robot_sources.push_back(name); },
          "a source whose camera says where the robot may go; repeat for each (default: all)")
      .only_for(kRobot);
  table.add_choice("--ros-range", plan.range, kRanges,
                   "localhost: programs on this machine; subnet: the whole network (default: "
                   "ROS_AUTOMATIC_DISCOVERY_RANGE, else localhost)");
  table.add_texts(
      "--ros-remap", KeyKind::texts, "FROM=TO",
      [&plan](const std::string& text) { remap(plan.bridge, text); },
      "another name for a topic that is published; repeat for each");
  table.add_key("--publish-rate", plan.bridge.rate,
                number("a rate from 1 to 1000 Hz", [](double x) { return x >= 1 && x <= 1000; }));
}

RosBridgeOptions RosPlan::options() const {
  RosBridgeOptions options = bridge;
  if (!options.robot) return options;
  options.robot->retreat = robot_retreat;
  options.robot->sources = robot_sources;
  return options;
}

void use_range(const std::string& range) {
  if (range.empty()) return;
  setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", range == "subnet" ? "SUBNET" : "LOCALHOST", 1);
  unsetenv("ROS_LOCALHOST_ONLY");
}

}  // namespace palpate::app
