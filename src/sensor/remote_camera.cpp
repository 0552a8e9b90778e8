// Any program as a camera: it connects and sends frames (docs/remote_camera.md).
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/bound_socket.hpp"
#include "palpate/base/error.hpp"
#include "sensor/live_camera.hpp"
#include "sensor/remote_frame.hpp"

namespace palpate::sensor {
namespace {

constexpr const char* kWhat = "remote camera";
// Frames a read takes at most, so that no client blocks it (judgement)
constexpr int kMostFrames = 8;

std::string words(int error) {
  return std::system_category().message(error);
}

bool nothing_now(int error) {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

std::string words(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  const CameraModel::Distortion& d = camera.distortion;
  return fmt::format("{} x {} pixels, fx {}, fy {}, cx {}, cy {}, distortion {}, {}, {}, {}, {}",
                     camera.width, camera.height, p.fx, p.fy, p.cx, p.cy, d.k1, d.k2, d.p1, d.p2,
                     d.k3);
}

// A program that has connected.
class Client {
 public:
  Client() = default;
  explicit Client(int handle) : handle_(handle) {}
  ~Client() {
    if (handle_ >= 0) ::close(handle_);
  }
  Client(Client&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  Client& operator=(Client&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  [[nodiscard]] bool there() const { return handle_ >= 0; }
  [[nodiscard]] int handle() const { return handle_; }

  // Its last words to it; what it does not take is lost.
  void notify(const std::string& why) const {
    const std::string line = why + "\n";
    static_cast<void>(::send(handle_, line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL));
  }

 private:
  int handle_ = -1;
};

class RemoteCamera final : public DepthCamera {
 public:
  RemoteCamera(std::string name, std::string path, const Clock* clock)
      : info_{.name = std::move(name),
              .rate = 30,
              .paces = true,
              .repeats = true,
              .awaits_sender = true},
        clock_(clock != nullptr ? *clock : host_),
        path_(std::move(path)),
        socket_(kWhat, path_, BoundSocket::Kind::stream) {}

  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string reason() const override { return reason_; }
  [[nodiscard]] DepthCamera::Status read(DepthFrame& frame, double timeout) override;

 private:
  [[nodiscard]] DepthCamera::Status take(DepthFrame& frame);
  [[nodiscard]] bool take_whole(DepthFrame& frame);
  void check_camera();
  void stamp(DepthFrame& frame);
  void part();
  [[nodiscard]] bool let_in();
  void wait(double seconds) const;

  CameraInfo info_;
  SteadyClock host_;
  const Clock& clock_;
  std::string path_;
  BoundSocket socket_;
  Client client_;
  FrameAssembler assembler_;
  HostStamps stamps_;   // of this client
  std::string camera_;  // the first frame's, in words that distinguish any two; empty: none came
  std::string flaw_;    // of what the client sent, not reported yet
  std::string reason_;
};

DepthCamera::Status RemoteCamera::read(DepthFrame& frame, double timeout) {
  reason_.clear();
  for (const double end = host_.now() + timeout;;) {
    const DepthCamera::Status status = take(frame);
    bool came = false;
    try {
      came = let_in();
    } catch (const Error& error) {
      if (status != DepthCamera::Status::waiting) return status;
      reason_ = error.what();
      return DepthCamera::Status::failed;
    }
    if (status != DepthCamera::Status::waiting) return status;
    if (came) continue;
    const double left = end - host_.now();
    if (left <= 0) break;
    wait(left);
  }
  reason_ = client_.there()
                ? fmt::format("the program that is connected to '{}' sends no frame", path_)
                : fmt::format("no program is connected to '{}'; start one (docs/remote_camera.md)",
                              path_);
  return DepthCamera::Status::waiting;
}

// All that has come, up to the newest frame that is whole.
DepthCamera::Status RemoteCamera::take(DepthFrame& frame) {
  bool any = false;
  try {
    for (int i = 0; i < kMostFrames && flaw_.empty() && take_whole(frame); ++i) any = true;
  } catch (const Error& error) {
    flaw_ = error.what();
    client_.notify(flaw_);
    part();
  }
  if (any) return DepthCamera::Status::frame;
  if (flaw_.empty()) return DepthCamera::Status::waiting;
  reason_ = std::exchange(flaw_, {});
  return DepthCamera::Status::damaged;
}

// The next frame, if all of it is there.
bool RemoteCamera::take_whole(DepthFrame& frame) {
  while (client_.there()) {
    const std::span<std::byte> room = assembler_.room();
    const ssize_t got = ::recv(client_.handle(), room.data(), room.size(), MSG_DONTWAIT);
    if (got < 0 && nothing_now(errno)) return false;
    if (got <= 0) {
      if (assembler_.used() > 0) {
        flaw_ = fmt::format("a program left after {} bytes of a frame", assembler_.used());
      }
      part();
      return false;
    }
    if (!assembler_.add(static_cast<std::size_t>(got))) continue;
    check_camera();
    assembler_.take(frame);
    stamp(frame);
    return true;
  }
  return false;
}

// Refuses another camera: the memory of earlier frames belongs to the first one.
void RemoteCamera::check_camera() {
  const std::string camera = words(assembler_.header().camera);
  if (camera_.empty()) camera_ = camera;
  if (camera == camera_) return;
  throw Error(fmt::format("the camera is {}, but was {}; start palpate again for another camera",
                          camera, camera_));
}

void RemoteCamera::stamp(DepthFrame& frame) {
  const double now = clock_.now();
  const std::optional<double>& stamp = assembler_.header().stamp;
  frame.stamp = stamp ? stamps_.host(*stamp, now) : now;
}

void RemoteCamera::part() {
  client_ = {};
  assembler_ = {};
  stamps_ = {};
}

// Accepts one program at a time; true if one came in.
bool RemoteCamera::let_in() {
  for (bool came = false;;) {
    Client next(::accept4(socket_.handle(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!next.there()) {
      if (nothing_now(errno) || errno == ECONNABORTED) return came;
      throw Error(
          fmt::format("{}: no program can connect to '{}': {}", kWhat, path_, words(errno)));
    }
    if (client_.there()) {
      next.notify("another program is this camera; stop that one");
    } else {
      client_ = std::move(next);
      came = true;
    }
  }
}

// Until something comes, or for so long.
void RemoteCamera::wait(double seconds) const {
  std::array<pollfd, 2> looked{{{socket_.handle(), POLLIN, 0}, {client_.handle(), POLLIN, 0}}};
  const int milliseconds = static_cast<int>(std::ceil(1e3 * std::min(seconds, 60.0)));
  static_cast<void>(::poll(looked.data(), looked.size(), milliseconds));
}

}  // namespace

DriverInfo remote_driver() {
  return {.name = "remote",
          .description = "depth frames of any program: remote[:PATH] (docs/remote_camera.md)",
          .missing = {},
          .devices = {}};
}

std::unique_ptr<DepthCamera> open_remote(const std::string& path, const CameraOptions& options) {
  return std::make_unique<RemoteCamera>(path.empty() ? "remote" : "remote:" + path,
                                        path.empty() ? runtime_path(kWhat, "palpate-camera") : path,
                                        options.clock);
}

}  // namespace palpate::sensor
