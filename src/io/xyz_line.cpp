#include "io/xyz_line.hpp"

#include <algorithm>

#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::string_view kMarks = ",;";

// The next cell and the rest of the line behind it and its separator.
std::string_view take_cell(std::string_view& rest, bool marked) {
  if (!marked) {
    const std::string_view word = take_word(rest);
    rest = trim(rest);
    return word;
  }
  const std::size_t end = std::min(rest.find_first_of(kMarks), rest.size());
  const std::string_view cell = trim(rest.substr(0, end));
  rest.remove_prefix(end);
  return cell;
}

}  // namespace

TextCells split_cells(std::string_view line) {
  TextCells result;
  std::string_view rest = trim(line);
  const bool marked = rest.find_first_of(kMarks) != std::string_view::npos;
  bool more = !rest.empty();
  while (more) {
    if (result.count == kMostTextColumns) {
      result.too_many = true;
      break;
    }
    result.cells[result.count++] = take_cell(rest, marked);
    more = !rest.empty();
    if (more && marked) rest.remove_prefix(1);
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
