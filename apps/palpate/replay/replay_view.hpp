#pragma once

#include <string>

#include "apps/palpate/options/touch_plan.hpp"

namespace palpate::app {

/// Shows a recording on a page until Ctrl-C; prints on standard error where.
/// @throws Error when the file is no recording of a run, or the page cannot be served.
void view_recording(const std::string& path, const PagePlan& page);

}  // namespace palpate::app
