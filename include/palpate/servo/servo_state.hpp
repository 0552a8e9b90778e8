#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "palpate/contact/contact.hpp"
#include "palpate/device/device.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/servo/guard.hpp"

namespace palpate {

/// What whoever paces a servo measured of a step, s. Not a number: not measured.
struct StepTiming {
  double lateness = std::numeric_limits<double>::quiet_NaN();   ///< after it was due
  double computing = std::numeric_limits<double>::quiet_NaN();  ///< of the thread, without others
};

/// All that a servo knows of its last step, for those who watch. World frame.
struct ServoState {
  std::uint64_t step = 0;                         ///< counts from 1; 0: there was none yet
  double time = 0;                                ///< s, on the clock that snapshots are stamped on
  double dt = 0;                                  ///< since the step before, s
  Eigen::Vector3d hip = Eigen::Vector3d::Zero();  ///< where the hand has the tool, m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< of the hand, m/s
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< of the tool
  double gripper = 0;                                               ///< its opening at the hand, m
  Contact contact;                                  ///< its force is the proxy's own
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< what the guard let through, N
  GuardState guard;
  FieldNote field_notes = FieldNote::none;
  DeviceStatus device = DeviceStatus::ok;
  std::uint32_t buttons = 0;
  std::size_t patch_points = 0;
  bool paused = false;
  bool clutched = false;  ///< the hand moves freely; the tool rests (ServoOptions::clutch_button)
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< from the hand to the tool, by the clutch, m
  StepTiming timing;
};

}  // namespace palpate
