#include "palpate/base/error.hpp"
#include "sensor/drivers.hpp"

namespace palpate::sensor {

DriverInfo freenect_driver() {
  return {.name = "freenect",
          .description = "Kinect v1",
          .available = false,
          .missing =
              "this build has no libfreenect. Install libfreenect-dev (Debian, Ubuntu) and rebuild "
              "palpate.",
          .devices = {}};
}

std::unique_ptr<DepthCamera> open_freenect(const std::string& /*device*/,
                                           const CameraOptions& /*options*/) {
  throw Error("freenect: " + freenect_driver().missing);
}

}  // namespace palpate::sensor
