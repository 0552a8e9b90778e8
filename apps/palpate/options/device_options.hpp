// Options that may differ from hand to hand.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/options/source_options.hpp"

namespace palpate::app {

class OptionTable;

enum class DeviceKind {
  scripted,   ///< is where its trajectory leads, whatever the force
  simulated,  ///< is pulled along its trajectory, and feels
  remote,     ///< another program's
  hardware,   ///< what a driver reaches
};

/// Where a device is placed in the scene: `--device NAME,KEY=VALUE...`.
struct PlacementOptions {
  std::optional<double> scale = {};                  ///< m in the world for one of the hand's
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of its origin, m in the world, its axes
  std::string frame = {};              ///< source whose camera its axes follow; empty: the world's
  std::optional<int> clutch = {};      ///< button of the clutch
  std::vector<std::string> keys = {};  ///< that were given
};

/// One `--device`: what is at one hand.
struct DevicePlan {
  DeviceKind kind = DeviceKind::simulated;
  /// Socket of a remote device (empty: default_remote_path()), or what open_device() takes.
  std::string path = {};
  std::string profile = {};  ///< device_profile() of a remote one; empty: none
  PlacementOptions placement = {};

  /// Does it go where a trajectory or an exploration leads it?
  [[nodiscard]] bool follows_trajectory() const {
    return kind == DeviceKind::scripted || kind == DeviceKind::simulated;
  }
};

/// "scripted", "simulated", "remote", "remote:PATH" or the name of hardware (open_device()), with
/// options of its placement, and of a remote one its profile.
/// @throws UsageError when it is none of them, or an option is not for it.
[[nodiscard]] DevicePlan parse_device(const std::string& text);

/// Registers `--device`, which may be repeated.
void add_device_option(OptionTable& table, std::vector<DevicePlan>& devices);

/// Can they be there in real time alone? Several hands, another program's and those that hold
/// hardware are.
[[nodiscard]] bool need_real_time(const std::vector<DevicePlan>& devices);

/// @throws UsageError when such devices cannot be there together: they are too many, or two are
/// one.
void check_devices(const std::vector<DevicePlan>& devices);

/// The source that `frame` means: "camera" is the one camera that there is.
/// @throws UsageError when there is none, it has no camera, or there are several.
[[nodiscard]] std::string camera_named(const std::string& frame,
                                       const std::vector<SourcePlan>& sources);

}  // namespace palpate::app
