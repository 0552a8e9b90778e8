#pragma once

#include "apps/palpate/options/touch_plan.hpp"

namespace palpate::app {

/// `palpate touch`. @throws UsageError, Error.
void touch(const TouchPlan& plan);

}  // namespace palpate::app
