#pragma once

#include <memory>
#include <optional>

#include "apps/palpate/exploration_plan.hpp"
#include "apps/palpate/touch_options.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/guided_hand.hpp"
#include "palpate/device/remote_hand.hpp"
#include "palpate/device/workspace.hpp"

namespace palpate::app {

/// Who touches: a device, where it stands, and the surface's stiffness that goes with it.
struct Hand {
  std::unique_ptr<RemoteHand> remote;  ///< takes the tool from its way; null: nobody can
  std::unique_ptr<GuidedHand> guide;   ///< what `remote` speaks to
  std::unique_ptr<Device> device;
  Workspace workspace;
  double stiffness = 0;                 ///< of the surface, N/m in the world
  std::size_t steps = 0;                ///< that its way takes
  std::optional<ExplorationPlan> plan;  ///< of the built-in exploration, if it is that
};

/// Reads the trajectory that `options` name; empty: none is named, so the hand is to explore.
/// @throws Error as reading does, UsageError when it cannot be played.
[[nodiscard]] Trajectory read_way(const TouchOptions& options);

/// The hand that goes along `way` or, where that is empty, explores what `scene` shows.
/// @throws Error when there is nothing to explore.
[[nodiscard]] Hand make_hand(const TouchOptions& options, Trajectory way, const Scene& scene,
                             const FieldOptions& field);

}  // namespace palpate::app
