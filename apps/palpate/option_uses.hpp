#pragma once

#include <vector>

#include "apps/palpate/chosen_source.hpp"

namespace palpate::app {

/// Refuses options that these sources have no use for, and those of the command line that this run
/// has none for; in a set-up file the latter may be there for other runs.
/// @throws UsageError that says what such an option is of.
void check_use(const TouchOptions& options, const std::vector<ChosenSource>& sources);

}  // namespace palpate::app
