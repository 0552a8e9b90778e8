// Replaces the Haply driver in builds without Boost.
#include "device/drivers.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {

DriverInfo list_haply() {
  return {.name = "haply",
          .description = "Haply Inverse3",
          .available = false,
          .missing =
              "this build cannot connect to Haply's Inverse Service. Install libboost-dev (Debian, "
              "Ubuntu) and rebuild palpate"};
}

std::unique_ptr<DeviceDriver> open_haply(const DeviceName& /*name*/, const Clock& /*clock*/) {
  throw Error("haply: " + list_haply().missing);
}

}  // namespace palpate::device
