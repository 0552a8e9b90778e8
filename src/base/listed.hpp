#pragma once

#include <functional>

#include "palpate/base/driver_info.hpp"

namespace palpate {

/// `driver` with what `list` adds to it. Where that throws an Error, the driver is not available,
/// and misses what the error says.
[[nodiscard]] DriverInfo listed(DriverInfo driver, const std::function<void(DriverInfo&)>& list);

}  // namespace palpate
