// Reads texts as numbers, in the C locale whatever the user's is.
#include "base/parse_number.hpp"

#include <locale.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

namespace palpate {

namespace {

template <class Number>
std::from_chars_result number_at_start(std::string_view text, Number& value) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  if constexpr (requires { std::from_chars(begin, end, value); }) {
    return std::from_chars(begin, end, value);
  } else {
    return number_by_strtod(text, value);
  }
}

// from_chars reports only "out of range"; the sign of the exponent shows which end.
double out_of_range_value(std::string_view token) {
  const bool tiny = token.find("e-") != std::string_view::npos ||
                    token.find("E-") != std::string_view::npos || token.find("0.") == 0;
  if (tiny) return 0;
  return token.front() == '-' ? -std::numeric_limits<double>::infinity()
                              : std::numeric_limits<double>::infinity();
}

// How Microsoft's older runtimes write what is not finite, with zeros up to the requested digits.
bool is_not_finite(std::string_view token) {
  if (token.starts_with('-')) token.remove_prefix(1);
  token = token.substr(0, token.find_last_not_of('0') + 1);
  return token == "1.#QNAN" || token == "1.#SNAN" || token == "1.#IND" || token == "1.#INF";
}

// A token whose first `size` characters alone are a number: Fortran's exponents begin with a D.
std::optional<double> number_in_parts(std::string_view token, std::size_t size) {
  if (is_not_finite(token)) return std::numeric_limits<double>::quiet_NaN();
  if (token[size] != 'D' && token[size] != 'd') return {};
  std::string usual(token);
  usual[size] = 'e';
  return parse_number(usual);
}

}  // namespace

std::optional<double> parse_number(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  double value = 0;
  const auto [end, error] = number_at_start(token, value);
  if (token.empty()) return {};
  if (end != token.data() + token.size()) {
    return number_in_parts(token, static_cast<std::size_t>(end - token.data()));
  }
  if (error == std::errc::result_out_of_range) return out_of_range_value(token);
  return error == std::errc{} ? std::optional{value} : std::nullopt;
}

std::from_chars_result number_by_strtod(std::string_view text, double& value) {
  static const locale_t kPlainLocale = newlocale(LC_ALL_MASK, "C", nullptr);
  const char* const begin = text.data();
  const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
  // strtod() passes over these, and from_chars() does not.
  if (digits.empty() || is_space(digits[0]) || digits[0] == '+' || digits[0] == '-') {
    return {begin, std::errc::invalid_argument};
  }
  if (digits.starts_with("0x") || digits.starts_with("0X")) {  // a zero, and no hexadecimal number
    value = digits.size() < text.size() ? -0.0 : 0.0;
    return {digits.data() + 1, std::errc{}};
  }
  const std::string with_end(text);
  char* end = nullptr;
  errno = 0;
  const double read = strtod_l(with_end.c_str(), &end, kPlainLocale);
  const char* const stop = begin + (end - with_end.c_str());
  if (stop == begin) return {begin, std::errc::invalid_argument};
  const bool beyond = errno == ERANGE && (read == 0 || std::isinf(read));
  if (beyond) return {stop, std::errc::result_out_of_range};
  value = read;
  return {stop, std::errc{}};
}

}  // namespace palpate
