// Options of ROS 2.
#pragma once

#include <string>
#include <vector>

#include "palpate/ros/bridge.hpp"

namespace palpate::app {

class OptionTable;

/// Settings of ROS 2, besides sources and devices.
struct RosPlan {
  bool published =
      false;  ///< what hands do and feel is published; a robot gets targets where there is one
  std::string range = {};  ///< "localhost" or "subnet"; empty: as the environment has it
  RosBridgeOptions bridge = {};
  double robot_retreat = RosBridgeOptions::Robot().retreat;  ///< m/s
  std::vector<std::string> robot_sources = {};

  /// Options of the bridge.
  [[nodiscard]] RosBridgeOptions options() const;
  [[nodiscard]] bool wanted() const { return published || bridge.robot; }
};

/// "PRESET[,KEY=VALUE]...", as --robot has it.
/// @throws UsageError when an option is not one.
[[nodiscard]] RosBridgeOptions::Robot parse_robot(const std::string& text);

void add_bridge_options(OptionTable& table, RosPlan& plan);

/// Lets all of this process's ROS 2 have a range; empty: as the environment has it. Before anything
/// is opened.
void use_range(const std::string& range);

}  // namespace palpate::app
