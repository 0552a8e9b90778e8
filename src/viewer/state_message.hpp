#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpate::viewer {

namespace state_flag {
constexpr std::uint32_t kTouching = 1;
constexpr std::uint32_t kPaused = 2;
constexpr std::uint32_t kTaken = 4;
constexpr std::uint32_t kClamped = 8;
constexpr std::uint32_t kSlewed = 16;
constexpr std::uint32_t kWatchdog = 32;
constexpr std::uint32_t kFault = 64;
constexpr std::uint32_t kThinned = 128;
constexpr std::uint32_t kSofter = 256;
constexpr std::uint32_t kBraked = 512;
constexpr std::uint32_t kStarting = 1024;
constexpr std::uint32_t kSoftened = 2048;
constexpr std::uint32_t kClutched = 4096;
constexpr std::uint32_t kOriented = 8192;  ///< set by encode(): an orientation follows
}  // namespace state_flag

/// Message 1 of docs/viewer_protocol.md. Places relative to the origin, m.
struct StateMessage {
  std::uint8_t device = 0;
  std::uint32_t flags = 0;  ///< of state_flag
  double time = 0;
  Eigen::Vector3f hip = Eigen::Vector3f::Zero();
  Eigen::Vector3f proxy = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Eigen::Vector3f force = Eigen::Vector3f::Zero();  ///< N
  float radius = 0;                                 ///< R; 0: not known
  float rate = 0;                                   ///< steps a second
  std::array<float, 2> computing{};                 ///< p50 and p99, s
  std::array<float, 2> lateness{};                  ///< p50 and p99, s
  float interval = 0;                               ///< between samples on average, s
  std::vector<Eigen::Vector3f> forces;              ///< N, oldest first; at most 65535
  std::optional<Eigen::Quaternionf> orientation{};  ///< of the tool, where it is known
};

[[nodiscard]] std::string encode(const StateMessage& message);

}  // namespace palpate::viewer
