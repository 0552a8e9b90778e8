#pragma once

#include <string>

#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// Loads a library in a process of its own, which may crash or hang (10 s) without harm, and asks
/// for its version where it is Force Dimension's. @throws Error when there can be no other process.
[[nodiscard]] LibraryTrial try_library(const std::string& name);

}  // namespace palpate::app::doctor
