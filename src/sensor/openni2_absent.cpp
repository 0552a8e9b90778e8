#include "palpate/base/error.hpp"
#include "sensor/drivers.hpp"

namespace palpate::sensor {
namespace {

constexpr const char* kMissing =
    "this build has no OpenNI2. Install libopenni2-dev (Debian, Ubuntu) and build palpate again.";

}  // namespace

DriverInfo openni2_driver() {
  return {.name = "openni2",
          .description = "PrimeSense and Asus Xtion cameras, and .oni recordings",
          .available = false,
          .missing = kMissing,
          .devices = {}};
}

std::unique_ptr<DepthCamera> open_openni2(const std::string& device,
                                          const CameraOptions& /*options*/) {
  throw Error("openni2:" + device + ": " + kMissing);
}

}  // namespace palpate::sensor
