#include "io/xyz_line.hpp"

#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}
constexpr bool is_mark(char c) {
  return c == ',' || c == ';';
}

std::size_t skip_blanks(std::string_view line, std::size_t i) {
  while (i < line.size() && is_blank(line[i])) ++i;
  return i;
}

}  // namespace

TextCells split_cells(std::string_view line) {
  TextCells result;
  std::size_t i = skip_blanks(line, 0);
  while (i < line.size()) {
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i]) && !is_mark(line[i])) ++i;
    if (result.count == kMostTextColumns) {
      result.too_many = true;
      return result;
    }
    result.cells[result.count++] = line.substr(begin, i - begin);
    i = skip_blanks(line, i);
    if (i < line.size() && is_mark(line[i])) i = skip_blanks(line, i + 1);
  }
  return result;
}

bool is_blank_or_comment(std::string_view line) {
  const std::string_view text = trim(line);
  return text.empty() || text[0] == '#' || text[0] == '%' || text.substr(0, 2) == "//";
}

bool has_decimal_commas(std::string_view line) {
  return line.find(';') != std::string_view::npos && line.find(',') != std::string_view::npos;
}

}  // namespace palpate::io
