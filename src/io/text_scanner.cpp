// Scans numbers and words from text, and loads binary numbers of either byte order.
#include "io/text_scanner.hpp"

#include <fmt/format.h>
#include <locale.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

namespace palpate::io {

std::optional<NumberType> number_type(std::string_view letter, std::size_t size) {
  constexpr std::pair<std::string_view, NumberType> kNumberTypes[] = {
      {"i1", NumberType::int8},    {"u1", NumberType::uint8},  {"i2", NumberType::int16},
      {"u2", NumberType::uint16},  {"i4", NumberType::int32},  {"u4", NumberType::uint32},
      {"i8", NumberType::int64},   {"u8", NumberType::uint64}, {"f4", NumberType::float32},
      {"f8", NumberType::float64},
  };
  const std::string wanted = fmt::format("{}{}", lower_case(letter), size);
  for (const auto& [name, type] : kNumberTypes) {
    if (name == wanted) return type;
  }
  return {};
}

double load_number(NumberType type, const std::byte* bytes, std::endian order) {
  switch (type) {
    case NumberType::int8:
      return load_as<std::int8_t>(bytes, order);
    case NumberType::uint8:
      return load_as<std::uint8_t>(bytes, order);
    case NumberType::int16:
      return load_as<std::int16_t>(bytes, order);
    case NumberType::uint16:
      return load_as<std::uint16_t>(bytes, order);
    case NumberType::int32:
      return load_as<std::int32_t>(bytes, order);
    case NumberType::uint32:
      return load_as<std::uint32_t>(bytes, order);
    case NumberType::int64:
      return static_cast<double>(load_as<std::int64_t>(bytes, order));
    case NumberType::uint64:
      return static_cast<double>(load_as<std::uint64_t>(bytes, order));
    case NumberType::float32:
      return static_cast<double>(load_as<float>(bytes, order));
    case NumberType::float64:
      return load_as<double>(bytes, order);
  }
  return 0;
}

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

char line_end_of(std::string_view text) {
  constexpr std::size_t kFirst = 4096;  // bytes that the first line ends in (judgement)
  const std::size_t at = text.substr(0, kFirst).find_first_of("\r\n");
  const bool lone = at < text.size() && text[at] == '\r' && !text.substr(at + 1).starts_with('\n');
  return lone ? '\r' : '\n';
}

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
  static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
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
  const double read = strtod_l(with_end.c_str(), &end, c_locale);
  const char* const stop = begin + (end - with_end.c_str());
  if (stop == begin) return {begin, std::errc::invalid_argument};
  const bool beyond = errno == ERANGE && (read == 0 || std::isinf(read));
  if (beyond) return {stop, std::errc::result_out_of_range};
  value = read;
  return {stop, std::errc{}};
}

std::optional<std::size_t> parse_count(std::string_view token) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc{} || end != token.data() + token.size()) return {};
  return value;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view take_word(std::string_view& text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  std::size_t length = 0;
  while (length < text.size() && !is_space(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

std::string_view TextScanner::next_line() {
  const std::size_t begin = offset_;
  const std::size_t end = std::min(text_.find(line_end_, begin), text_.size());
  offset_ = std::min(end + 1, text_.size());
  std::string_view line = text_.substr(begin, end - begin);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

void TextScanner::skip_space() {
  while (offset_ < text_.size() && is_space(text_[offset_])) ++offset_;
}

std::string_view TextScanner::next_token() {
  skip_space();
  const std::size_t begin = offset_;
  while (offset_ < text_.size() && !is_space(text_[offset_])) ++offset_;
  ++row_.values;
  return text_.substr(begin, offset_ - begin);
}

std::optional<double> TextScanner::next_number() {
  skip_space();
  const std::size_t begin = offset_;
  const std::string_view token = next_token();
  if (token.empty()) return {};
  const std::optional<double> value = parse_number(token);
  if (!value) {
    fail_at_line(input_, begin, fmt::format("\"{}\" is not a number", excerpt(token)),
                 "Correct this line, or export the file again");
  }
  return value;
}

void TextScanner::begin_row() {
  skip_space();
  row_ = {.begin = offset_};
}

bool TextScanner::at_line_end() const {
  std::size_t at = offset_;
  while (at < text_.size() && (text_[at] == ' ' || text_[at] == '\t')) ++at;
  return at == text_.size() || text_[at] == '\n' || text_[at] == '\r';
}

std::size_t rows_from(const Input& input, std::size_t offset) {
  TextScanner scanner(input, offset);
  std::size_t rows = 0;
  while (!scanner.at_end()) {
    if (!trim(scanner.next_line()).empty()) ++rows;
  }
  return rows;
}

std::string unused(std::size_t count) {
  if (count == 0) return {};
  return fmt::format(", {} more than its header declares, which are not used", count);
}

bool is_blank_or_comment(std::string_view line) {
  const std::string_view text = trim(line);
  return text.empty() || text[0] == '#' || text[0] == '%' || text.substr(0, 2) == "//";
}

}  // namespace palpate::io
