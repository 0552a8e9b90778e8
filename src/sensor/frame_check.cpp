#include "sensor/frame_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

namespace palpate::sensor {
namespace {

// A new size is believed when it has come so many times in a row: one frame may be damage.
constexpr int kLasts = 3;

bool is_camera(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  return camera.width > 0 && camera.height > 0 && std::isfinite(p.cx) && std::isfinite(p.cy) &&
         std::isfinite(p.fx) && std::isfinite(p.fy) && p.fx != 0 && p.fy != 0;
}

std::optional<Objection> check_form(const DepthFrame& frame) {
  if (frame.cloud) return {};
  const CameraModel& camera = frame.camera;
  if (!is_camera(camera)) {
    return Objection{
        &StreamState::Drops::garbage,
        fmt::format("a frame of {} x {} pixels and a focal "
                    "length of {} x {} pixels",
                    camera.width, camera.height, camera.pinhole.fx, camera.pinhole.fy)};
  }
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (frame.depth.size() != pixels || (!frame.colors.empty() && frame.colors.size() != pixels)) {
    return Objection{
        &StreamState::Drops::garbage,
        fmt::format("a frame of {} x {} pixels with {} depths and {} colours", camera.width,
                    camera.height, frame.depth.size(), frame.colors.size())};
  }
  if (frame.T_world_sensor && !frame.T_world_sensor->matrix().allFinite()) {
    return Objection{&StreamState::Drops::garbage, "a frame with a pose that is not finite"};
  }
  return {};
}

bool is_empty(std::span<const float> depth) {
  return std::ranges::none_of(depth, [](float z) { return std::isfinite(z) && z > 0; });
}

// A sum that any changed bit changes: multiply and add, over eight lanes so that a frame costs a
// fraction of a millisecond.
std::uint64_t sum_of(std::span<const float> depth) {
  constexpr std::size_t kLanes = 8;
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15ULL;
  std::array<std::uint64_t, kLanes> lanes{};
  const std::size_t whole = depth.size() / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      lanes[k] = lanes[k] * kOdd + std::bit_cast<std::uint32_t>(depth[i + k]) + 1;
    }
  }
  std::uint64_t sum = depth.size();
  for (std::size_t i = whole; i < depth.size(); ++i) {
    sum = sum * kOdd + std::bit_cast<std::uint32_t>(depth[i]) + 1;
  }
  for (const std::uint64_t lane : lanes) sum = (sum ^ (sum >> 29U)) * kOdd + lane;
  return sum;
}

}  // namespace

bool left_out(CameraStatus status) noexcept {
  return status == CameraStatus::damaged || status == CameraStatus::unposed;
}

Objection objection_to(CameraStatus status, const std::string& reason) {
  const bool unposed = status == CameraStatus::unposed;
  const std::string words = unposed ? "a frame without a pose" : "a damaged frame";
  return {unposed ? &StreamState::Drops::unposed : &StreamState::Drops::garbage,
          reason.empty() ? words : reason};
}

std::optional<Objection> FrameCheck::examine(const DepthFrame& frame, double latest) {
  if (auto objection = check_form(frame)) return objection;
  if (auto objection = check_stamp(frame.stamp, latest)) return objection;
  if (auto objection = check_size(frame)) return objection;
  if (auto objection = check_picture(frame)) return objection;
  stamp_ = frame.stamp;
  return {};
}

std::optional<Objection> FrameCheck::check_stamp(double stamp, double latest) const {
  if (!std::isfinite(stamp) || stamp > latest) {
    return Objection{&StreamState::Drops::late,
                     fmt::format("a frame taken at {} s, which is {}", stamp,
                                 stamp > latest ? "in the future: is the camera on another clock?"
                                                : "not a valid time")};
  }
  if (stamp_ && stamp <= *stamp_) {
    return Objection{
        &StreamState::Drops::late,
        fmt::format("a frame taken at {:.6f} s, not later than the previous one at {:.6f} s", stamp,
                    *stamp_)};
  }
  return {};
}

std::optional<Objection> FrameCheck::check_size(const DepthFrame& frame) {
  if (frame.cloud) return {};  // clouds have as many points as there happen to be
  const Size size{frame.camera.width, frame.camera.height};
  if (size_ == Size{}) size_ = size;
  if (size == size_) {
    candidate_seen_ = 0;
    return {};
  }
  candidate_seen_ = size == candidate_ ? candidate_seen_ + 1 : 1;
  candidate_ = size;
  if (candidate_seen_ < kLasts) {
    return Objection{&StreamState::Drops::resized,
                     fmt::format("a frame of {} x {} pixels after those of {} x {}", size.width,
                                 size.height, size_.width, size_.height)};
  }
  size_ = size;
  candidate_seen_ = 0;
  ++size_changes_;
  return {};
}

std::optional<Objection> FrameCheck::check_picture(const DepthFrame& frame) {
  if (frame.cloud) return {};
  if (is_empty(frame.depth)) {
    return Objection{&StreamState::Drops::empty,
                     "a frame without any depth: is the lens covered, or everything out of range?"};
  }
  if (allow_repeats_) return {};
  const std::uint64_t picture = sum_of(frame.depth);
  if (picture_ == picture) {
    return Objection{&StreamState::Drops::repeated, "a frame identical to the previous one"};
  }
  picture_ = picture;
  return {};
}

}  // namespace palpate::sensor
