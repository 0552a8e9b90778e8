// Scans numbers and words from text, and loads binary numbers of either byte order.
#include "io/text_scanner.hpp"

#include <fmt/format.h>

#include <charconv>
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

char line_end_of(std::string_view text) {
  constexpr std::size_t kFirst = 4096;  // bytes that the first line ends in (judgement)
  const std::size_t at = text.substr(0, kFirst).find_first_of("\r\n");
  const bool lone = at < text.size() && text[at] == '\r' && !text.substr(at + 1).starts_with('\n');
  return lone ? '\r' : '\n';
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
