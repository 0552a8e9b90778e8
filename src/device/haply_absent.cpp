#include "device/drivers.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {

DriverInfo haply_driver() {
  return {.name = "haply",
          .description = "Haply Inverse3",
          .available = false,
          .missing =
              "this build cannot speak to Haply's Inverse Service. Install libboost-dev (Debian, "
              "Ubuntu) and build palpate again",
          .devices = {}};
}

std::unique_ptr<DeviceLink> open_haply(const DeviceName& /*name*/, const Clock& /*clock*/) {
  throw Error("haply: " + haply_driver().missing);
}

}  // namespace palpate::device
