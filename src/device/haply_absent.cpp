#include "device/drivers.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

constexpr const char* kMissing =
    "this build cannot speak to Haply's Inverse Service. Install libboost-dev (Debian, Ubuntu) and "
    "build palpate again";

}  // namespace

DriverInfo haply_driver() {
  return {.name = "haply",
          .description = "Haply Inverse3",
          .available = false,
          .missing = kMissing,
          .devices = {}};
}

std::unique_ptr<DeviceLink> open_haply(const DeviceName& /*name*/, const Clock& /*clock*/) {
  throw Error(std::string("haply: ") + kMissing);
}

}  // namespace palpate::device
