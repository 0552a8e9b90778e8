#pragma once

#include "apps/palpate/report/report.hpp"
#include "apps/palpate/run/named_tool.hpp"

namespace palpate::app {

/// Adds what `tool` is on a surface of `stiffness` N/m, in the world, under the keys of "tool".
void add_tool(Report& report, const SampledTool& tool, double stiffness);

}  // namespace palpate::app
