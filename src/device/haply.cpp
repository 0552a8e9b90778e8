// Haply's Inverse3 through the maker's service: a WebSocket to this machine.
#include <fmt/format.h>

#include <optional>
#include <utility>

#include "base/shared_library.hpp"
#include "device/drivers.hpp"
#include "device/haply_message.hpp"
#include "device/text_socket.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;

constexpr const char* kService = "ws://localhost:10001";
constexpr const char* kProfile = "inverse3";
constexpr const char* kInstall =
    "Install Haply's Inverse Service and start it (sudo systemctl enable --now "
    "haply-inverse-service)";
constexpr const char* kCheck = "Check its cable, its power and Haply's Inverse Service";
constexpr double kConnecting = 1;  // s to connect (judgement)
constexpr double kFirstFrame = 1;  // s for the service's first frame (judgement)
constexpr int kFirstFrames = 3;    // frames waited for at the start, at most (judgement)
constexpr double kQuiet = 0.02;    // s without a frame: no more are coming (judgement)
constexpr double kQuick = 5e-3;    // s for an answer; later the force goes (docs/devices.md)
// s for an answer; later the service is given up (docs/devices/haply.md)
constexpr double kPatience = 0.1;
constexpr double kFarewell = 0.05;  // s for it to take the last force (judgement)

TextSocket connect(const std::string& url) {
  try {
    return TextSocket(url, kConnecting);
  } catch (const Error& error) {
    throw Error(fmt::format("{}. {}", error.what(), kInstall));
  }
}

// The devices of a service. Its first frame may come unasked, and without any.
std::vector<HaplyDevice> greet(TextSocket& socket) {
  socket.send(haply_greeting(), kPatience);
  std::vector<HaplyDevice> devices;
  std::uint64_t seen = 0;
  for (int i = 0; i < kFirstFrames && devices.empty(); ++i) {
    if (!socket.wait(seen, kFirstFrame)) break;
    seen = socket.received();
    devices = parse_haply_frame(socket.newest());
  }
  if (seen == 0) throw Error("the service sends nothing");
  return devices;
}

// Drops frames that are still in transit: they would be mistaken for answers to later commands.
void let_pass(TextSocket& socket) {
  std::uint64_t seen = socket.received();
  for (int i = 0; i < kFirstFrames && socket.wait(seen, kQuiet); ++i) seen = socket.received();
}

std::string ids_of(const std::vector<HaplyDevice>& devices) {
  std::string ids;
  for (const HaplyDevice& each : devices) ids += (ids.empty() ? "" : ", ") + each.id;
  return ids.empty() ? "none" : ids;
}

std::optional<HaplyDevice> find(std::vector<HaplyDevice> devices, const std::string& id) {
  for (HaplyDevice& each : devices) {
    if (id.empty() || each.id == id) return std::move(each);
  }
  return std::nullopt;
}

class HaplyDriver final : public DeviceDriver {
 public:
  explicit HaplyDriver(const DeviceName& name)
      : id_(name.device), socket_(connect(name.option("url", kService))) {
    const std::vector<HaplyDevice> devices = query([this] { return greet(socket_); });
    const std::optional<HaplyDevice> found = find(devices, id_);
    if (!found) {
      fail(fmt::format("no such Inverse3 (connected: {}). {}", ids_of(devices), kCheck));
    }
    id_ = found->id;
    check(*found);
    info_ = info_of(device_profile(name.option("profile", kProfile)), fmt::format("haply:{}", id_));
    info_.has_orientation = found->gripped;
    query([this] { configure(); });
  }
  ~HaplyDriver() override {
    try {
      socket_.send(haply_command(id_, Vector3d::Zero()), kFarewell);
    } catch (const Error&) {  // it is gone already
    }
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceState exchange(const Vector3d& force) override {
    const std::optional<HaplyDevice> device = query([&] { return find(answer_to(force), id_); });
    if (!device) fail(fmt::format("it was disconnected. {}", kCheck));
    check(*device);
    if (!device->reading)
      fail(fmt::format("it reports no position or an impossible one. {}", kCheck));
    return *device->reading;
  }

 private:
  [[noreturn]] void fail(const std::string& words) const {
    throw Error(fmt::format("haply{}{}: {}", id_.empty() ? "" : ":", id_, words));
  }

  void check(const HaplyDevice& device) const {
    if (!device.calibrated.value_or(true))
      fail("it is not calibrated. Calibrate it in Haply's Hub");
    if (!device.powered.value_or(true)) fail("it has no power. Plug in its power supply");
  }

  // Runs `question`; an Error then states that the service is at fault.
  template <class Question>
  auto query(Question question) const -> decltype(question()) {
    try {
      return question();
    } catch (const Error& error) {
      fail(fmt::format("{}. {}", error.what(), kCheck));
    }
  }

  void configure() {
    socket_.send(haply_configuration(id_), kPatience);
    let_pass(socket_);
  }

  // A frame is the answer to a command; what came before it is old. A service that does not report
  // the hand's position in time gets no force.
  [[nodiscard]] std::vector<HaplyDevice> answer_to(const Vector3d& force) {
    socket_.poll();
    const std::uint64_t before = socket_.received();
    socket_.send(haply_command(id_, force), kPatience);
    if (!socket_.wait(before, kQuick)) {
      socket_.send(haply_command(id_, Vector3d::Zero()), kPatience);
      if (!socket_.wait(before, kPatience)) throw Error("the service stopped answering");
      (void)socket_.wait(before + 1, kPatience);  // the zero's: no later answer
    }
    socket_.poll();
    return parse_haply_frame(socket_.newest());
  }

  std::string id_;
  TextSocket socket_;
  DeviceInfo info_;
};

}  // namespace

DriverInfo list_haply() {
  DriverInfo driver{.name = "haply",
                    .description = "Haply Inverse3, through Haply's Inverse Service"};
  return listed(driver, [](DriverInfo& found) {
    TextSocket socket = connect(kService);
    for (const HaplyDevice& each : greet(socket)) {
      const bool ready = each.calibrated.value_or(true) && each.powered.value_or(true);
      found.devices.push_back(
          {"haply:" + each.id, ready ? "Inverse3" : "Inverse3, not calibrated or without power"});
    }
  });
}

std::unique_ptr<DeviceDriver> open_haply(const DeviceName& name, const Clock& /*clock*/) {
  check_options(name, {"url", "profile"});
  return std::make_unique<HaplyDriver>(name);
}

}  // namespace palpate::device
