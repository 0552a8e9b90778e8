#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "apps/palpate/options/device_choice.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "apps/palpate/run/exploration_plan.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/guided_hand.hpp"
#include "palpate/device/remote.hpp"
#include "palpate/device/remote_hand.hpp"
#include "palpate/device/workspace.hpp"

namespace palpate::app {

/// Who touches: a device, where it stands, and the surface's stiffness that goes with it.
struct Hand {
  std::string name;                    ///< for messages
  std::unique_ptr<RemoteHand> remote;  ///< takes the tool from its way; null: nobody can
  std::unique_ptr<GuidedHand> guide;   ///< what `remote` speaks to
  std::unique_ptr<Device> device;
  const RemoteDevice* socket = nullptr;  ///< the device, where it is another program's
  bool led = true;                       ///< false: it goes where a person or a program says
  Workspace workspace;
  std::string camera;                   ///< that its axes follow; empty: they are the world's
  std::optional<int> clutch = {};       ///< button
  double stiffness = 0;                 ///< of the surface, N/m in the world; of all hands the same
  std::size_t steps = 0;                ///< that its way takes
  std::optional<double> duration = {};  ///< s, of a device that never ends by itself
  std::optional<ExplorationPlan> plan = {};  ///< of the built-in exploration, if it is that
};

/// Reads the trajectory that `options` name; empty: none is named, so led hands are to explore, or
/// no hand is led.
/// @throws Error as reading does, UsageError when it cannot be played.
[[nodiscard]] Trajectory read_way(const TouchOptions& options);

/// The hands that `options` want. Those of other programs and those that hold hardware have their
/// device: it is opened before anything is read. `clock` is the run's and outlives them; null:
/// simulated time. Says on standard error where devices listen, and what was opened.
/// @throws Error when a socket or hardware cannot be had.
[[nodiscard]] std::vector<Hand> open_hands(const TouchOptions& options, WaitingClock* clock);

/// Puts the hands into what `scene` shows. A led one gets its device and goes along `way` or, where
/// that is empty, explores. @throws Error when there is nothing to explore.
void place_hands(std::vector<Hand>& hands, const TouchOptions& options, const Trajectory& way,
                 const Scene& scene, const FieldOptions& field);

}  // namespace palpate::app
