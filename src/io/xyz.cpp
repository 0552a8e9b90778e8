// Reads text clouds: finds which column is what, by names or by the numbers themselves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "io/cloud_builder.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

// Columns of a text cloud that are looked at; more are refused.
constexpr std::size_t kMostTextColumns = 64;

// The cells of one line.
struct TextCells {
  std::array<std::string_view, kMostTextColumns> cells;
  std::size_t count = 0;
  bool too_many = false;
};

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

// Cuts at commas and semicolons where the line has any, blanks around the cells left out; two in a
// row enclose an empty cell. Otherwise cuts at blanks and tabs, several counting as one.
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

// "1,5;2,0": commas inside the cells of a semicolon list.
bool has_decimal_commas(std::string_view line) {
  return line.find(';') != std::string_view::npos && line.find(',') != std::string_view::npos;
}

// "5 2", a cell of "1,5 2,5": two numbers that a blank divides.
bool is_of_decimal_commas(std::string_view cell) {
  return parse_number(take_word(cell)).has_value() && parse_number(trim(cell)).has_value();
}

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

// Roles that a header line names.
Roles roles_from_names(const TextCells& names) {
  Roles roles;
  for (std::size_t i = 0; i < names.count; ++i) roles.add(role_of(bare_name(names.cells[i])));
  return roles;
}

// Guesses the columns after x, y and z from their number and the first few rows.
std::vector<Role> roles_behind(std::size_t count, const Rows& rows) {
  using enum Role;
  switch (count) {
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

Roles roles_from_rows(std::size_t count, const Rows& rows) {
  Roles roles;
  for (const Role role : {Role::x, Role::y, Role::z}) roles.add(role);
  for (const Role role : roles_behind(count, rows)) roles.add(role);
  while (roles.size() < count) roles.add(std::nullopt);
  return roles;
}

constexpr std::string_view kRemedy =
    "A text cloud has one point per line, x y z first, or a header line that names the columns x, "
    "y, z";

class XyzReader {
 public:
  explicit XyzReader(const Input& input) : input_(input), scanner_(input) {}

  CloudFile run() {
    const std::optional<std::size_t> announced = read_count();
    find_columns();
    // A column takes two characters at least.
    const std::size_t room = (input_.bytes.size() - scanner_.offset()) / (2 * roles_.size()) + 1;
    CloudBuilder builder(input_, roles_.columns(), ColorScale::guess, std::min(room, expected()));
    Progress progress(input_.options, input_.bytes.size());
    Row row{};
    std::size_t rows = 0;
    while (read_row(row)) {
      builder.add(row);
      ++rows;
      progress.at(scanner_.offset());
    }
    if (announced && rows < *announced) fail_cut(rows, *announced);
    return builder.finish(has_names_ ? "text, columns named" : "text");
  }

 private:
  // On to the next line that is neither blank nor a comment; false at the end.
  bool next_cells() {
    while (!scanner_.at_end()) {
      line_begin_ = scanner_.offset();
      line_ = scanner_.next_line();
      if (is_blank_or_comment(line_)) continue;
      cells_ = split_cells(line_);
      refuse_too_many();
      return true;
    }
    return false;
  }

  std::optional<std::size_t> read_count() {
    const std::size_t begin = scanner_.offset();
    if (!next_cells()) return {};
    if (cells_.count == 1) {
      if (const auto count = parse_count(cells_.cells[0])) return count;
    }
    scanner_.move_to(begin);
    return {};
  }

  // CloudCompare writes the names in a comment: "//X Y Z R G B".
  void find_columns() {
    const std::size_t begin = scanner_.offset();
    while (!scanner_.at_end()) {
      line_begin_ = scanner_.offset();
      line_ = scanner_.next_line();
      if (trim(line_).empty()) continue;
      cells_ = split_cells(line_);
      const bool comment = is_blank_or_comment(line_);
      if (comment && !named_in_comment()) continue;
      if (!comment && is_number_line()) break;
      return take_names();
    }
    scanner_.move_to(begin);
    guess_columns();
    scanner_.move_to(begin);
  }

  bool named_in_comment() const {
    const std::string_view text = trim(line_);
    return text.substr(0, 2) == "//" && roles_from_names(cells_).has_point();
  }

  bool is_number_line() const {
    return cells_.count > 0 && parse_number(cells_.cells[0]).has_value();
  }

  void take_names() {
    refuse_too_many();
    roles_ = roles_from_names(cells_);
    if (!roles_.has_point()) {
      fail_at_line(input_, line_begin_,
                   fmt::format("\"{}\" is neither a point nor a header with the columns x, y and z",
                               excerpt(line_)),
                   kRemedy);
    }
    has_names_ = true;
  }

  void guess_columns() {
    constexpr std::size_t kSample = 100;
    Rows rows;
    std::size_t count = 0;
    while (rows.size() < kSample && next_cells()) {
      if (count == 0) refuse_decimal_commas(has_decimal_commas(line_));
      if (count == 0) count = cells_.count;
      if (cells_.count != count) break;  // told with its line when it is read
      rows.emplace_back();
      for (std::size_t i = 0; i < count; ++i) {
        rows.back()[i] = parse_number(cells_.cells[i]).value_or(0);
      }
    }
    if (count == 0) fail(input_, "no line holds numbers", kRemedy);
    if (count < 3) fail(input_, fmt::format("{} columns, but x y z need 3", count), kRemedy);
    roles_ = roles_from_rows(count, rows);
  }

  bool read_row(Row& row) {
    if (!next_cells()) return false;
    if (cells_.count != roles_.size()) {
      refuse_decimal_commas(has_decimal_commas(line_));
      fail_at_line(input_, line_begin_,
                   fmt::format("{} columns, but the first line has {}: \"{}\"", cells_.count,
                               roles_.size(), excerpt(line_)),
                   kRemedy);
    }
    for (std::size_t i = 0; i < roles_.size(); ++i) {
      if (const auto role = roles_[i]) row[index_of(*role)] = cell_number(cells_.cells[i]);
    }
    return true;
  }

  void refuse_too_many() const {
    if (!cells_.too_many) return;
    fail_at_line(input_, line_begin_,
                 fmt::format("more than {} columns: \"{}\"", kMostTextColumns, excerpt(line_)),
                 "Export fewer: x y z and, if it has them, normals, colours or intensities");
  }

  void refuse_decimal_commas(bool there_are) const {
    if (!there_are) return;
    fail_at_line(input_, line_begin_, "commas inside numbers",
                 "Use decimal points: sed 's/,/./g' does this if no commas separate the columns");
  }

  // An empty cell is a missing value.
  double cell_number(std::string_view cell) const {
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    if (const std::optional<double> number = parse_number(cell)) return *number;
    refuse_decimal_commas(is_of_decimal_commas(cell));
    fail_at_line(input_, line_begin_, fmt::format("\"{}\" is not a number", excerpt(cell)),
                 kRemedy);
  }

  std::size_t expected() const {
    const std::size_t rest = input_.bytes.size() - scanner_.offset();
    return rest / std::max<std::size_t>(line_.size() / 2, 1) + 1;
  }

  [[noreturn]] void fail_cut(std::size_t present, std::size_t announced) const {
    fail(input_, fmt::format("has {} points, but its first line declares {}", present, announced),
         fmt::format(
             "Download it again; to use the points that are present, write {} in its first line",
             present));
  }

  const Input& input_;
  TextScanner scanner_;
  Roles roles_;
  TextCells cells_;
  std::string_view line_;
  std::size_t line_begin_ = 0;
  bool has_names_ = false;
};

}  // namespace

CloudFile read_xyz(const Input& input) {
  return XyzReader(input).run();
}

}  // namespace palpate::io
