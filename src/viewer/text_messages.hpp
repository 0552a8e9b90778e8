#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/device/device.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/viewer/setting.hpp"
#include "palpate/viewer/viewer_options.hpp"
#include "viewer/notice.hpp"

namespace palpate::viewer {

struct DeviceLabel {
  std::string name;
  bool takeable = false;
};

struct SourceLabel {
  std::string name;
  bool camera = false;
};

/// What a page is told once.
struct Welcome {
  std::string scene;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double radius = 0;
  std::vector<DeviceLabel> devices;
  std::vector<SourceLabel> sources;
  std::vector<Setting> settings;
  std::vector<std::string> presets;
  std::vector<Notice> notices;  ///< what is wrong already; messages of their own
};

/// How a device is doing; `reason`: why it is silent or has failed, and what to do.
struct DeviceReport {
  DeviceStatus status = DeviceStatus::ok;
  std::string reason;
};

/// How a source fares. What is not set is left out.
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
  std::optional<ViewerFrustum> frustum;
};

// JSON of docs/viewer_protocol.md. Texts that are no UTF-8 come out with replacement characters.
[[nodiscard]] std::string welcome_text(const Welcome& welcome);
[[nodiscard]] std::string settings_text(std::span<const Setting> settings);
[[nodiscard]] std::string devices_text(std::span<const DeviceReport> devices);
[[nodiscard]] std::string sources_text(std::span<const SourceReport> sources);
[[nodiscard]] std::string notice_text(const Notice& notice);
[[nodiscard]] std::string record_text(bool on, std::string_view file);
[[nodiscard]] std::string refused_text(std::string_view text);
[[nodiscard]] std::string lost_text(std::size_t device, std::string_view why);
[[nodiscard]] std::string pong_text(double id);

/// "running"; "still" for no stream.
[[nodiscard]] std::string_view in_words(const StreamState* stream);

}  // namespace palpate::viewer
