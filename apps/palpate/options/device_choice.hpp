#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/options/device_stand.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

struct TouchOptions;

enum class DeviceKind {
  scripted,   ///< is where its way says, whatever the force
  simulated,  ///< is pulled along its way, and feels
  remote,     ///< another program's
  hardware,   ///< what a driver reaches
};

/// One `--device`: what is at one hand.
struct DeviceChoice {
  DeviceKind kind = DeviceKind::simulated;
  /// Of a remote one's socket, empty: default_remote_path(); of hardware what open_device() takes.
  std::string path = {};
  DeviceStand stand = {};

  /// Does it go where a trajectory or an exploration leads it?
  [[nodiscard]] bool is_led() const {
    return kind == DeviceKind::scripted || kind == DeviceKind::simulated;
  }
};

/// As many hands may touch at once.
inline constexpr std::size_t kMostHands = 4;

/// "scripted", "simulated", "remote", "remote:PATH" or the name of hardware (open_device()), with
/// options of its stand.
/// @throws UsageError when it is none of them, or an option is not for it.
[[nodiscard]] DeviceChoice parse_device(const std::string& text);

/// Adds `--device`, which may be repeated.
void add_device_option(CLI::App& command, std::vector<std::string>& devices,
                       std::string_view group);

/// The devices of a run, one a hand: those of `options` or, where they name none, what goes with a
/// trajectory or an exploration.
[[nodiscard]] std::vector<DeviceChoice> choose_devices(const TouchOptions& options);

/// Can they be there in real time alone? Several hands, another program's and those that hold
/// hardware are.
[[nodiscard]] bool need_real_time(const std::vector<DeviceChoice>& devices);

/// @throws UsageError when such devices cannot touch together, or not as `options` want it.
void check_devices(const TouchOptions& options);

}  // namespace palpate::app
