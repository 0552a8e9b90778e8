#include "viewer/cloud_message.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "viewer/byte_writer.hpp"
#include "viewer/octahedral.hpp"

namespace palpate::viewer {
namespace {

using Eigen::Vector3f;

constexpr std::uint8_t kCloudKind = 2;
constexpr std::size_t kCloudHeader = 40;
constexpr std::uint16_t kColors = 1;
constexpr std::uint16_t kNormals = 2;
constexpr std::uint16_t kTrust = 4;
constexpr float kSteps = 65535;

void put_places(const CloudMessage& message, ByteWriter& bytes) {
  Vector3f lower = Vector3f::Zero();
  Vector3f upper = Vector3f::Zero();
  if (!message.places.empty()) lower = upper = message.places.front();
  for (const Vector3f& place : message.places) {
    lower = lower.cwiseMin(place);
    upper = upper.cwiseMax(place);
  }
  const Vector3f extent = upper - lower;
  bytes.put(lower);
  bytes.put(extent);
  Vector3f scale = Vector3f::Zero();
  for (int i = 0; i < 3; ++i) scale[i] = extent[i] > 0 ? kSteps / extent[i] : 0;
  for (const Vector3f& place : message.places) {
    for (int i = 0; i < 3; ++i) {
      const float u = std::clamp((place[i] - lower[i]) * scale[i], 0.0F, kSteps);
      bytes.put(static_cast<std::uint16_t>(std::lround(u)));
    }
  }
}

}  // namespace

std::string encode(const CloudMessage& message) {
  const std::size_t n = message.places.size();
  assert(message.colors.empty() || message.colors.size() == n);
  assert(message.normals.empty() || message.normals.size() == n);
  assert(message.trust.empty() || message.trust.size() == n);
  ByteWriter bytes(kCloudHeader + 6 * n + 3 * message.colors.size() + 2 * message.normals.size() +
                   message.trust.size());
  bytes.put(kCloudKind);
  bytes.put(message.source);
  bytes.put(static_cast<std::uint16_t>((message.colors.empty() ? 0 : kColors) |
                                       (message.normals.empty() ? 0 : kNormals) |
                                       (message.trust.empty() ? 0 : kTrust)));
  bytes.put(static_cast<std::uint32_t>(n));
  bytes.put(message.stamp);
  put_places(message, bytes);
  for (const auto& color : message.colors) {
    for (const std::uint8_t part : color) bytes.put(part);
  }
  for (const Vector3f& normal : message.normals) {
    for (const std::int8_t part : octahedral(normal)) bytes.put(part);
  }
  for (const std::uint8_t trust : message.trust) bytes.put(trust);
  return bytes.take();
}

}  // namespace palpate::viewer
