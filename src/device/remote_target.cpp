// Hands commands to a tool from the thread that sends them to the one that steps the tool's device.
#include <algorithm>
#include <cmath>

#include "base/latest.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

// A unit quaternion's length is off by no more than the rounding of texts of seven digits.
constexpr double kUnit = 1e-6;

bool is_valid(const TargetSource::Target& target) noexcept {
  return target.position.allFinite() && target.maximum_force > 0 && std::isfinite(target.opening) &&
         std::abs(target.orientation.norm() - 1) < kUnit;
}

bool is_valid(const Way& way) noexcept {
  if (way.size == 0 || way.size > Way::kMost || !(way.speed > 0)) return false;
  return std::all_of(way.corners.begin(), way.corners.begin() + way.size,
                     [](const Eigen::Vector3d& corner) { return corner.allFinite(); });
}

}  // namespace

struct RemoteTarget::Inside {
  Command newest;  // of the sender
  Latest<Command> shared;
};

RemoteTarget::RemoteTarget() : inside_(std::make_unique<Inside>()) {}

RemoteTarget::~RemoteTarget() = default;

bool RemoteTarget::move(const TargetSource::Target& target, double stamp) noexcept {
  if (!is_valid(target) || !std::isfinite(stamp)) return false;
  Command& newest = inside_->newest;
  newest = {target, stamp, true, newest.moves + 1, {}, newest.ways};
  inside_->shared.set(newest);
  return true;
}

bool RemoteTarget::fly(const TargetSource::Target& target, const Way& way, bool begins,
                       double stamp) noexcept {
  if (!is_valid(target) || !is_valid(way) || !std::isfinite(stamp)) return false;
  Command& newest = inside_->newest;
  const bool first = begins || newest.way.size != way.size;
  newest = {target, stamp, true, newest.moves + 1, way, newest.ways + (first ? 1 : 0)};
  newest.target.position = way.corners[way.size - 1];
  inside_->shared.set(newest);
  return true;
}

void RemoteTarget::keep_alive() noexcept {
  if (inside_->newest.held) inside_->shared.set(inside_->newest);
}

void RemoteTarget::release() noexcept {
  if (!inside_->newest.held) return;
  inside_->newest.held = false;
  inside_->shared.set(inside_->newest);
}

std::optional<RemoteTarget::Command> RemoteTarget::command() const noexcept {
  return inside_->shared.look();
}

std::uint64_t RemoteTarget::generation() const noexcept {
  return inside_->shared.generation();
}

}  // namespace palpate
