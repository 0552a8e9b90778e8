#pragma once

#include <vector>

#include "apps/palpate/options/chosen_source.hpp"

namespace palpate::app {

/// Refuses options and keys that these sources have no use for, and options that this run has none
/// for; in a set-up file the latter may be there for other runs.
/// @throws UsageError that says what such an option is of, Error that says so of a key and where it
/// stands.
void check_use(const TouchOptions& options, const std::vector<ChosenSource>& sources);

}  // namespace palpate::app
