#pragma once

#include <Eigen/Core>
#include <string_view>

#include "palpate/device/device.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/servo/shaking.hpp"

namespace palpate {

struct WallTrialOptions {
  double softest = 100;      ///< stiffness of the first wall, N/m; > 0
  double stiffest = 5000;    ///< the last one that is tried, N/m; no more than the maker allows
  double factor = 1.15;      ///< from a wall to the next; > 1
  double damping = 0;        ///< B of the walls, N s/m
  double hold = 1;           ///< s that a wall is pressed without shaking
  double patience = 30;      ///< s without progress after which the trial ends
  double maximum_force = 2;  ///< N, lowered to what the device holds
  double fastest = 0.5;      ///< m/s; a device that moves faster ends the trial
};

/// What the hand is to do, or why the trial is over.
enum class WallTrialPhase {
  rest,         ///< hold the device still: the wall is put under it; after a silence, again
  press,        ///< press down on the wall
  lift,         ///< lift it off the wall, which then becomes stiffer
  shook,        ///< over: a wall made the device shake
  held,         ///< over: the stiffest wall stood still
  gave_up,      ///< over: nobody did what was asked
  too_fast,     ///< over: the device moved faster than any hand that presses
  device_lost,  ///< over: the device failed, or fell silent for good
};

struct WallTrialState {
  WallTrialPhase phase = WallTrialPhase::rest;
  double wall = 0;       ///< stiffness now, N/m
  double stable = 0;     ///< of the stiffest wall that was pressed without shaking, N/m; 0: none
  double amplitude = 0;  ///< of the shaking now (Shaking), m
  double pressed = 0;    ///< s for which this wall has been pressed
};

/// How stiff may a wall be on this device with this hand? Walls under a hand, each stiffer than the
/// one before, until one makes the device shake; the force goes away with that. The guard's links
/// but those that would hide shaking (stiffness limit, passivity) stand between wall and hand.
///
/// Pure: a step's force out of a step's state, no clock, no device. Real-time.
class WallTrial {
 public:
  /// A swing, m, that counts as shaking when it lasts.
  static constexpr double kShaking = 0.3e-3;

  /// @throws Error when an option is out of its range or the device renders no force.
  explicit WallTrial(const DeviceInfo& device, const WallTrialOptions& options = {});

  /// The force for the hand, N, device frame, z up. `now`: s; it never goes back.
  [[nodiscard]] Eigen::Vector3d step(const DeviceState& hand, double now) noexcept;

  [[nodiscard]] const WallTrialState& state() const noexcept { return state_; }
  [[nodiscard]] bool is_over() const noexcept { return state_.phase >= WallTrialPhase::shook; }

 private:
  void advance(const DeviceState& hand, double now, double dt) noexcept;
  void press(double dt, double now) noexcept;
  void go_to(WallTrialPhase phase, double now) noexcept;
  [[nodiscard]] GuardInput felt(const DeviceState& hand, double dt) const noexcept;

  WallTrialOptions options_;
  Guard guard_;
  Shaking shaking_;
  WallTrialState state_;
  double top_ = 0;     // z of the wall, m
  double since_ = 0;   // when the phase began, s
  double time_ = 0;    // of the step before, s
  double still_ = 0;   // s for which the hand has rested
  double shaken_ = 0;  // s for which the wall has shaken
  double force_ = 0;   // of the step before, N
  bool started_ = false;
};

/// What the hand is to do, or why it is over.
[[nodiscard]] std::string_view in_words(WallTrialPhase phase) noexcept;

}  // namespace palpate
