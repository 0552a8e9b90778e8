#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "io/text_scanner.hpp"
#include "io/xyz.hpp"

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

namespace {

using Rows = std::vector<std::array<double, kMostTextColumns>>;

// "X[m]", "\"x\"", "//X" all mean x.
std::string_view bare_name(std::string_view name) {
  constexpr std::string_view kQuotes = "\"'/#";
  while (!name.empty() && kQuotes.find(name.front()) != std::string_view::npos) {
    name.remove_prefix(1);
  }
  return trim(name.substr(0, name.find_first_of("[(\"'")));
}

bool are_unit(const Rows& rows, std::size_t first) {
  if (rows.empty()) return false;
  std::size_t unit = 0;
  for (const auto& row : rows) {
    const double length = std::hypot(row[first], row[first + 1], row[first + 2]);
    if (std::abs(length - 1) < 0.01) ++unit;
  }
  return 2 * unit > rows.size();
}

TextColumns make(std::size_t count, std::initializer_list<Role> optional_roles) {
  TextColumns result{.count = count, .roles = {Role::x, Role::y, Role::z}, .columns = {}};
  result.roles.insert(result.roles.end(), optional_roles.begin(), optional_roles.end());
  result.roles.resize(count);
  std::array<bool, kRoleCount> has{};
  for (const auto& role : result.roles) {
    if (role) has[index_of(*role)] = true;
  }
  result.columns = complete_columns(has);
  return result;
}

}  // namespace

std::optional<TextColumns> columns_from_names(const TextCells& names) {
  TextColumns result{.count = names.count, .roles = {}, .columns = {}};
  std::array<bool, kRoleCount> has{};
  for (std::size_t i = 0; i < names.count; ++i) {
    std::optional<Role> role = role_of(bare_name(names.cells[i]));
    if (role && has[index_of(*role)]) role.reset();
    if (role) has[index_of(*role)] = true;
    result.roles.push_back(role);
  }
  if (!has[index_of(Role::x)] || !has[index_of(Role::y)] || !has[index_of(Role::z)]) return {};
  result.columns = complete_columns(has);
  return result;
}

TextColumns columns_from_rows(std::size_t count, const Rows& rows) {
  switch (count) {
    case 4:
      return make(count, {Role::intensity});
    case 6:
      return are_unit(rows, 3) ? make(count, {Role::normal_x, Role::normal_y, Role::normal_z})
                               : make(count, {Role::red, Role::green, Role::blue});
    case 7:
      return make(count, {Role::intensity, Role::red, Role::green, Role::blue});
    case 9:
      return are_unit(rows, 3) ? make(count, {Role::normal_x, Role::normal_y, Role::normal_z,
                                              Role::red, Role::green, Role::blue})
                               : make(count, {Role::red, Role::green, Role::blue, Role::normal_x,
                                              Role::normal_y, Role::normal_z});
    default:
      return make(count, {});
  }
}

}  // namespace palpate::io
