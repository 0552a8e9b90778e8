#pragma once

#include "apps/palpate/zwidth/wall_trial_run.hpp"
#include "apps/palpate/zwidth/zwidth_map.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

struct ZWidthChoices {
  ZWidthOptions map;
  WallTrialRunOptions trial;  ///< on hardware, where a device is named
};

void add_zwidth_options(CLI::App& command, ZWidthChoices& choices);

/// Simulates, or measures on hardware, how stiff a wall may be, and tells it as asked.
/// @throws Error, UsageError.
void zwidth(const ZWidthChoices& choices);

}  // namespace palpate::app
