// Checks the settings of ROS 2.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "apps/palpate/doctor/checks.hpp"

namespace palpate::app::doctor {

namespace {

constexpr const char* kRos2 = "ROS 2";
// What palpate requires: a cloud of 640 x 480 points comes in one burst.
constexpr long kReceiveBuffer = 4L << 20;
constexpr int kLargestDomain = 232;     // whose ports are below 65536
constexpr int kFirstTakenDomain = 102;  // whose ports Linux gives to programs that request any
constexpr int kLastTakenDomain = 214;
constexpr std::array<std::string_view, 4> kRanges = {"LOCALHOST", "SUBNET", "OFF",
                                                     "SYSTEM_DEFAULT"};

Answer dds(const Machine& machine) {
  const auto ros = std::ranges::find(machine.cameras, "ros", &DriverInfo::name);
  if (ros != machine.cameras.end() && ros->available) return good("in this build");
  return note(
      "this build has no ROS 2: no ros: cameras, clouds and hands, nothing is published",
      "sudo apt install cyclonedds-dev && cmake --preset release && ninja -C build/release");
}

Answer middleware(const Machine& machine) {
  const std::string name = variable(machine.system, "RMW_IMPLEMENTATION");
  if (name.empty()) return good("not set: ROS 2's nodes use DDS, as palpate does");
  if (name.find("zenoh") != std::string::npos) {
    return warning(name +
                       ": nodes that use it speak no DDS, so palpate and they do not see one "
                       "another; start this bridge beside them",
                   "zenoh-bridge-ros2dds");
  }
  for (const char* speaks_dds : {"cyclonedds", "fastrtps", "connext", "gurumdds"}) {
    if (name.find(speaks_dds) != std::string::npos) return good(name + " speaks DDS");
  }
  return note(name + " is not known to speak DDS; see what palpate finds", "palpate ros");
}

Answer domain(const Machine& machine) {
  const std::string text = variable(machine.system, "ROS_DOMAIN_ID");
  if (text.empty()) return good("not set: domain 0");
  int id = -1;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, id);
  if (error != std::errc() || stop != end || id < 0 || id > kLargestDomain) {
    return problem(
        fmt::format("'{}' is not a number from 0 to {}: palpate refuses it", text, kLargestDomain),
        "export ROS_DOMAIN_ID=0");
  }
  if (id >= kFirstTakenDomain && id <= kLastTakenDomain) {
    return note(
        fmt::format("domain {}: its ports may be taken by other programs; 0 to 101 are free "
                    "of that",
                    id),
        "export ROS_DOMAIN_ID=42");
  }
  return good(fmt::format("domain {}: only nodes of the same are seen", id));
}

Answer range(const Machine& machine) {
  const std::string text = variable(machine.system, "ROS_AUTOMATIC_DISCOVERY_RANGE");
  const bool only_local = variable(machine.system, "ROS_LOCALHOST_ONLY") == "1";
  const std::string peers = variable(machine.system, "ROS_STATIC_PEERS");
  if (!text.empty() && std::ranges::find(kRanges, text) == kRanges.end()) {
    return problem(fmt::format("ROS_AUTOMATIC_DISCOVERY_RANGE={} is none of LOCALHOST, SUBNET, OFF "
                               "and SYSTEM_DEFAULT: palpate refuses it",
                               text),
                   "export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST");
  }
  if (text == "SUBNET" && only_local) {
    return note(
        "ROS_LOCALHOST_ONLY=1 overrides ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET; other machines "
        "cannot see palpate",
        "unset ROS_LOCALHOST_ONLY");
  }
  if (text == "SUBNET") return good("the whole network");
  if (text == "OFF") {
    return note(
        "ROS_AUTOMATIC_DISCOVERY_RANGE=OFF: nodes find nobody by themselves; this machine "
        "can still see palpate",
        "export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST");
  }
  return good(peers.empty() ? "this machine only; --ros-range subnet opens it to others"
                            : "this machine and " + peers);
}

// Cyclone DDS takes a list of files and of XML.
Answer settings(const Machine& machine) {
  const std::string text = variable(machine.system, "CYCLONEDDS_URI");
  if (text.empty()) return good("not set: palpate sets its domain up by itself");
  const std::string path = text.starts_with("file://") ? text.substr(7) : text;
  if (path.starts_with('/') && path.find(',') == std::string::npos &&
      !is_there(machine.system, path.substr(1))) {
    return problem(path + " does not exist: DDS does not start", "unset CYCLONEDDS_URI");
  }
  return good("its settings hold, and palpate's for range and buffers do not");
}

Answer network_buffer(const Machine& machine) {
  const auto bytes = whole_number(machine.system, "proc/sys/net/core/rmem_max");
  if (!bytes) return good("unknown (net.core.rmem_max)");
  const std::string words =
      fmt::format("net.core.rmem_max is {:.1f} MB", 1e-6 * static_cast<double>(*bytes));
  if (*bytes >= kReceiveBuffer) return good(words);
  return note(
      fmt::format("{}; images and clouds over DDS (ROS 2) come in bursts of more and may be lost: "
                  "{:.1f} MB are enough",
                  words, 1e-6 * kReceiveBuffer),
      fmt::format("echo net.core.rmem_max={} | sudo tee /etc/sysctl.d/60-palpate.conf && sudo "
                  "sysctl --system",
                  kReceiveBuffer));
}

constexpr std::array kRosChecks = {
    Check{kRos2, "DDS", dds},
    Check{kRos2, "RMW_IMPLEMENTATION", middleware},
    Check{kRos2, "ROS_DOMAIN_ID", domain},
    Check{kRos2, "visible to", range},
    Check{kRos2, "CYCLONEDDS_URI", settings},
    Check{kRos2, "network buffer", network_buffer},
};

}  // namespace

void check_ros(const Machine& machine, Findings& findings) {
  run_checks(kRosChecks, machine, findings);
}

}  // namespace palpate::app::doctor
