#include "viewer/surface_message.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "viewer/byte_writer.hpp"

namespace palpate::viewer {
namespace {

constexpr std::uint8_t kSurfaceKind = 3;
constexpr std::size_t kSurfaceHeader = 24;
constexpr float kSurfaceSteps = 32767;

}  // namespace

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

}  // namespace palpate::viewer
