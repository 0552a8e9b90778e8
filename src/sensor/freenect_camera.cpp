// Kinect v1 through libfreenect. Only calls that its recording player, fakenect, has too.
#include <fmt/format.h>
#include <libfreenect.h>
#include <sys/time.h>

#include <algorithm>
#include <charconv>
#include <span>

#include "palpate/base/error.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "sensor/live_camera.hpp"

namespace palpate::sensor {
namespace {

constexpr const char* kMissing = "USB is not accessible. Give this user access to /dev/bus/usb";
constexpr const char* kSilence =
    "Is its power supply plugged in? A Kinect needs it in addition to USB.";
constexpr double kTicks = 60e6;  // Hz of the device's clock; the maker gives no figure
// Samples from here on are no depth (libfreenect's FREENECT_DEPTH_MM_MAX_VALUE)
constexpr std::uint16_t kNoMillimetres = 10'000;

struct Shutdown {
  void operator()(freenect_context* context) const { freenect_shutdown(context); }
};
using Context = std::unique_ptr<freenect_context, Shutdown>;

// Null where there is no USB.
Context make_context() {
  freenect_context* context = nullptr;
  if (freenect_init(&context, nullptr) < 0) return {};
  freenect_set_log_level(context, FREENECT_LOG_FATAL);
  freenect_select_subdevices(context, FREENECT_DEVICE_CAMERA);
  return Context(context);
}

struct Close {
  void operator()(freenect_device* device) const {
    freenect_stop_depth(device);
    freenect_close_device(device);
  }
};

// Millimetres where the library offers them, else the raw values.
freenect_frame_mode best_mode() {
  freenect_frame_mode best{};
  for (int i = 0; i < freenect_get_depth_mode_count(); ++i) {
    const freenect_frame_mode mode = freenect_get_depth_mode(i);
    if (mode.is_valid == 0 || mode.resolution != FREENECT_RESOLUTION_MEDIUM) continue;
    if (mode.depth_format == FREENECT_DEPTH_MM) return mode;
    if (mode.depth_format == FREENECT_DEPTH_11BIT) best = mode;
  }
  return best;
}

// Explains libusb's error codes to a user.
std::string why_not(int code) {
  if (code == -3) {
    return "no permission to use it. Install libfreenect0.5 (its udev rules), join the group "
           "plugdev, and plug it in again";
  }
  if (code == -6) {
    return "it is in use. Close the other program; if there is none, the kernel driver uses it: "
           "sudo modprobe -r gspca_kinect";
  }
  if (code == -4) return "it was disconnected. Plug it in again";
  return fmt::format(
      "libfreenect returned {}. Check that it is plugged into USB and its power supply, that no "
      "other program uses it, and that this user is in the group plugdev",
      code);
}

class FreenectConnection final : public Connection {
 public:
  FreenectConnection(std::string name, int number) : name_(std::move(name)) {
    context_ = make_context();
    if (!context_) throw Error(fmt::format("{}: {}.", name_, kMissing));
    const int count = freenect_num_devices(context_.get());
    if (number >= count) {
      throw Error(
          fmt::format("{}: no such Kinect, {} found. Plug it into USB and its power supply.", name_,
                      count == 0 ? "none was" : fmt::format("{} were", count)));
    }
    freenect_device* device = nullptr;
    check(freenect_open_device(context_.get(), &device, number), "cannot be opened");
    device_.reset(device);
    start();
  }

  [[nodiscard]] DepthCamera::Status fetch(DepthFrame& frame, double& device_time,
                                          double timeout) override {
    fresh_ = false;
    timeval wait{};
    wait.tv_usec = static_cast<suseconds_t>(1e6 * std::clamp(timeout, 0.0, 0.9));
    check(freenect_process_events_timeout(context_.get(), &wait), "stopped delivering");
    if (!fresh_) return DepthCamera::Status::waiting;
    device_time = seconds_;
    frame.camera = {mode_.width, mode_.height, kinect_pinhole(mode_.width, mode_.height), {}};
    frame.depth.resize(static_cast<std::size_t>(mode_.width) *
                       static_cast<std::size_t>(mode_.height));
    convert(frame.depth);
    frame.colors.clear();
    return DepthCamera::Status::frame;
  }

 private:
  void convert(std::span<float> depth) {
    const std::span samples(samples_.data(), depth.size());
    if (mode_.depth_format == FREENECT_DEPTH_11BIT) {
      std::ranges::transform(samples, depth.begin(), kinect_metres);
      return;
    }
    std::ranges::replace_if(
        samples, [](std::uint16_t sample) { return sample >= kNoMillimetres; }, std::uint16_t{0});
    to_metres(samples, 1e-3, depth);
  }

  void check(int code, std::string_view what) const {
    if (code >= 0) return;
    throw Error(fmt::format("{}: {}: {}.", name_, what, why_not(code)));
  }

  void start() {
    mode_ = best_mode();
    if (mode_.is_valid == 0) throw Error(name_ + ": has no depth mode of 640 x 480. Update it.");
    const auto pixels =
        static_cast<std::size_t>(mode_.width) * static_cast<std::size_t>(mode_.height);
    samples_.resize(std::max(pixels, static_cast<std::size_t>(mode_.bytes) / 2));
    freenect_set_user(device_.get(), this);
    freenect_set_depth_callback(device_.get(), &FreenectConnection::receive);
    check(freenect_set_depth_mode(device_.get(), mode_), "does not accept its depth mode");
    check(freenect_set_depth_buffer(device_.get(), samples_.data()), "does not accept a buffer");
    check(freenect_start_depth(device_.get()), "does not start");
  }

  // Called by process_events, so on the reading thread.
  static void receive(freenect_device* device, void* /*depth*/, std::uint32_t ticks) {
    auto& self = *static_cast<FreenectConnection*>(freenect_get_user(device));
    // The counter wraps every 72 s; its unsigned difference does not.
    self.seconds_ += static_cast<std::uint32_t>(ticks - self.ticks_) / kTicks;
    self.ticks_ = ticks;
    self.fresh_ = true;
  }

  std::string name_;
  Context context_;
  std::unique_ptr<freenect_device, Close> device_;  // before the context it goes
  freenect_frame_mode mode_{};
  std::vector<std::uint16_t> samples_;
  std::uint32_t ticks_ = 0;
  double seconds_ = 0;
  bool fresh_ = false;
};

}  // namespace

DriverInfo freenect_driver() {
  DriverInfo driver{.name = "freenect", .description = "Kinect v1"};
  const Context context = make_context();
  driver.available = context != nullptr;
  if (!context) {
    driver.missing = std::string(kMissing) + ".";
    return driver;
  }
  for (int i = 0; i < freenect_num_devices(context.get()); ++i) {
    driver.devices.push_back({.name = fmt::format("freenect:{}", i), .description = "Kinect v1"});
  }
  return driver;
}

std::unique_ptr<DepthCamera> open_freenect(const std::string& device,
                                           const CameraOptions& options) {
  int number = 0;
  const auto [end, error] = std::from_chars(device.data(), device.data() + device.size(), number);
  const bool is_number = error == std::errc() && end == device.data() + device.size();
  if (!device.empty() && (!is_number || number < 0)) {
    throw Error(
        fmt::format("freenect:{}: not a number. Give freenect or freenect:NUMBER; the first "
                    "Kinect is 0.",
                    device));
  }
  const std::string name = fmt::format("freenect:{}", number);
  return std::make_unique<LiveCamera>(
      CameraInfo{.name = name, .rate = 30, .paces = true},
      [name, number] { return std::make_unique<FreenectConnection>(name, number); }, kSilence,
      options.clock);
}

}  // namespace palpate::sensor
