#pragma once

#include <cstdio>
#include <string>

#include "apps/palpate/zwidth/zwidth_map.hpp"

namespace palpate::app {

/// A table for a person.
void print_zwidth(const ZWidthMap& map, std::FILE* out);

/// A row a wall: rate_Hz, delay_steps, damping_Ns_per_m, ... in N/m.
[[nodiscard]] std::string csv(const ZWidthMap& map);

/// The same as data, and what figures.py is told.
[[nodiscard]] std::string facts(const ZWidthMap& map);

}  // namespace palpate::app
