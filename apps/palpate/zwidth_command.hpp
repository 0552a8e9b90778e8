#pragma once

#include "apps/palpate/zwidth_map.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

void add_zwidth_options(CLI::App& command, ZWidthOptions& options);

/// Simulates how stiff a wall may be, and tells it as asked.
/// @throws Error, UsageError.
void zwidth(const ZWidthOptions& options);

}  // namespace palpate::app
