#pragma once

// The messages between program and page: docs/viewer_protocol.md describes each byte.

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "palpate/device/device.hpp"
#include "palpate/tool/tool.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::viewer {

using Setting = ViewerControls::Setting;
using ViewedStream = ViewerOptions::Stream;
using TimeLine = ViewerControls::TimeLine;

struct Mesh;  // local_surface.hpp

// Messages from a page. JSON.

struct Hello {
  std::string token;
  std::size_t points = 0;
};
struct Hand {
  std::size_t device = 0;
  TargetSource::Target target;              ///< position: m, relative to the origin; finite
  std::optional<Eigen::Vector3d> eye = {};  ///< likewise; unset: the target is followed at once
};
struct Release {
  std::size_t device = 0;
};
struct Set {
  std::string key;
  Setting::Value value;
};
struct Preset {
  std::string name;
};
struct Pause {
  bool on = false;
};
struct Reset {
  std::optional<std::size_t> device;  ///< unset: all
};
struct Record {
  bool on = false;
};
struct Seek {
  double time = 0;  ///< s
};
struct Play {
  bool on = false;
  double speed = 1;
};
struct Points {
  std::size_t points = 0;
};
struct Ping {
  double id = 0;
};

/// Reason, in words, why a message cannot be read.
struct Unreadable {
  std::string text;
};

using ClientMessage = std::variant<Unreadable, Hello, Hand, Release, Set, Preset, Pause, Reset,
                                   Record, Seek, Play, Points, Ping>;

constexpr std::size_t kMostPoints = 10'000'000;  ///< that a page may request
constexpr std::size_t kLongestWord = 256;        ///< bytes of a text
constexpr double kFarthestHand = 1e6;            ///< m from the origin

/// Never throws, whatever `text` is; takes memory in proportion to it.
[[nodiscard]] ClientMessage read_message(std::string_view text);

// Messages to a page. JSON, read at a human pace.

/// Something that a person should know now.
struct Notice {
  Viewer::NoticeLevel level = Viewer::NoticeLevel::info;
  std::string text;
  std::optional<double> share = {};  ///< of work that takes a while, 0-1: the notice stays until 1
  bool over = false;                 ///< it holds no more, and is taken back

  bool operator==(const Notice&) const = default;
};

struct DeviceLabel {
  std::string name;
  bool takeable = false;
  double scale = 1;                       ///< world metres of a metre that the hand moves
  std::shared_ptr<const Tool> tool = {};  ///< that turns; null: a point
};

struct SourceLabel {
  std::string name;
  bool camera = false;
};

/// First message to a page, sent once.
struct Welcome {
  std::string run;  ///< another at each start of a viewer
  std::string scene;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::optional<Eigen::Vector3d> eye;
  double radius = 0;
  std::vector<DeviceLabel> devices;
  std::vector<SourceLabel> sources;
  std::vector<Setting> settings;
  std::vector<std::string> presets;
  std::size_t opens = 0;            ///< bytes of a file that a page may send; 0: it may send none
  std::optional<double> time_line;  ///< its length, s; unset: a run is shown
  std::vector<Notice> notices;      ///< what is wrong already; messages of their own
};

/// State of a device; `reason`: why it is silent or has failed, and what to do.
struct DeviceReport {
  DeviceState::Status status = DeviceState::Status::ok;
  std::string reason;
};

/// State of a source. Unset members are left out.
struct SourceReport {
  std::string name;
  std::string_view phase;
  double rate = 0;
  std::size_t points = 0;
  double latency = 0;
  std::optional<double> age;
  std::uint64_t dropped = 0;
  std::optional<double> disagreement;
  std::optional<Eigen::Isometry3d> pose;  ///< relative to the origin
  std::optional<ViewedStream::Frustum> frustum;
};

// Texts that are no UTF-8 come out with replacement characters.
[[nodiscard]] std::string welcome_text(const Welcome& welcome);
[[nodiscard]] std::string settings_text(std::span<const Setting> settings);
[[nodiscard]] std::string devices_text(std::span<const DeviceReport> devices);
[[nodiscard]] std::string sources_text(std::span<const SourceReport> sources,
                                       const std::string& robot = {});
[[nodiscard]] std::string notice_text(const Notice& notice);
[[nodiscard]] std::string record_text(bool on, std::string_view file);
[[nodiscard]] std::string moment_text(const TimeLine::Moment& moment);
[[nodiscard]] std::string envelope_text(std::span<const float> forces);
[[nodiscard]] std::string refused_text(std::string_view text);
[[nodiscard]] std::string lost_text(std::size_t device, std::string_view why);
[[nodiscard]] std::string pong_text(double id);

// Messages sent many times a second. Binary.

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
constexpr std::uint32_t kBehind = 16384;
constexpr std::uint32_t kNotLoaded = 32768;
constexpr std::uint32_t kTool = 65536;     ///< a tool that turns follows
constexpr std::uint32_t kInside = 131072;  ///< it is inside of a surface, and touches nothing
}  // namespace state_flag

/// A tool that turns: its proxy is StateMessage::proxy, turned and opened so.
struct ToolPart {
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  float opening = 0;                                 ///< m
  float hand_opening = 0;                            ///< m, that the hand asks for
  Eigen::Vector3f torque = Eigen::Vector3f::Zero();  ///< N m, about the handle
  float grip = 0;                                    ///< N
};

/// Message 1. Positions relative to the origin, m.
struct StateMessage {
  std::uint8_t device = 0;
  std::uint32_t flags = 0;  ///< of state_flag
  double time = 0;
  Eigen::Vector3f hip = Eigen::Vector3f::Zero();
  Eigen::Vector3f proxy = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Eigen::Vector3f force = Eigen::Vector3f::Zero();  ///< N
  float radius = 0;                                 ///< R; 0: unknown
  float rate = 0;                                   ///< steps a second
  std::array<float, 2> computing{};                 ///< p50 and p99, s
  std::array<float, 2> lateness{};                  ///< p50 and p99, s
  float interval = 0;                               ///< between samples on average, s
  std::vector<Eigen::Vector3f> forces;              ///< N, oldest first; at most 65535
  std::optional<Eigen::Quaternionf> orientation{};  ///< of the hand, where it is reported
  ToolPart tool{};                                  ///< with kTool
};

[[nodiscard]] std::string encode(const StateMessage& message);

/// Message 2. Positions relative to the origin, m. Optional columns are empty or as long
/// as `positions`.
struct CloudMessage {
  std::uint8_t source = 0;
  double stamp = 0;  ///< s
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::array<std::uint8_t, 3>> colors = {};
  std::vector<Eigen::Vector3f> normals = {};
  std::vector<std::uint8_t> trust = {};  ///< SurfacePoints::confidences, 255 for 1
  bool faded = false;  ///< nothing has confirmed it for so long that it cannot be felt any more
  std::vector<float> radii = {};  ///< R, m; of a thinned cloud so much larger that it covers
};

[[nodiscard]] std::string encode(const CloudMessage& message);

/// Message 3: `mesh` around `center` (m, relative to the origin). At most 65535 vertices.
[[nodiscard]] std::string encode_surface(std::uint8_t device, const Eigen::Vector3f& center,
                                         const Mesh& mesh);

/// Message 4: the forces before the moment that was sought last.
[[nodiscard]] std::string encode_past(std::uint8_t device, std::span<const TimeLine::Force> forces);

/// Message 5: what a device holds in the place of a point, and what it looks like.
[[nodiscard]] std::string encode_tool(std::uint8_t device, const Tool& tool);

/// A radius (m) in a byte: eighths of octaves, 160 for 1 m; from 1 um to 3.7 km, to 4.4 %.
[[nodiscard]] std::uint8_t logarithmic(float radius) noexcept;

/// A unit normal in two bytes; what has no direction becomes +z.
[[nodiscard]] std::array<std::int8_t, 2> octahedral(const Eigen::Vector3f& normal) noexcept;

}  // namespace palpate::viewer
