// The remote device: states come and forces go in datagrams.
#include "palpate/device/remote.hpp"

#include <fmt/format.h>

#include <optional>
#include <system_error>

#include "base/bound_socket.hpp"
#include "base/latest.hpp"
#include "base/requirement.hpp"
#include "device/datagram_socket.hpp"
#include "device/drivers.hpp"
#include "device/remote_protocol.hpp"
#include "geometry/wrench.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// Bytes: one more than a valid packet has, so that longer ones are recognised (derived).
constexpr std::size_t kBuffer = kLargestPacket + 1;

RemoteDeviceOptions checked(RemoteDeviceOptions o) {
  const Requirement require{"remote device"};
  require.positive("maximum_force", o.maximum_force, "give a positive force in newtons");
  require.not_negative("maximum_stiffness", o.maximum_stiffness, "give 0 or more N/m");
  require.not_negative("maximum_torque", o.maximum_torque, "give 0 or more N m");
  require.not_negative("maximum_grip", o.maximum_grip, "give 0 or more newtons");
  require.not_negative("angular_damping", o.angular_damping, "give 0 or more N m s/rad");
  require.not_negative("damping", o.damping, "give 0 or more N s/m");
  require.not_negative("mass", o.mass, "give 0 or more kg");
  require.not_negative("delay", o.delay.value_or(0), "give 0 or more seconds");
  require.not_negative("workspace_radius", o.workspace_radius, "give 0 or more metres");
  require.positive("rate", o.rate, "give a positive number of steps per second");
  require.positive("client_timeout", o.client_timeout, "give a positive time in seconds");
  require.positive("fade", o.fade, "give a positive time in seconds");
  require.positive("soft_start", o.soft_start, "give a positive time in seconds");
  if (o.path.empty()) o.path = default_remote_path();
  return o;
}

DeviceInfo info_of(const RemoteDeviceOptions& options) {
  DeviceInfo info;
  info.name = "remote";
  info.maximum_force = options.maximum_force;
  info.maximum_stiffness = options.maximum_stiffness;
  info.maximum_torque = options.maximum_torque;
  info.maximum_grip = options.maximum_grip;
  info.angular_damping = options.angular_damping;
  info.damping = options.damping;
  info.mass = options.mass;
  info.delay = options.delay;
  info.has_orientation = info.has_gripper = options.turns;
  info.rate = options.rate;
  info.workspace_radius = options.workspace_radius;
  return info;
}

}  // namespace

RemoteDeviceOptions remote_options(const DeviceProfile& profile) {
  RemoteDeviceOptions options;
  options.maximum_force = profile.maximum_force.value_or(options.maximum_force);
  options.maximum_torque = profile.maximum_torque.value_or(options.maximum_torque);
  options.maximum_grip = profile.maximum_grip.value_or(options.maximum_grip);
  device::take_motion(profile, options);
  return options;
}

std::string default_remote_path() {
  return runtime_path("remote device", "palpate-device");
}

struct RemoteDevice::Inside {
  // State shown to other threads.
  struct Shown {
    RemoteDevice::Counts counts;
    PacketFlaw refused = PacketFlaw::none;  // the newest one
    DeviceState::Status status = DeviceState::Status::silent;
    int error = 0;  // errno of a broken socket; 0: a force that was not finite, where it failed
  };

  Inside(const Clock& the_clock, const RemoteDeviceOptions& the_options)
      : clock(the_clock),
        options(checked(the_options)),
        info(info_of(options)),
        socket(options.path),
        protocol(options) {}

  void receive(double now) noexcept;
  void send(const std::optional<ForcePacket>& packet) noexcept;
  void fail(int error) noexcept;

  const Clock& clock;
  RemoteDeviceOptions options;
  DeviceInfo info;
  DatagramSocket socket;
  RemoteProtocol protocol;
  DeviceState state{.status = DeviceState::Status::silent};
  Shown shown;
  Latest<Shown> for_others;
};

void RemoteDevice::Inside::receive(double now) noexcept {
  std::array<std::byte, kBuffer> bytes{};
  for (int i = 0; i < kMostPackets; ++i) {
    const Reception reception = socket.receive(bytes);
    if (reception.error != 0) return fail(reception.error);
    if (!reception.any) return;
    RemoteDevice::Counts& counts = shown.counts;
    ++counts.received;
    const auto used = std::span<const std::byte>(bytes).first(reception.size);
    const PacketFlaw flaw = protocol.receive(used, reception.from, now);
    if (flaw == PacketFlaw::none) {
      ++counts.taken;
    } else {
      shown.refused = flaw;
    }
  }
}

void RemoteDevice::Inside::send(const std::optional<ForcePacket>& packet) noexcept {
  if (packet && !socket.send(encode(*packet), protocol.client())) ++shown.counts.unsent;
}

void RemoteDevice::Inside::fail(int error) noexcept {
  send(protocol.farewell());
  state.status = DeviceState::Status::failed;
  shown.error = error;
  shown.status = state.status;
  for_others.set(shown);
}

RemoteDevice::RemoteDevice(const Clock& clock, const RemoteDeviceOptions& options)
    : inside_(std::make_unique<Inside>(clock, options)) {}

RemoteDevice::~RemoteDevice() {
  if (inside_->state.status != DeviceState::Status::failed)
    inside_->send(inside_->protocol.farewell());
}

const DeviceInfo& RemoteDevice::info() const noexcept {
  return inside_->info;
}

DeviceState RemoteDevice::read() noexcept {
  Inside& in = *inside_;
  if (in.state.status == DeviceState::Status::failed) return in.state;
  const double now = in.clock.now();
  in.receive(now);
  if (in.state.status == DeviceState::Status::failed) return in.state;
  in.state = in.protocol.state(now);
  in.shown.status = in.state.status;
  in.for_others.set(in.shown);
  return in.state;
}

void RemoteDevice::write_wrench(const Wrench& wrench) noexcept {
  Inside& in = *inside_;
  if (in.state.status == DeviceState::Status::failed) return;
  if (!is_finite(wrench)) return in.fail(0);
  in.send(in.protocol.answer(wrench));
}

std::string RemoteDevice::reason() const {
  const Inside::Shown shown = inside_->for_others.get();
  if (shown.status == DeviceState::Status::ok) return {};
  if (shown.status == DeviceState::Status::failed) {
    if (shown.error != 0) {
      return fmt::format("receiving on '{}' failed: {}; open the device again", path(),
                         std::system_category().message(shown.error));
    }
    return "a written force was not finite; find the error in the code that computed it";
  }
  std::string words = fmt::format("no client is sending to '{}'; start one", path());
  if (shown.refused != PacketFlaw::none) {
    words += fmt::format("; a packet was rejected: {}", explain(shown.refused));
  }
  return words;
}

const std::string& RemoteDevice::path() const noexcept {
  return inside_->options.path;
}

RemoteDevice::Counts RemoteDevice::counts() const noexcept {
  return inside_->for_others.get().counts;
}

}  // namespace palpate
