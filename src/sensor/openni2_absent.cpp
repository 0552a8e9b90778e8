#include "palpate/base/error.hpp"
#include "sensor/drivers.hpp"

namespace palpate::sensor {

DriverInfo openni2_driver() {
  return {
      .name = "openni2",
      .description = "PrimeSense and Asus Xtion cameras, and .oni recordings",
      .available = false,
      .missing =
          "this build has no OpenNI2. Install libopenni2-dev (Debian, Ubuntu) and rebuild palpate.",
      .devices = {}};
}

std::unique_ptr<DepthCamera> open_openni2(const std::string& /*device*/,
                                          const CameraOptions& /*options*/) {
  throw Error("openni2: " + openni2_driver().missing);
}

}  // namespace palpate::sensor
