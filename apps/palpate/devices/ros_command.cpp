// The command ros: lists the topics of ROS 2 that palpate can use.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/devices/devices_command.hpp"
#include "apps/palpate/options/ros_options.hpp"
#include "palpate/ros/survey.hpp"

namespace palpate::app {

namespace {

constexpr const char* kFooter = R"(Examples:
  palpate ros
  ROS_DOMAIN_ID=7 palpate ros --ros-range subnet
  palpate touch ros:/camera/depth/image_rect_raw

No ROS 2 needs to be installed here: palpate speaks DDS, as ROS 2's usual middleware does
(docs/ros2.md). Nodes that use Zenoh are not seen.

Exit codes: 0 done, 1 DDS failed or the list could not be written, 2 the command line is wrong.)";

std::string ends_of(const RosTopic& topic) {
  return fmt::format("{} writer{}, {} reader{}", topic.writers, topic.writers == 1 ? "" : "s",
                     topic.readers, topic.readers == 1 ? "" : "s");
}

void print(const RosTopic& topic, const Style& style, std::FILE* stream) {
  const auto line = [&](const std::string& text) {
    fmt::print(stream, "{}\n", without_controls(text));
  };
  fmt::print(stream, "{}", style.heading(without_controls(topic.name)));
  line("  " + topic.type);
  std::string facts = ends_of(topic) + (topic.reliable ? ", reliable" : ", best effort");
  if (topic.rate > 0) facts += fmt::format(", {:.4g} Hz", topic.rate);
  if (!topic.frame.empty()) facts += ", frame " + topic.frame;
  line("  " + facts);
  if (!topic.mismatch.empty())
    fmt::print(stream, "  {}\n", style.warning(without_controls(topic.mismatch)));
  if (!topic.use.empty()) line("  use: " + topic.use);
}

void write(const std::vector<RosTopic>& topics, const std::string& path) {
  Json list = Json::array();
  for (const RosTopic& topic : topics) {
    list.push_back({{"name", topic.name},
                    {"type", topic.type},
                    {"writers", topic.writers},
                    {"readers", topic.readers},
                    {"reliable", topic.reliable},
                    {"rate", topic.rate},
                    {"frame", topic.frame},
                    {"use", topic.use},
                    {"mismatch", topic.mismatch}});
  }
  write_whole(path, text_of(list));
}

}  // namespace

void add_ros_options(CLI::App& command, RosOptions& options) {
  command.add_option("--seconds", options.seconds, "look and listen for this long, s")
      ->type_name("S")
      ->capture_default_str()
      ->check(CLI::Range(0.5, 60.0));
  command
      .add_option("--ros-range", options.range,
                  "localhost: this machine; subnet: the whole network (default: "
                  "ROS_AUTOMATIC_DISCOVERY_RANGE, else localhost)")
      ->type_name("RANGE")
      ->check(CLI::IsMember({"localhost", "subnet"}));
  add_json_option(command, options.json)->group("Output");
  command.footer(kFooter);
}

void ros(const RosOptions& options) {
  use_range(options.range);
  const std::vector<RosTopic> topics = [&] {
    const Waiting waiting("listening to ROS 2");
    return survey_ros(options.seconds);
  }();
  std::FILE* const stream = options.json == "-" ? stderr : stdout;
  const Style style(stream);
  for (const RosTopic& topic : topics) print(topic, style, stream);
  if (topics.empty()) {
    fmt::print(
        stream,
        "no topics found. Are the nodes in this domain (ROS_DOMAIN_ID), and on this machine? "
        "--ros-range subnet looks further; 'palpate doctor' checks the settings\n");
  }
  if (!options.json.empty()) write(topics, options.json);
}

}  // namespace palpate::app
