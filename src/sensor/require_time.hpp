#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "palpate/base/error.hpp"

namespace palpate::sensor {

/// @throws Error unless an option's time is finite and `good`; `name` is whom the stream feeds.
inline void require_time(bool good, double seconds, const char* what, const std::string& name) {
  if (good && std::isfinite(seconds)) return;
  throw Error(
      fmt::format("stream to {}: {} cannot be {} s. Give a time in seconds.", name, what, seconds));
}

}  // namespace palpate::sensor
