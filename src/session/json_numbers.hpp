// Reads numbers of JSON, and refuses what is none.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "base/parse_number.hpp"
#include "palpate/base/error.hpp"

namespace palpate::session {

/// Objects keep their keys in the order in which they are written.
using Json = nlohmann::ordered_json;

/// A value in an error's words: what is deep or long comes from a file that nobody trusts.
[[nodiscard]] inline std::string brief(const Json& json) {
  if (!json.is_string() && !json.is_number()) return json.type_name();
  constexpr std::size_t kMost = 80;  // characters, as many as a line of a terminal has
  const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

/// A number, or one of those that JSON has not, by its text.
/// @throws Error when it is none.
[[nodiscard]] inline double number_in(const Json& json) {
  std::optional<double> number;
  if (json.is_number()) number = json.get<double>();
  if (json.is_string()) number = parse_number(json.get_ref<const std::string&>());
  if (!number) throw Error(fmt::format("{} is no number", brief(json)));
  return *number;
}

/// A whole number that `Whole` holds. @throws Error when it is none.
template <class Whole>
[[nodiscard]] Whole whole_in(const Json& json) {
  using Limits = std::numeric_limits<Whole>;
  const bool held = json.is_number_unsigned() ? std::in_range<Whole>(json.get<std::uint64_t>())
                                              : json.is_number_integer() &&
                                                    std::in_range<Whole>(json.get<std::int64_t>());
  if (held) return json.get<Whole>();
  throw Error(fmt::format("{} is no whole number from {} to {}", brief(json), Limits::min(),
                          Limits::max()));
}

/// @throws Error when it is no array of so many.
inline void require_size(const Json& json, std::size_t size) {
  if (json.is_array() && json.size() == size) return;
  throw Error(fmt::format("{} of {} is given where {} numbers belong", json.type_name(),
                          json.size(), size));
}

}  // namespace palpate::session
