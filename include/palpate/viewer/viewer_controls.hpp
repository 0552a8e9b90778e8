#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "palpate/viewer/setting.hpp"

namespace palpate {

/// What a viewer's page may do to the program. All are called on the viewer's network thread, one
/// at a time, and should return within a millisecond or so. What they throw as Error is told to the
/// page and changes nothing. Those that are empty are refused with words, unless it says otherwise.
struct ViewerControls {
  /// What can be set, with present values.
  std::function<std::vector<Setting>()> settings = {};
  /// `value` is of the setting's kind and in its range already.
  std::function<void(const std::string& key, const SettingValue& value)> set = {};

  /// Names of several settings at once.
  std::vector<std::string> presets = {};
  std::function<void(const std::string& name)> preset = {};

  std::function<void(bool on)> pause = {};  ///< empty: Servo::pause of every servo
  std::function<void()> reset = {};         ///< empty: Servo::reset of every servo

  /// Begins or ends a log of steps. Returns the file's name.
  std::function<std::string(bool on)> record = {};

  /// Can a page move this device's hand? Empty: where `hand` is there, all.
  std::function<bool(std::size_t device)> takeable = {};
  /// Where a page's hand wants the tool to be (m, world), with buttons as bits.
  std::function<void(std::size_t device, const Eigen::Vector3d& position, std::uint32_t buttons)>
      hand = {};
  /// The page let go of the tool, or went away.
  std::function<void(std::size_t device)> release = {};
};

}  // namespace palpate
