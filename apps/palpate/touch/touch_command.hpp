#pragma once

#include "apps/palpate/options/touch_options.hpp"

namespace palpate::app {

/// `palpate touch`. @throws UsageError, Error.
void touch(const TouchOptions& options);

}  // namespace palpate::app
