// PrimeSense and Xtion cameras and .oni recordings through OpenNI2.
#include <OpenNI.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string_view>
#include <thread>

#include "palpate/base/error.hpp"
#include "sensor/drivers.hpp"
#include "sensor/kinect_depth.hpp"
#include "sensor/live_camera.hpp"

namespace palpate::sensor {
namespace {

constexpr float kAsAsked = -1;  // playback speed: a frame whenever one is read
constexpr auto kTwoFrames = std::chrono::milliseconds(80);
constexpr double kMicrosecond = 1e-6;

// What OpenNI2 says of its last error, on one line.
std::string last_words() {
  std::string words = openni::OpenNI::getExtendedError();
  std::ranges::replace_if(
      words, [](char c) { return c < ' '; }, ' ');
  const std::size_t begin = words.find_first_not_of(' ');
  if (begin == std::string::npos) return "no reason given";
  return words.substr(begin, words.find_last_not_of(' ') - begin + 1);
}

// The library counts how often it was started.
class Library {
 public:
  Library() {
    if (openni::OpenNI::initialize() == openni::STATUS_OK) return;
    throw Error(
        fmt::format("openni2: the library does not start ({}). Install libopenni2-0 again; "
                    "its drivers lie in OpenNI2/Drivers beside it.",
                    last_words()));
  }
  ~Library() { openni::OpenNI::shutdown(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

bool is_recording(std::string_view device) {
  return device.ends_with(".oni") || device.ends_with(".ONI");
}

// What a camera that cannot be opened may need.
std::string remedy(const std::string& device) {
  if (is_recording(device)) {
    return "Is it an OpenNI2 recording, whole and readable? Those of OpenNI 1 are not always";
  }
  return "Plug it into USB; be in the group video or plugdev (the udev rules come with "
         "libopenni2-0), and end other programs that use it. Orbbec's Astra needs Orbbec's own "
         "OpenNI2";
}

class OpenNi2Connection final : public Connection {
 public:
  OpenNi2Connection(std::shared_ptr<const Library> library, std::string name,
                    const std::string& device, const CameraOptions& options)
      : library_(std::move(library)), name_(std::move(name)), device_name_(device) {
    const char* uri = device.empty() ? openni::ANY_DEVICE : device.c_str();
    check(device_.open(uri), "cannot be opened");
    check(stream_.create(device_, openni::SENSOR_DEPTH), "has no depth that can be had");
    choose_mode();
    if (stream_.getMirroringEnabled()) (void)stream_.setMirroringEnabled(false);
    mirrored_ = stream_.getMirroringEnabled();
    across_ = stream_.getHorizontalFieldOfView();
    down_ = stream_.getVerticalFieldOfView();
    if (device_.isFile()) start_playback(options);
    check(stream_.start(), "does not start");
  }

  ~OpenNi2Connection() override {
    frame_.release();
    if (device_.isFile()) calm_player();
    stream_.stop();
    stream_.destroy();
    device_.close();
  }
  OpenNi2Connection(const OpenNi2Connection&) = delete;
  OpenNi2Connection& operator=(const OpenNi2Connection&) = delete;

  [[nodiscard]] CameraStatus fetch(DepthFrame& frame, double& device_time,
                                   double timeout) override {
    if (at_end_) return CameraStatus::ended;
    openni::VideoStream* stream = &stream_;
    int ready = 0;
    const auto status = openni::OpenNI::waitForAnyStream(
        &stream, 1, &ready, static_cast<int>(std::lround(1e3 * std::clamp(timeout, 0.0, 60.0))));
    if (status == openni::STATUS_TIME_OUT) return CameraStatus::waiting;
    check(status, "stopped delivering");
    check(stream_.readFrame(&frame_), "stopped delivering");
    if (once_ && frame_.getFrameIndex() <= last_) {  // it began again
      at_end_ = true;
      return CameraStatus::ended;
    }
    fill(frame);
    device_time = kMicrosecond * static_cast<double>(frame_.getTimestamp());
    last_ = frame_.getFrameIndex();
    at_end_ = once_ && last_ >= frames_;
    frame_.release();
    return CameraStatus::frame;
  }

 private:
  void check(openni::Status status, std::string_view what) const {
    if (status == openni::STATUS_OK) return;
    throw Error(fmt::format("{}: {} ({}). {}.", name_, what, last_words(), remedy(device_name_)));
  }

  // Some devices start in units of 100 um or in a small mode; recordings are as they are.
  void choose_mode() {
    if (device_.isFile()) return;
    const auto& modes = stream_.getSensorInfo().getSupportedVideoModes();
    for (int i = 0; i < modes.getSize(); ++i) {
      const openni::VideoMode& mode = modes[i];
      const bool wanted = mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM &&
                          mode.getResolutionX() == 640 && mode.getResolutionY() == 480 &&
                          mode.getFps() == 30;
      if (wanted && stream_.setVideoMode(mode) == openni::STATUS_OK) return;
    }
  }

  void start_playback(const CameraOptions& options) {
    openni::PlaybackControl* control = device_.getPlaybackControl();
    if (control == nullptr) return;
    // Repeated always: at an end without repetition the player's thread runs wild (see
    // calm_player).
    (void)control->setRepeatEnabled(true);
    if (options.clock == nullptr) (void)control->setSpeed(kAsAsked);
    once_ = !options.loop;
    frames_ = control->getNumberOfFrames(stream_);
  }

  // OpenNI2's player looks through its list of streams between frames and takes no lock, so a
  // stream must not go meanwhile. Told to wait until it is asked, it rests in the next frame.
  void calm_player() {
    if (openni::PlaybackControl* control = device_.getPlaybackControl()) {
      (void)control->setSpeed(kAsAsked);
      std::this_thread::sleep_for(kTwoFrames);
    }
  }

  [[nodiscard]] Pinhole pinhole(int width, int height) const {
    const bool known = across_ > 0 && across_ < 3 && down_ > 0 && down_ < 3;
    if (!known) return kinect_pinhole(width, height);
    return {.fx = width / (2 * std::tan(across_ / 2)),
            .fy = height / (2 * std::tan(down_ / 2)),
            .cx = width / 2.0,
            .cy = height / 2.0};
  }

  void fill(DepthFrame& frame) const {
    const int width = frame_.getWidth();
    const int height = frame_.getHeight();
    const auto format = frame_.getVideoMode().getPixelFormat();
    const bool fine = format == openni::PIXEL_FORMAT_DEPTH_100_UM;
    const int stride = frame_.getStrideInBytes();
    const bool whole = frame_.getData() != nullptr && width > 0 && height > 0 &&
                       stride >= width * 2 &&
                       frame_.getDataSize() >= stride * (height - 1) + 2 * width;
    if (!whole || (!fine && format != openni::PIXEL_FORMAT_DEPTH_1_MM)) {
      throw Error(
          fmt::format("{}: a damaged frame of {} x {} pixels and {} bytes. If it happens "
                      "again, plug the camera into another USB socket.",
                      name_, width, height, frame_.getDataSize()));
    }
    frame.camera = {width, height, pinhole(width, height), {}};
    frame.depth.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    frame.colors.clear();
    const double unit = fine ? 1e-4 : 1e-3;
    const auto* bytes = static_cast<const std::byte*>(frame_.getData());
    for (int v = 0; v < height; ++v) {
      const auto* row = reinterpret_cast<const openni::DepthPixel*>(bytes + v * stride);
      float* out = frame.depth.data() + v * width;
      std::transform(row, row + width, out,
                     [unit](openni::DepthPixel z) { return static_cast<float>(unit * z); });
      if (mirrored_) std::reverse(out, out + width);
    }
  }

  std::shared_ptr<const Library> library_;
  std::string name_;
  std::string device_name_;
  openni::Device device_;
  openni::VideoStream stream_;
  openni::VideoFrameRef frame_;
  bool mirrored_ = false;
  double across_ = 0;  // field of view, rad; 0: not known
  double down_ = 0;
  bool once_ = false;  // a recording that is played once
  int frames_ = 0;     // of a recording
  int last_ = 0;       // the frame's number in it
  bool at_end_ = false;
};

void list_devices(CameraDriver& driver) {
  const Library library;
  openni::Array<openni::DeviceInfo> devices;
  openni::OpenNI::enumerateDevices(&devices);
  for (int i = 0; i < devices.getSize(); ++i) {
    driver.devices.push_back(
        {.name = fmt::format("openni2:{}", devices[i].getUri()),
         .description = fmt::format("{} {}", devices[i].getVendor(), devices[i].getName())});
  }
}

}  // namespace

CameraDriver openni2_driver() {
  CameraDriver driver{.name = "openni2",
                      .description = "PrimeSense and Asus Xtion cameras, and .oni recordings",
                      .missing = {},
                      .devices = {}};
  try {
    list_devices(driver);
  } catch (const Error& error) {
    driver.available = false;
    driver.missing = error.what();
  }
  return driver;
}

std::unique_ptr<DepthCamera> open_openni2(const std::string& device, const CameraOptions& options) {
  const std::string name = device.empty() ? "openni2" : "openni2:" + device;
  if (is_recording(device) && !std::filesystem::exists(device)) {
    throw Error(name + ": no such file. Check the path.");
  }
  const char* silence =
      is_recording(device)
          ? "Recordings without the properties of a camera (those of OpenNI2's dummy device) are "
            "never played by OpenNI2; record it again from a camera."
          : "Plug it out and in again, into USB 2 if it is on USB 3.";
  // Started here once: a stream opens a lost device again on its own thread.
  const auto library = std::make_shared<Library>();
  return std::make_unique<LiveCamera>(
      CameraInfo{
          .name = name, .rate = 30, .paces = !is_recording(device) || options.clock != nullptr},
      [=] { return std::make_unique<OpenNi2Connection>(library, name, device, options); }, silence,
      options.clock);
}

}  // namespace palpate::sensor
