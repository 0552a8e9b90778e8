#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace palpate {

/// A whole token as a number, in the C locale whatever the user's is; "nan" and "inf" count, a
/// leading plus too, Fortran's "1.5D+03", and "1.#QNAN", "-1.#IND" and "1.#INF" of Microsoft's,
/// which are all not finite. What is too large for a double becomes infinite, what is too small
/// zero.
[[nodiscard]] std::optional<double> parse_number(std::string_view token);

/// Does what std::from_chars() does for a double, by strtod(): C++ libraries have had the former
/// late.
std::from_chars_result number_by_strtod(std::string_view text, double& value);

/// White space of the C locale.
[[nodiscard]] constexpr bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace palpate
