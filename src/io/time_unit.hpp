#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

namespace palpate::io {

/// What times count.
struct TimeUnit {
  std::string_view name;
  double per_second;
};

/// What a time since 1970 counts, judged by its size: of the years from 1973 to 5138 one in seconds
/// has up to 11 digits, and one in smaller units more. What has more than 20 is no time.
[[nodiscard]] constexpr TimeUnit unit_of_time(double time) {
  if (time > 1e20) return {"seconds", 1};
  if (time > 1e17) return {"nanoseconds", 1e9};
  if (time > 1e14) return {"microseconds", 1e6};
  if (time > 1e11) return {"milliseconds", 1e3};
  return {"seconds", 1};
}

/// What is wrong with a time that should be in seconds, and what to do.
struct WrongTime {
  std::string what;
  std::string remedy;
};

/// Nothing for a time that can be one in seconds.
[[nodiscard]] inline std::optional<WrongTime> not_in_seconds(double time) {
  const TimeUnit unit = unit_of_time(time);
  if (unit.per_second == 1) return {};
  return WrongTime{fmt::format("the time {:.0f} is in {} since 1970, but times are read as seconds",
                               time, unit.name),
                   fmt::format("Divide all times by {:.0f}", unit.per_second)};
}

}  // namespace palpate::io
