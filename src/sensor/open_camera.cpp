// Lists camera drivers and opens a camera by name.
#include <fmt/format.h>

#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sensor/live_camera.hpp"
#include "sensor/sequence.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate {
namespace {

using namespace sensor;

DriverInfo simulated_driver() {
  DriverInfo driver{.name = "simulated",
                    .description = "analytic scenes with simulated sensor noise"};
  for (const SimulatedName& scene : simulated_names()) {
    driver.devices.push_back({"simulated:" + scene.name, scene.description});
  }
  return driver;
}

DriverInfo sequence_driver() {
  return {.name = "sequence",
          .description = "folders of depth images or clouds: sequence:DIR (docs/sequences.md)"};
}

}  // namespace

std::unique_ptr<DepthCamera> open_camera(const std::string& name, const CameraOptions& options) {
  const std::size_t colon = name.find(':');
  const std::string driver = name.substr(0, colon);
  const std::string device = colon == std::string::npos ? "" : name.substr(colon + 1);
  if (driver == "simulated") return open_simulated(device, options.clock);
  if (driver == "sequence") {
    return open_sequence(read_sequence(device), {.clock = options.clock, .loop = options.loop});
  }
  if (driver == "openni2") return open_openni2(device, options);
  if (driver == "freenect") return open_freenect(device, options);
  if (driver == "bag") return open_bag(device, options);
  if (driver == "ros") return open_ros(device, options);
  if (driver == "remote") return open_remote(device, options);
  if (name.ends_with(".oni")) return open_openni2(name, options);
  if (name.starts_with("simulated,")) {
    throw Error(fmt::format("{}: keys follow a scene; write simulated:table{}", name,
                            name.substr(name.find(','))));
  }
  throw Error(fmt::format(
      "{}: no such camera. Cameras are simulated[:SCENE], sequence:DIR, bag:FILE, openni2[:URI], "
      "FILE.oni, freenect[:NUMBER], ros:TOPIC and remote[:PATH]; 'palpate cameras' lists those "
      "connected.",
      name));
}

std::vector<DriverInfo> list_cameras() {
  return {simulated_driver(), sequence_driver(), bag_driver(),   openni2_driver(),
          freenect_driver(),  ros_driver(),      remote_driver()};
}

}  // namespace palpate
