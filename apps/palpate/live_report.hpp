#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>

#include "apps/palpate/live_run.hpp"

namespace palpate::app {

/// For a person: how well time was kept, what the guard did, what the system granted.
void print_live(const LiveReport& report, std::FILE* stream);

/// The same as data.
[[nodiscard]] nlohmann::ordered_json json_live(const LiveReport& report);

}  // namespace palpate::app
