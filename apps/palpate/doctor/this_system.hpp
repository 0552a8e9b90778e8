#pragma once

#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// The machine that the program runs on.
[[nodiscard]] System this_system();

}  // namespace palpate::app::doctor
