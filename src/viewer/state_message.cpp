#include "viewer/state_message.hpp"

#include <cassert>
#include <limits>

#include "viewer/byte_writer.hpp"

namespace palpate::viewer {
namespace {

constexpr std::uint8_t kStateKind = 1;
constexpr std::size_t kStateHeader = 92;
constexpr std::size_t kQuaternion = 16;

}  // namespace

std::string encode(const StateMessage& message) {
  assert(message.forces.size() <= std::numeric_limits<std::uint16_t>::max());
  ByteWriter bytes(kStateHeader + message.forces.size() * sizeof(Eigen::Vector3f) +
                   (message.orientation ? kQuaternion : 0));
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
  if (const auto& q = message.orientation) {
    for (const float part : {q->x(), q->y(), q->z(), q->w()}) bytes.put(part);
  }
  return bytes.take();
}

}  // namespace palpate::viewer
