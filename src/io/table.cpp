// Divides lines of text into cells, and reads their numbers.
#include "io/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "io/units/length_names.hpp"

namespace palpate::io {
namespace {

// Where the cell that a text begins with ends, which is not before `from`.
std::size_t cell_end(std::string_view text, std::size_t from, std::string_view separator) {
  if (separator == " ") {
    while (from < text.size() && !is_space(text[from])) ++from;
    return from;
  }
  std::size_t end = text.find(separator.front(), from);
  if (separator.size() > 1) {
    while (end < text.size() && end + 1 < text.size() && !is_space(text[end + 1])) {
      end = text.find(separator.front(), end + 1);
    }
  }
  return std::min(end, text.size());
}

// Just behind the quote that ends what a quote begins; 0: no quote begins the text.
std::size_t quoted_size(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos || text[first] != '"') return 0;
  return text.find('"', first + 1) + 1;
}

}  // namespace

std::optional<std::string_view> take_cell(std::string_view& rest, std::string_view separator) {
  if (separator.front() == ' ') {
    const char* at = rest.data();
    const char* const last = at + rest.size();
    while (at != last && is_space(*at)) ++at;
    rest = {at, last};
    if (rest.empty()) return {};
    if (*at != '"') {  // nearly all cells: nothing of them is trimmed
      while (at != last && !is_space(*at)) ++at;
      const std::string_view cell(rest.data(), at);
      rest = at == last ? std::string_view() : std::string_view(at + 1, last);
      return cell;
    }
  }
  if (rest.data() == nullptr) return {};
  const std::size_t end = cell_end(rest, quoted_size(rest), separator);
  std::string_view cell = trim(rest.substr(0, end));
  rest = end < rest.size() ? rest.substr(end + 1) : std::string_view();
  if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') {
    cell = trim(cell.substr(1, cell.size() - 2));
  }
  return cell;
}

std::size_t count_cells(std::string_view line, std::string_view separator) {
  std::size_t count = 0;
  while (take_cell(line, separator)) ++count;
  return count;
}

std::optional<double> parse_cell(std::string_view cell, char decimal) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (decimal == '.') return parse_number(cell);
  if (cell.find('.') != std::string_view::npos) return {};
  std::string pointed(cell);
  std::ranges::replace(pointed, decimal, '.');
  return parse_number(pointed);
}

void fail_at_row(const Input& input, const TextRow& row, const Dialect& dialect) {
  const std::string_view rest = input.text().substr(row.begin);
  const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
  fail_at_line(
      input, row.begin,
      fmt::format("{} values in a row, but {} {}: \"{}\"", count_cells(line, dialect.separator),
                  dialect.declarer, row.values, excerpt(line)),
      "Correct this row, or what declares the columns, or export the file again");
}

bool TableRows::next() {
  while (!scanner_.at_end()) {
    begin_ = scanner_.offset();
    line_ = scanner_.next_line();
    if (!(dialect_.comments ? is_blank_or_comment(line_) : trim(line_).empty())) return true;
  }
  return false;
}

bool TableRows::read(std::span<const std::optional<std::size_t>> slots,
                     std::span<double> row) const {
  std::string_view rest = line_;
  for (const std::optional<std::size_t>& slot : slots) {
    const std::optional<std::string_view> cell = take_cell(rest, dialect_.separator);
    if (!cell && scanner_.at_end()) return false;
    if (!cell) fail_at_row(input_, {begin_, slots.size()}, dialect_);
    if (!slot) continue;
    const std::optional<double> number = parse_cell(*cell, dialect_.decimal);
    if (!number && count_cells(line_, dialect_.separator) != slots.size()) {
      fail_at_row(input_, {begin_, slots.size()}, dialect_);
    }
    if (!number) {
      fail_at_line(input_, begin_, fmt::format("\"{}\" is not a number", excerpt(*cell)),
                   "Correct this line, or export the file again");
    }
    row[*slot] = *number;
  }
  if (!dialect_.open && take_cell(rest, dialect_.separator))
    fail_at_row(input_, {begin_, slots.size()}, dialect_);
  return true;
}

namespace {

// "X[m]", "\"x\"", "//X" all mean x.
std::string bare_name(std::string_view name) {
  name.remove_prefix(std::min(name.find_first_not_of("\"'/#"), name.size()));
  return lower_case(trim(name.substr(0, name.find_first_of("[(\"',;"))));
}

// "x_mm" is x where a column of that name is nothing else.
std::optional<Role> role_without_unit(std::string_view cell,
                                      std::optional<Role> (*role_of)(std::string_view name)) {
  const std::string name = bare_name(cell);
  if (const auto role = role_of(name)) return role;
  const std::size_t mark = name.find_last_of("_/ ");
  if (mark == std::string::npos || !unit_behind_name(name)) return {};
  return role_of(trim(std::string_view(name).substr(0, mark)));
}

}  // namespace

void ColumnNames::add(std::string_view cell,
                      std::optional<Role> (*role_of)(std::string_view name)) {
  roles.add(role_without_unit(cell, role_of));
  const auto role = roles[roles.size() - 1];
  degrees = degrees || (role == Role::y && bare_name(cell).starts_with("lat"));
  if (const auto unit = unit_behind_name(cell)) add_unit(*unit);
}

void ColumnNames::add_unit(double metres) {
  const auto role = roles.size() > 0 ? roles[roles.size() - 1] : std::nullopt;
  if (role && index_of(*role) < units.size()) units[index_of(*role)] = metres;
}

namespace {

// Does a comment name its columns, x y z one after the other, or is it prose that holds the
// letters?
bool is_prose(const Roles& roles) {
  std::size_t first = 0;
  while (first < roles.size() && roles[first] != Role::x) ++first;
  return first + 2 >= roles.size() || roles[first + 1] != Role::y || roles[first + 2] != Role::z;
}

}  // namespace

bool has_columns_of_one_width(std::string_view line) {
  const std::size_t width = line.find(',');
  for (std::size_t at = width; at < line.size(); at += width + 1) {
    const std::size_t next = std::min(line.find(',', at + 1), line.size());
    if (line[at] != ',' || next != at + width + 1) return false;
  }
  return true;
}

std::optional<ColumnNames> find_names(std::string_view line, std::size_t columns) {
  const std::size_t begin = std::min(line.find_first_not_of("/#% "), line.size());
  line.remove_prefix(begin);
  const std::size_t colon = line.find(": ");
  if (begin > 0 && colon != std::string_view::npos) line.remove_prefix(colon + 2);
  for (const std::string_view separator : kSeparators) {
    ColumnNames plain;
    ColumnNames fallback;
    std::string_view rest = line;
    while (plain.roles.size() <= kMostTextColumns) {
      const auto cell = take_cell(rest, separator);
      if (!cell) break;
      if (cell->find("[]") != std::string_view::npos) {
        plain.open = fallback.open = true;
        break;
      }
      const bool is_unit = separator == " " && (cell->starts_with('[') || cell->starts_with('('));
      for (ColumnNames* names : {&plain, &fallback}) {
        if (!is_unit) {
          names->add(*cell, names == &plain ? role_of : fallback_role_of);
        } else if (const auto unit = unit_behind_name(*cell)) {
          names->add_unit(*unit);
        }
      }
    }
    const ColumnNames& names = plain.roles.has_point() ? plain : fallback;
    if (!names.roles.has_point() || (begin > 0 && is_prose(names.roles))) continue;
    const std::size_t size = names.roles.size();
    if (columns == 0 || size == columns || (names.open && size < columns)) return names;
  }
  return {};
}

namespace {

bool are_unit(std::span<const FirstNumbers> rows, std::size_t first) {
  const auto unit = std::ranges::count_if(rows, [&](const FirstNumbers& row) {
    return std::abs(std::hypot(row[first], row[first + 1], row[first + 2]) - 1) < 0.01;
  });
  return 2 * static_cast<std::size_t>(unit) > rows.size();
}

// The roles after x, y and z.
std::vector<Role> roles_behind(std::size_t columns, std::span<const FirstNumbers> rows) {
  using enum Role;
  switch (columns) {
    case 4:
      return {intensity};
    case 6:
      if (are_unit(rows, 3)) return {normal_x, normal_y, normal_z};
      return {red, green, blue};
    case 7:
      return {intensity, red, green, blue};
    case 9:
      if (are_unit(rows, 3)) return {normal_x, normal_y, normal_z, red, green, blue};
      return {red, green, blue, normal_x, normal_y, normal_z};
    default:
      return {};
  }
}

}  // namespace

Roles guess_roles(std::size_t columns, std::span<const FirstNumbers> rows) {
  Roles roles;
  for (const Role role : {Role::x, Role::y, Role::z}) roles.add(role);
  for (const Role role : roles_behind(columns, rows)) roles.add(role);
  return roles;
}

}  // namespace palpate::io
