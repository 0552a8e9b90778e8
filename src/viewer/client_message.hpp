#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "palpate/viewer/setting.hpp"

namespace palpate::viewer {

// What a page says (docs/viewer_protocol.md).

struct Hello {
  std::string token;
  std::size_t points = 0;
};
struct Hand {
  std::size_t device = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, relative to the origin; finite
  std::uint32_t buttons = 0;
};
struct Release {
  std::size_t device = 0;
};
struct Set {
  std::string key;
  SettingValue value;
};
struct Preset {
  std::string name;
};
struct Pause {
  bool on = false;
};
struct Reset {};
struct Record {
  bool on = false;
};
struct Points {
  std::size_t points = 0;
};
struct Ping {
  double id = 0;
};

/// What cannot be read, and why, in words.
struct Unreadable {
  std::string text;
};

using ClientMessage =
    std::variant<Unreadable, Hello, Hand, Release, Set, Preset, Pause, Reset, Record, Points, Ping>;

constexpr std::size_t kMostPoints = 10'000'000;  ///< that a page may ask for
constexpr std::size_t kLongestWord = 256;        ///< bytes of a text
constexpr double kFarthestHand = 1e6;            ///< m from the origin

/// Never throws, whatever `text` is; takes memory in proportion to it.
[[nodiscard]] ClientMessage read_message(std::string_view text);

}  // namespace palpate::viewer
