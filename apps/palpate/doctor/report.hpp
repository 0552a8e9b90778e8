#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/palpate/doctor/finding.hpp"

namespace palpate::app::doctor {

/// Findings for people: area by area, what mends each below it, how many there are at the end.
void print(const Findings& findings, std::FILE* stream);

/// The same as a list; each has the keys area, looked_at, severity, words, remedy and lines.
[[nodiscard]] nlohmann::ordered_json as_json(const Findings& findings);

}  // namespace palpate::app::doctor
