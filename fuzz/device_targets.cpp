// Gives bytes to what reads the messages of devices and remote cameras, and checks its promises.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "device/haply_message.hpp"
#include "device/remote_protocol.hpp"
#include "palpate/base/error.hpp"
#include "sensor/remote_frame.hpp"
#include "targets.hpp"

namespace palpate::fuzz {
namespace {

void check_remote_state(std::span<const std::byte> bytes) {
  const auto [flaw, packet] = parse_state(bytes);
  if (flaw != PacketFlaw::none) return;
  expect(std::abs(packet.stamp) <= StatePacket::kLargestStamp, "a stamp");
  expect(packet.position.cwiseAbs().maxCoeff() <= StatePacket::kLargestPosition, "a place");
  expect(packet.velocity.cwiseAbs().maxCoeff() <= StatePacket::kLargestVelocity, "a velocity");
  expect(std::abs(packet.turns.orientation.norm() - 1) < 1e-9, "a rotation");
  expect(packet.turns.velocity.cwiseAbs().maxCoeff() <= StatePacket::kLargestVelocity, "a turn");
  expect(std::abs(packet.turns.opening) <= StatePacket::kLargestPosition, "an opening");
  const PacketBytes again = encode(packet);
  expect(parse_state(again).flaw == PacketFlaw::none, "a packet that is lost in writing");
  const bool exact = packet.has_velocity && packet.version == RemoteVersion::kForces;
  const std::span<const std::byte> written = again;
  expect(!exact || std::ranges::equal(written, bytes), "bytes that were lost");
}

void check_remote_frame(const DepthFrame& frame) {
  const CameraModel& camera = frame.camera;
  const auto pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  expect(camera.width >= 6 && camera.height >= 6, "a frame without pixels");
  expect(frame.depth.size() == pixels, "depths that are not one a pixel");
  expect(camera.pinhole.fx > 0 && camera.pinhole.fy > 0, "a focal length");
  expect(std::isfinite(camera.pinhole.cx) && std::isfinite(camera.distortion.k3), "a lens");
  for (const float z : frame.depth) expect(std::isfinite(z) && z >= 0, "a depth");
  expect(!frame.T_world_sensor || frame.T_world_sensor->matrix().allFinite(), "a pose");
}

// Frames of the bytes that come in pieces of `piece`, and whether an error ended them.
std::pair<std::vector<DepthFrame>, bool> remote_frames(std::span<const std::byte> bytes,
                                                       std::size_t piece) {
  sensor::FrameAssembler assembler;
  std::vector<DepthFrame> frames;
  try {
    while (!bytes.empty()) {
      const std::span<std::byte> room = assembler.room();
      expect(!room.empty() && room.size() < std::size_t{1} << 27U, "room");
      const std::size_t count = std::min({piece, room.size(), bytes.size()});
      std::ranges::copy(bytes.first(count), room.begin());
      bytes = bytes.subspan(count);
      if (assembler.add(count)) assembler.take(frames.emplace_back());
    }
  } catch (const Error&) {
    return {std::move(frames), true};
  }
  return {std::move(frames), false};
}

void check_remote_frames(std::span<const std::byte> bytes) {
  const auto [whole, failed] = remote_frames(bytes, bytes.size());
  const auto [cut, cut_failed] = remote_frames(bytes, 37);
  expect(failed == cut_failed && whole.size() == cut.size(), "frames that depend on the pieces");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    check_remote_frame(whole[i]);
    expect(whole[i].depth == cut[i].depth, "depths that depend on the pieces");
  }
}

void check_haply_frame(std::string_view text) {
  for (const device::HaplyDevice& each : device::parse_haply_frame(text)) {
    if (!each.reading) continue;
    const DeviceState& told = *each.reading;
    expect(told.position.allFinite() && told.velocity.allFinite(), "a number that is none");
    expect(told.position.cwiseAbs().maxCoeff() <= device::kFarthestHaply, "a place");
    expect(told.velocity.cwiseAbs().maxCoeff() <= device::kFastestHaply, "a velocity");
    expect(std::abs(told.orientation.norm() - 1) < 1e-9, "a rotation");
    expect(told.buttons < 8, "a button");
  }
}

}  // namespace

bool run_device_target(std::string_view name, std::span<const std::byte> bytes) {
  if (name == "remote_state") {
    check_remote_state(bytes);
  } else if (name == "remote_frame") {
    check_remote_frames(bytes);
  } else if (name == "haply_frame") {
    check_haply_frame({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } else {
    return false;
  }
  return true;
}

}  // namespace palpate::fuzz
