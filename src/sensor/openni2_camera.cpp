// PrimeSense and Xtion cameras and .oni recordings through OpenNI2.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "base/shared_library.hpp"
#include "palpate/base/error.hpp"
#include "sensor/live_camera.hpp"
#include "sensor/openni2_library.hpp"

namespace palpate::sensor {
namespace {

constexpr float kOnRead = -1;  // playback speed: a frame whenever one is read
constexpr auto kTwoFrames = std::chrono::milliseconds(80);
constexpr double kMicrosecond = 1e-6;

using Library = std::shared_ptr<const OpenNi2Library>;

bool is_recording(std::string_view device) {
  return device.ends_with(".oni") || device.ends_with(".ONI");
}

// Suggests what to do about a camera that cannot be opened.
std::string remedy(const std::string& device) {
  if (is_recording(device)) {
    return "Check that it is a complete, readable OpenNI2 recording; OpenNI 1 recordings do not "
           "always work";
  }
  return "Plug it into USB, join the group video or plugdev (libopenni2-0 installs the udev "
         "rules), and close other programs that use it. The Orbbec Astra needs Orbbec's own "
         "OpenNI2";
}

// A device, and a frame of it: closed, released.
struct CloseDevice {
  Library library;
  void operator()(_OniDevice* device) const { (void)library->close(device); }
};
struct ReleaseFrame {
  Library library;
  void operator()(OniFrame* frame) const { library->release_frame(frame); }
};
using Device = std::unique_ptr<_OniDevice, CloseDevice>;
using Frame = std::unique_ptr<OniFrame, ReleaseFrame>;

// A property of a stream; `otherwise` where it has none.
template <class T>
T property(const OpenNi2Library& library, OniStreamHandle stream, int id, T otherwise) {
  T value = otherwise;
  int size = sizeof value;
  return library.get_property(stream, id, &value, &size) == ONI_STATUS_OK ? value : otherwise;
}

// The depth of a device. The destructor stops it.
class DepthStream {
 public:
  DepthStream(Library library, OniDeviceHandle device)
      : library_(std::move(library)), device_(device) {}
  ~DepthStream() {
    if (stream_ == nullptr) return;
    if (is_file()) calm_player();
    library_->stop(stream_);
    library_->destroy_stream(stream_);
  }
  DepthStream(const DepthStream&) = delete;
  DepthStream& operator=(const DepthStream&) = delete;

  [[nodiscard]] OniStatus create() {
    return library_->create_stream(device_, ONI_SENSOR_DEPTH, &stream_);
  }
  [[nodiscard]] OniStreamHandle get() const { return stream_; }

  [[nodiscard]] bool is_file() const {
    return library_->has_device_property(device_, ONI_DEVICE_PROPERTY_PLAYBACK_SPEED) != 0;
  }

  // Some devices start in units of 100 um or in a small mode.
  void choose_mode() {
    const OniSensorInfo* sensor = library_->get_sensor_info(device_, ONI_SENSOR_DEPTH);
    for (int i = 0; sensor != nullptr && i < sensor->numSupportedVideoModes; ++i) {
      const OniVideoMode& mode = sensor->pSupportedVideoModes[i];
      const bool wanted = mode.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_1_MM &&
                          mode.resolutionX == 640 && mode.resolutionY == 480 && mode.fps == 30;
      if (wanted && set(ONI_STREAM_PROPERTY_VIDEO_MODE, mode)) return;
    }
  }

  void play(bool on_read) {
    // Repeated always: at an end without repetition the player's thread runs wild (calm_player).
    const OniBool repeat = TRUE;
    (void)library_->set_device_property(device_, ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED,
                                        &repeat, sizeof repeat);
    if (on_read) set_speed(kOnRead);
  }

  template <class T>
  bool set(int id, const T& value) {
    return library_->set_property(stream_, id, &value, sizeof value) == ONI_STATUS_OK;
  }

 private:
  void set_speed(float speed) {
    (void)library_->set_device_property(device_, ONI_DEVICE_PROPERTY_PLAYBACK_SPEED, &speed,
                                        sizeof speed);
  }

  // OpenNI2's player looks through its list of streams between frames and takes no lock, so a
  // stream must not go meanwhile. Set to wait until it is read, it rests in the next frame.
  void calm_player() {
    set_speed(kOnRead);
    std::this_thread::sleep_for(kTwoFrames);
  }

  Library library_;
  OniDeviceHandle device_;
  OniStreamHandle stream_ = nullptr;
};

// Detects when a recording that is played once has been shown: its player begins again.
class PlayedOnce {
 public:
  // `frames`: how many it has; not above 0: unknown.
  explicit PlayedOnce(int frames)
      : frames_(frames > 0 ? frames : std::numeric_limits<int>::max()) {}

  // Takes the number of the next frame. False: that is one of the beginning.
  [[nodiscard]] bool take(int number) {
    if (number <= last_) over_ = true;
    if (over_) return false;
    last_ = number;
    over_ = last_ >= frames_;
    return true;
  }
  [[nodiscard]] bool is_over() const { return over_; }

 private:
  int frames_;
  int last_ = 0;
  bool over_ = false;
};

class OpenNi2Connection final : public Connection {
 public:
  OpenNi2Connection(const Library& library, std::string name, const std::string& device,
                    const CameraOptions& options)
      : library_(library),
        name_(std::move(name)),
        device_name_(device),
        device_(open_device(), {library}),
        stream_(library, device_.get()) {
    check(stream_.create(), "has no depth stream");
    if (stream_.is_file()) {
      stream_.play(options.clock == nullptr);
      if (!options.loop) once_.emplace(get(ONI_STREAM_PROPERTY_NUMBER_OF_FRAMES, 0));
    } else {
      stream_.choose_mode();
    }
    if (mirrored()) (void)stream_.set(ONI_STREAM_PROPERTY_MIRRORING, OniBool{FALSE});
    mirrored_ = mirrored();
    across_ = static_cast<double>(get(ONI_STREAM_PROPERTY_HORIZONTAL_FOV, 0.0F));
    down_ = static_cast<double>(get(ONI_STREAM_PROPERTY_VERTICAL_FOV, 0.0F));
    check(library_->start(stream_.get()), "does not start");
  }

  [[nodiscard]] DepthCamera::Status fetch(DepthFrame& frame, double& device_time,
                                          double timeout) override {
    if (once_ && once_->is_over()) return DepthCamera::Status::ended;
    OniStreamHandle stream = stream_.get();
    int ready = 0;
    const int milliseconds = static_cast<int>(std::lround(1e3 * std::clamp(timeout, 0.0, 60.0)));
    const OniStatus status = library_->wait(&stream, 1, &ready, milliseconds);
    if (status == ONI_STATUS_TIME_OUT) return DepthCamera::Status::waiting;
    check(status, "stopped delivering");
    OniFrame* raw = nullptr;
    check(library_->read_frame(stream, &raw), "stopped delivering");
    const Frame image(raw, {library_});
    if (once_ && !once_->take(image->frameIndex)) return DepthCamera::Status::ended;
    if (!is_whole(*image)) {
      damaged_ =
          fmt::format("{} x {} pixels in {} bytes", image->width, image->height, image->dataSize);
      return DepthCamera::Status::damaged;
    }
    copy_depth(*image, mirrored_, frame.depth);
    frame.colors.clear();
    frame.camera = {image->width, image->height, pinhole(image->width, image->height), {}};
    device_time = kMicrosecond * static_cast<double>(image->timestamp);
    return DepthCamera::Status::frame;
  }

  [[nodiscard]] std::string damage() const override {
    return fmt::format("{}: a damaged frame of {}. {}", name_, damaged_,
                       is_recording(device_name_)
                           ? "It was skipped."
                           : "If it happens again, plug the camera into another USB port.");
  }

 private:
  void check(OniStatus status, std::string_view what) const {
    if (status == ONI_STATUS_OK) return;
    throw Error(
        fmt::format("{}: {} ({}). {}.", name_, what, library_->last_words(), remedy(device_name_)));
  }

  [[nodiscard]] OniDeviceHandle open_device() const {
    OniDeviceHandle device = nullptr;
    const char* any = nullptr;
    check(library_->open(device_name_.empty() ? any : device_name_.c_str(), &device),
          "cannot be opened");
    return device;
  }

  template <class T>
  [[nodiscard]] T get(int id, T otherwise) const {
    return property(*library_, stream_.get(), id, otherwise);
  }
  [[nodiscard]] bool mirrored() const {
    return get(ONI_STREAM_PROPERTY_MIRRORING, OniBool{FALSE}) != FALSE;
  }

  [[nodiscard]] Pinhole pinhole(int width, int height) const {
    const bool valid = across_ > 0 && across_ < 3 && down_ > 0 && down_ < 3;
    if (!valid) return kinect_pinhole(width, height);
    return {.fx = width / (2 * std::tan(across_ / 2)),
            .fy = height / (2 * std::tan(down_ / 2)),
            .cx = width / 2.0,
            .cy = height / 2.0};
  }

  Library library_;
  std::string name_;
  std::string device_name_;
  Device device_;
  DepthStream stream_;  // goes before its device
  bool mirrored_ = false;
  double across_ = 0;  // field of view, rad; 0: unknown
  double down_ = 0;
  std::optional<PlayedOnce> once_;
  std::string damaged_;  // what the last damaged frame was like
};

void list_devices(DriverInfo& driver) {
  const OpenNi2Library library;
  OniDeviceInfo* devices = nullptr;
  int count = 0;
  if (library.get_device_list(&devices, &count) != ONI_STATUS_OK) return;
  for (int i = 0; i < count; ++i) {
    driver.devices.push_back(
        {.name = fmt::format("openni2:{}", devices[i].uri),
         .description = fmt::format("{} {}", devices[i].vendor, devices[i].name)});
  }
  (void)library.release_device_list(devices);
}

}  // namespace

DriverInfo openni2_driver() {
  DriverInfo driver{.name = "openni2",
                    .description = "PrimeSense and Asus Xtion cameras, and .oni recordings"};
  return listed(driver, list_devices);
}

std::unique_ptr<DepthCamera> open_openni2(const std::string& device, const CameraOptions& options) {
  const std::string name = device.empty() ? "openni2" : "openni2:" + device;
  const bool recording = is_recording(device);
  std::error_code unknown;
  if (recording && !std::filesystem::exists(device, unknown)) {
    throw Error(unknown ? fmt::format("{}: cannot be read: {}", name, unknown.message())
                        : name + ": no such file. Check the path.");
  }
  const char* silence = recording ? "OpenNI2 cannot play recordings without camera properties "
                                    "(made with its dummy device); record it again from a camera."
                                  : "Unplug it and plug it in again, into USB 2 if it is on USB 3.";
  // Started here once: a stream opens a lost device again on its own thread.
  const Library library = std::make_shared<OpenNi2Library>();
  return std::make_unique<LiveCamera>(
      CameraInfo{.name = name, .rate = 30, .paces = !recording || options.clock != nullptr},
      [=] { return std::make_unique<OpenNi2Connection>(library, name, device, options); }, silence,
      options.clock, recording ? Lost::ended : Lost::opened_again);
}

}  // namespace palpate::sensor
