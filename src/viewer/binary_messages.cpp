// Encodes states, clouds and surfaces for the page.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

#include "viewer/messages.hpp"
#include "viewer/scene_encoder.hpp"

namespace palpate::viewer {

namespace {

using Eigen::Vector3f;

constexpr std::uint8_t kStateKind = 1;
constexpr std::uint8_t kCloudKind = 2;
constexpr std::uint8_t kSurfaceKind = 3;
constexpr std::uint8_t kPastKind = 4;
constexpr std::uint8_t kToolKind = 5;
constexpr std::size_t kPastHeader = 16;
constexpr std::size_t kToolHeader = 24;
constexpr std::size_t kToolPart = 40;
constexpr std::size_t kStateHeader = 92;
constexpr std::size_t kCloudHeader = 40;
constexpr std::size_t kSurfaceHeader = 24;
constexpr std::size_t kQuaternion = 16;
constexpr std::uint16_t kColors = 1;
constexpr std::uint16_t kNormals = 2;
constexpr std::uint16_t kTrust = 4;
constexpr std::uint16_t kRadii = 8;
constexpr std::uint16_t kFaded = 16;
constexpr float kOneMetre = 160;  // a radius of a metre as a byte
constexpr float kOctave = 8;      // steps for twice a radius
constexpr float kCloudSteps = 65535;
constexpr float kSurfaceSteps = 32767;

// Puts numbers behind one another, little-endian whatever the machine.
class ByteWriter {
 public:
  explicit ByteWriter(std::size_t expected) { bytes_.reserve(expected); }

  template <std::unsigned_integral T>
  void put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes_.push_back(static_cast<char>(static_cast<unsigned char>(value >> (8 * i))));
    }
  }
  void put(std::int8_t value) { put(static_cast<std::uint8_t>(value)); }
  void put(std::int16_t value) { put(static_cast<std::uint16_t>(value)); }
  void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(const Eigen::Vector3f& v) {
    for (int i = 0; i < 3; ++i) put(v[i]);
  }
  void put(const Eigen::Quaternionf& q) {
    for (const float part : {q.x(), q.y(), q.z(), q.w()}) put(part);
  }

  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

std::int8_t rounded(float x) noexcept {
  return static_cast<std::int8_t>(std::lround(127 * x));
}

void put_positions(const CloudMessage& message, ByteWriter& bytes) {
  Vector3f lower = Vector3f::Zero();
  Vector3f upper = Vector3f::Zero();
  if (!message.positions.empty()) lower = upper = message.positions.front();
  for (const Vector3f& position : message.positions) {
    lower = lower.cwiseMin(position);
    upper = upper.cwiseMax(position);
  }
  const Vector3f extent = upper - lower;
  bytes.put(lower);
  bytes.put(extent);
  Vector3f scale = Vector3f::Zero();
  for (int i = 0; i < 3; ++i) scale[i] = extent[i] > 0 ? kCloudSteps / extent[i] : 0;
  for (const Vector3f& position : message.positions) {
    for (int i = 0; i < 3; ++i) {
      const float u = std::clamp((position[i] - lower[i]) * scale[i], 0.0F, kCloudSteps);
      bytes.put(static_cast<std::uint16_t>(std::lround(u)));
    }
  }
}

void put_tool(const ToolPart& tool, ByteWriter& bytes) {
  bytes.put(tool.orientation);
  bytes.put(tool.opening);
  bytes.put(tool.hand_opening);
  bytes.put(tool.torque);
  bytes.put(tool.grip);
}

}  // namespace

std::uint8_t logarithmic(float radius) noexcept {
  if (!(radius > 0)) return 0;
  return static_cast<std::uint8_t>(
      std::clamp(std::lround(kOneMetre + kOctave * std::log2(std::min(radius, 1e6F))), 0L, 255L));
}

std::array<std::int8_t, 2> octahedral(const Eigen::Vector3f& normal) noexcept {
  const float length = normal.lpNorm<1>();
  if (!(length > 0) || !std::isfinite(length)) return {0, 0};
  const Eigen::Vector3f p = normal / length;
  if (p.z() >= 0) return {rounded(p.x()), rounded(p.y())};
  return {rounded(std::copysign(1 - std::abs(p.y()), p.x())),
          rounded(std::copysign(1 - std::abs(p.x()), p.y()))};
}

std::string encode(const StateMessage& message) {
  assert(message.forces.size() <= std::numeric_limits<std::uint16_t>::max());
  const bool holds_tool = (message.flags & state_flag::kTool) != 0;
  ByteWriter bytes(kStateHeader + message.forces.size() * sizeof(Eigen::Vector3f) +
                   (message.orientation ? kQuaternion : 0) + (holds_tool ? kToolPart : 0));
  bytes.put(kStateKind);
  bytes.put(message.device);
  bytes.put(static_cast<std::uint16_t>(message.forces.size()));
  bytes.put(message.flags | (message.orientation ? state_flag::kOriented : 0));
  bytes.put(message.time);
  for (const auto& v : {message.hip, message.proxy, message.normal, message.force}) bytes.put(v);
  bytes.put(message.radius);
  bytes.put(message.rate);
  for (const float time : message.computing) bytes.put(time);
  for (const float time : message.lateness) bytes.put(time);
  bytes.put(message.interval);
  for (const Eigen::Vector3f& force : message.forces) bytes.put(force);
  if (message.orientation) bytes.put(*message.orientation);
  if (holds_tool) put_tool(message.tool, bytes);
  return bytes.take();
}

std::string encode(const CloudMessage& message) {
  const std::size_t n = message.positions.size();
  assert(message.colors.empty() || message.colors.size() == n);
  assert(message.normals.empty() || message.normals.size() == n);
  assert(message.trust.empty() || message.trust.size() == n);
  assert(message.radii.empty() || message.radii.size() == n);
  ByteWriter bytes(kCloudHeader + 6 * n + 3 * message.colors.size() + 2 * message.normals.size() +
                   message.trust.size() + message.radii.size());
  bytes.put(kCloudKind);
  bytes.put(message.source);
  bytes.put(static_cast<std::uint16_t>(
      (message.colors.empty() ? 0 : kColors) | (message.normals.empty() ? 0 : kNormals) |
      (message.trust.empty() ? 0 : kTrust) | (message.radii.empty() ? 0 : kRadii) |
      (message.faded ? kFaded : 0)));
  bytes.put(static_cast<std::uint32_t>(n));
  bytes.put(message.stamp);
  put_positions(message, bytes);
  for (const auto& color : message.colors) {
    for (const std::uint8_t part : color) bytes.put(part);
  }
  for (const Vector3f& normal : message.normals) {
    for (const std::int8_t part : octahedral(normal)) bytes.put(part);
  }
  for (const std::uint8_t trust : message.trust) bytes.put(trust);
  for (const float radius : message.radii) bytes.put(logarithmic(radius));
  return bytes.take();
}

std::string encode_surface(std::uint8_t device, const Eigen::Vector3f& center, const Mesh& mesh) {
  assert(mesh.vertices.size() <= std::numeric_limits<std::uint16_t>::max());
  float extent = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) extent = std::max(extent, v.cwiseAbs().maxCoeff());
  ByteWriter bytes(kSurfaceHeader + 6 * (mesh.vertices.size() + mesh.triangles.size()));
  bytes.put(kSurfaceKind);
  bytes.put(device);
  bytes.put(static_cast<std::uint16_t>(mesh.vertices.size()));
  bytes.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  bytes.put(center);
  bytes.put(extent);
  const float scale = extent > 0 ? kSurfaceSteps / extent : 0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    for (int i = 0; i < 3; ++i) {
      const float v = std::clamp(vertex[i] * scale, -kSurfaceSteps, kSurfaceSteps);
      bytes.put(static_cast<std::int16_t>(std::lround(v)));
    }
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint16_t corner : triangle) bytes.put(corner);
  }
  return bytes.take();
}

std::string encode_tool(std::uint8_t device, const Tool& tool) {
  const std::span samples = tool.samples();
  ByteWriter bytes(kToolHeader + 20 * samples.size() + 36 * tool.faces().size());
  bytes.put(kToolKind);
  bytes.put(device);
  bytes.put(std::uint16_t{0});
  bytes.put(static_cast<std::uint32_t>(samples.size()));
  bytes.put(static_cast<std::uint32_t>(tool.faces().size()));
  bytes.put(Vector3f(tool.axis().cast<float>()));
  for (const Tool::Point& sample : samples) {
    bytes.put(Vector3f(sample.position.cast<float>()));
    bytes.put(static_cast<float>(sample.radius));
    bytes.put(static_cast<float>(sample.side));
  }
  for (const Tool::Face& face : tool.faces()) {
    for (const Vector3f& corner : face) bytes.put(corner);
  }
  return bytes.take();
}

std::string encode_past(std::uint8_t device, std::span<const TimeLine::Force> forces) {
  const double time = forces.empty() ? 0 : forces.back().time;
  ByteWriter bytes(kPastHeader + forces.size() * 4 * sizeof(float));
  bytes.put(kPastKind);
  bytes.put(device);
  bytes.put(std::uint16_t{0});
  bytes.put(static_cast<std::uint32_t>(forces.size()));
  bytes.put(time);
  for (const TimeLine::Force& each : forces) {
    bytes.put(static_cast<float>(each.time - time));
    bytes.put(each.force);
  }
  return bytes.take();
}

}  // namespace palpate::viewer
