// A simulated device that a node of ROS 2 owns, in real time, with the preset fd's topics:
// hand_node RATE DELAY_MS SECONDS DAMPING. Its hand goes from 10 mm above z = 0 to 10 mm below in
// the fifth second. What it measured is sent DELAY_MS later, and what it is told acts DELAY_MS
// later. Prints how far the device moved up and down (mm) from 60 to 85 % of the time, and in the
// quietest quarter second of it: a machine that stalls kicks it now and then.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "dds/endpoint.hpp"
#include "message/sensor_types.hpp"
#include "message/transforms.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace {

using namespace palpate;
using Eigen::Vector3d;

template <class T>
struct Waiting {
  double due = 0;
  T message;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) return 2;
  const double rate = std::stod(arguments[1]);
  const double delay = std::stod(arguments[2]) / 1e3;
  const double seconds = std::stod(arguments[3]);
  SimulatedDeviceOptions options{.mass = 0.1,
                                 .damping = std::stod(arguments[4]),
                                 .coulomb = 0,
                                 .delay = 0,
                                 .rate = rate,
                                 .hand = {.stiffness = 100, .damping = 0}};
  SimulatedDevice device(
      options,
      {{0, {0, 0, 0.01}}, {4, {0, 0, 0.01}}, {5, {0, 0, -0.01}}, {seconds, {0, 0, -0.01}}});
  const dds::Participant participant(dds::environment_options());
  dds::Writer<message::PoseStamped> poses(participant, "/fd/ee_pose", {.reliable = true});
  dds::Reader<message::Float64MultiArray> forces(participant, "/fd/fd_controller/commands",
                                                 {.reliable = true});
  static_cast<void>(make_realtime({.priority = 70}));
  SteadyClock clock;
  std::deque<Waiting<message::PoseStamped>> waiting;
  std::deque<Waiting<Vector3d>> told;
  message::Float64MultiArray force;
  std::map<int, std::pair<double, double>> windows;  // lowest and highest in each, m
  double lowest = 1;
  double highest = -1;
  const double start = clock.now();
  for (std::uint64_t step = 0; static_cast<double>(step) < seconds * rate; ++step) {
    clock.wait_until(start + static_cast<double>(step) / rate);
    const DeviceState state = device.read();
    const Vector3d& at = state.position;
    message::PoseStamped pose{{message::to_time(message::system_now()), "fd_base"},
                              {{at.z(), at.x(), at.y()}, {}}};
    waiting.push_back({clock.now() + delay, pose});
    const auto is_due = [&](const auto& queue) {
      return !queue.empty() && queue.front().due <= clock.now() + (delay > 0 ? 0.5e-3 : 0);
    };
    for (; is_due(waiting); waiting.pop_front()) poses.write(waiting.front().message);
    if (forces.take(force) && force.data.size() >= 3)
      told.push_back({clock.now() + delay, {force.data[1], -force.data[0], force.data[2]}});
    for (; is_due(told); told.pop_front()) device.write(told.front().message);
    const double share = static_cast<double>(step) / (seconds * rate);
    if (share < 0.6 || share > 0.85) continue;
    const double height = device.true_position().z();
    const int window = static_cast<int>(static_cast<double>(step) / (0.25 * rate));
    auto& [low, high] = windows.try_emplace(window, height, height).first->second;
    low = std::min(low, height);
    high = std::max(high, height);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [window, range] : windows) least = std::min(least, range.second - range.first);
  fmt::print("moved {:.3f} mm around {:.3f}, {:.3f} mm at the quietest\n", 1e3 * (highest - lowest),
             500 * (highest + lowest), 1e3 * least);
}
