#include "apps/palpate/doctor/known_devices.hpp"

#include <algorithm>
#include <array>

namespace palpate::app::doctor {

namespace {

// How devices are told apart: by vendor and product, any product where that is empty, and, where a
// vendor makes other things too, by a word of what the device calls itself.
struct Sign {
  std::string_view vendor;
  std::string_view product;
  std::string_view word;
  KnownDevice known;
};

constexpr auto kHaptic = DeviceKind::haptic;
constexpr auto kCamera = DeviceKind::camera;
constexpr auto kPart = DeviceKind::part;

constexpr std::array kSigns = {
    Sign{"1451", "", "", {"Force Dimension", kHaptic, "libdhd.so.3", ""}},
    Sign{"0403", "cb48", "", {"Novint Falcon", kHaptic, "libdhd.so.3", "ftdi_sio"}},
    Sign{"2988", "", "", {"3D Systems Touch", kHaptic, "libHD.so", ""}},
    Sign{"0301", "2988", "", {"3D Systems Touch Stylus", kHaptic, "libHD.so", ""}},
    Sign{"", "", "Haply", {"Haply", kHaptic, "service", ""}},
    Sign{"1d27", "", "", {"PrimeSense or Xtion", kCamera, "openni2", ""}},
    Sign{"045e", "02ae", "", {"Kinect v1", kCamera, "freenect", "gspca_kinect"}},
    Sign{"045e", "02bf", "", {"Kinect v1 for Windows", kCamera, "freenect", "gspca_kinect"}},
    Sign{"045e", "02b0", "", {"Kinect's motor", kPart, "", ""}},
    Sign{"045e", "02ad", "", {"Kinect's microphones", kPart, "", ""}},
    Sign{"8086", "", "RealSense", {"RealSense", kCamera, "", ""}},
};

bool fits(const Sign& sign, const UsbDevice& device) {
  const auto is = [](std::string_view wanted, const std::string& told) {
    return wanted.empty() || wanted == told;
  };
  return is(sign.vendor, device.vendor) && is(sign.product, device.product) &&
         device.title.find(sign.word) != std::string::npos;
}

}  // namespace

std::vector<Found> known_among(const std::vector<UsbDevice>& devices) {
  std::vector<Found> found;
  for (const UsbDevice& device : devices) {
    const auto sign =
        std::ranges::find_if(kSigns, [&](const Sign& each) { return fits(each, device); });
    if (sign != kSigns.end()) found.push_back({device, sign->known});
  }
  return found;
}

bool reaches_any(std::string_view way, const std::vector<Found>& found) {
  return std::ranges::any_of(found,
                             [way](const Found& each) { return each.known.reached_by == way; });
}

}  // namespace palpate::app::doctor
