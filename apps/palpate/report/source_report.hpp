#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>

#include "apps/palpate/sources/touched.hpp"

namespace palpate::app {

/// How much of a cloud is no surface that its points agree on, where it is a hundredth or more.
void print_trust(const PrepareReport& prepared, std::FILE* out);

/// What a run knows of one of its sources, for a person.
void print_source(const TouchedSource& source, std::FILE* out);

/// The same as data: SI units, named in the keys.
[[nodiscard]] nlohmann::ordered_json json_source(const TouchedSource& source);

}  // namespace palpate::app
