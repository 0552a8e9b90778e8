#include "io/xyz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "io/cloud_builder.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

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
    const std::size_t room = (input_.bytes.size() - scanner_.offset()) / (2 * columns_.count) + 1;
    CloudBuilder builder(input_, columns_.columns, ColorScale::guess, std::min(room, expected()));
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
    return text.substr(0, 2) == "//" && columns_from_names(cells_).has_value();
  }

  bool is_number_line() const {
    return cells_.count > 0 && parse_number(cells_.cells[0]).has_value();
  }

  void take_names() {
    const std::optional<TextColumns> columns = columns_from_names(cells_);
    if (!columns) {
      fail_at_line(input_, line_begin_,
                   fmt::format("\"{}\" is neither a point nor a header with the columns x, y and z",
                               excerpt(line_)),
                   kRemedy);
    }
    columns_ = *columns;
    has_names_ = true;
  }

  void guess_columns() {
    constexpr std::size_t kSample = 100;
    std::vector<std::array<double, kMostTextColumns>> rows;
    std::size_t count = 0;
    while (rows.size() < kSample && next_cells()) {
      if (count == 0) refuse_decimal_commas();
      if (count == 0) count = cells_.count;
      if (cells_.count != count) break;  // told with its line when it is read
      rows.emplace_back();
      for (std::size_t i = 0; i < count; ++i) {
        rows.back()[i] = parse_number(cells_.cells[i]).value_or(0);
      }
    }
    if (count == 0) fail(input_, "no line holds numbers", kRemedy);
    if (count < 3) fail(input_, fmt::format("{} columns, but x y z need 3", count), kRemedy);
    columns_ = columns_from_rows(count, rows);
  }

  bool read_row(Row& row) {
    if (!next_cells()) return false;
    if (cells_.count != columns_.count || cells_.too_many) {
      refuse_decimal_commas();
      fail_at_line(input_, line_begin_,
                   fmt::format("{} columns, but the first line has {}: \"{}\"", cells_.count,
                               columns_.count, excerpt(line_)),
                   kRemedy);
    }
    for (std::size_t i = 0; i < columns_.count; ++i) {
      if (columns_.roles[i]) row[index_of(*columns_.roles[i])] = cell_number(cells_.cells[i]);
    }
    return true;
  }

  void refuse_decimal_commas() const {
    if (!has_decimal_commas(line_)) return;
    fail_at_line(input_, line_begin_, "commas inside numbers",
                 "Use decimal points: sed 's/,/./g' does this if semicolons separate the columns");
  }

  // An empty cell is a missing value.
  double cell_number(std::string_view cell) const {
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    const std::optional<double> number = parse_number(cell);
    if (!number) {
      fail_at_line(input_, line_begin_, fmt::format("\"{}\" is not a number", excerpt(cell)),
                   kRemedy);
    }
    return *number;
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
  TextColumns columns_;
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
