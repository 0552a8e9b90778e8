// Reads text clouds: finds how lines divide into cells, and which column is what, by names or by
// the numbers themselves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/colmap.hpp"
#include "io/formats.hpp"
#include "io/table.hpp"
#include "io/units/file_unit.hpp"
#include "io/units/length_names.hpp"

namespace palpate::io {
namespace {

struct TextTable {
  Dialect dialect{};
  Roles roles{};
  std::vector<std::optional<std::size_t>> slots{};  // of each column's value in a Row
  bool named = false;
  bool degrees = false;
  std::array<std::optional<double>, 3> units{};  // m, of x, y and z, as their names tell
  bool counted = false;                          // the first column counts the rows
};

bool begins_with_number(std::string_view line) {
  line = trim(line);
  line.remove_prefix(line.starts_with('"') ? 1 : 0);
  return parse_number(trim(line.substr(0, line.find_first_of(" \t,;\"")))).has_value();
}

constexpr std::string_view kRemedy =
    "A text cloud has one point per line, x y z first, or a header line that names the columns x, "
    "y, z";

class XyzReader {
 public:
  explicit XyzReader(const Input& input) : input_(input) {}

  CloudFile run() {
    find_rows();
    input_.unit = in_unit_of_comments(input_, input_.text().substr(0, begin_), "").unit;
    take_sample();
    for (const std::string_view separator : kSeparators) {
      for (const char decimal : {'.', ','}) try_dialect(separator, decimal);
    }
    if (fitting_ == 0) refuse();
    take_units();
    TableRows rows(input_, begin_, table_.dialect);
    // A row is about as long as the first one; a column takes two characters at least.
    const std::size_t least = std::max(2 * table_.slots.size(), sample_[0].size() / 2);
    CloudBuilder builder(input_, table_.roles.columns(), ColorScale::guess,
                         (input_.bytes.size() - begin_) / least + 1);
    Progress progress(input_.options, input_.bytes.size());
    Row row{};
    while (rows.next()) {
      if (scans_ && begins_scan(rows)) continue;
      if (!rows.read(table_.slots, row)) {
        fail_at_row(input_, {rows.begin(), table_.slots.size()}, table_.dialect);
      }
      if (table_.degrees) to_metres(rows, row);
      builder.add(row);
      ++count_;
      progress.at(rows.offset());
    }
    end_scan();
    return builder.finish(format());
  }

 private:
  // Up to the first row, or to the number of a scan's points.
  void find_rows() {
    if (lower_case(input_.name).ends_with("points3d.txt")) comment_ = colmap::kPoints;
    TextScanner scanner(input_);
    for (begin_ = scanner.offset(); !scanner.at_end(); begin_ = scanner.offset()) {
      const std::string_view line = scanner.next_line();
      if (is_blank_or_comment(line)) {
        colmap::refuse_others(input_, line);
        if (find_names(line, 0)) comment_ = line;  // CloudCompare: "//X Y Z"
      } else if (!header_.empty() || begins_with_number(line)) {
        return;
      } else if (find_names(line, 0)) {
        header_ = line;
      } else if (lower_case(line.substr(0, 4)) != "sep=") {  // for spreadsheets
        fail_at_line(input_, begin_,
                     fmt::format("\"{}\" is neither a point nor a header with the columns x, y "
                                 "and z",
                                 excerpt(line)),
                     kRemedy);
      }
    }
  }

  void take_sample() {
    constexpr std::size_t kSample = 100;  // rows that show what a table is (judgement)
    TableRows rows(input_, begin_, {.comments = true});
    while (sample_.size() < kSample && rows.next()) {
      const bool count = parse_count(trim(rows.line())).has_value();
      scans_ = scans_ || (count && sample_.empty() && header_.empty());
      if (count && scans_) continue;
      if (sample_.empty()) first_ = rows.begin();
      sample_.push_back(rows.line());
    }
    if (!sample_.empty()) return;
    if (!header_.empty()) check_not_empty(input_, 0, 0);
    fail(input_, "no line holds numbers", kRemedy);
  }

  // Takes the table that this makes of the rows if it fits more of them than those before did.
  void try_dialect(std::string_view separator, char decimal) {
    const std::size_t columns = count_cells(sample_[0], separator);
    if (columns < 3 || columns > kMostTextColumns) return;
    TextTable table{.dialect = {separator, decimal, true, "the first row has"}};
    if (const auto names = find_names(header_.empty() ? comment_ : header_, columns)) {
      table.named = true;
      table.dialect.declarer = "the header names";
      table.degrees = names->degrees;
      table.units = names->units;
      table.roles = names->roles;
      table.dialect.open = names->open;
    } else if (header_.empty()) {
      guess(table, columns);
    }
    if (!table.roles.has_point()) return;
    table.slots.resize(table.dialect.open ? table.roles.size() : columns);
    for (std::size_t k = 0; k < table.roles.size(); ++k) {
      if (table.roles[k]) table.slots[k] = index_of(*table.roles[k]);
    }
    const auto odd =
        std::ranges::find_if_not(sample_, [&](std::string_view line) { return fits(line, table); });
    const auto fitting = static_cast<std::size_t>(odd - sample_.begin());
    // In columns of one width, as "-120,  80,1500", blanks pad numbers and separate nothing.
    const bool padded = separator == "," && table_.dialect.separator == ", " &&
                        std::ranges::all_of(sample_, has_columns_of_one_width);
    if (fitting < fitting_ || (fitting == fitting_ && !padded)) return;
    fitting_ = fitting;
    table_ = std::move(table);
  }

  // The unit that names of columns tell; one of x, y or z alone is that of all three.
  void take_units() {
    const auto& [x, y, z] = table_.units;
    const std::string names(trim(header_.empty() ? comment_ : header_));
    if (x && y && !is_same_unit(*x, *y)) {
      fail(input_, fmt::format("x and y have two units: \"{}\"", excerpt(names)),
           "Bring them to one unit");
    }
    StatedUnits stated{.plan = x ? x : y, .height = z, .assumed = z.value_or(1)};
    if (table_.degrees && z) stated.plan = 1;  // to_metres() makes metres of them
    input_.unit = in_stated_unit(input_, stated, fmt::format("\"{}\"", excerpt(names))).unit;
  }

  static bool fits(std::string_view line, const TextTable& table) {
    for (const auto& slot : table.slots) {
      const auto cell = take_cell(line, table.dialect.separator);
      if (!cell || (slot && !parse_cell(*cell, table.dialect.decimal))) return false;
      // Commas may be in numbers, too: no whole number begins with a zero.
      const bool zero = cell->size() > 1 && cell->starts_with('0') && parse_count(*cell);
      if (zero && table.dialect.separator == ",") return false;
    }
    return table.dialect.open || !take_cell(line, table.dialect.separator);
  }

  // Decides the roles of columns without names. All but the last one have to hold something, or
  // tabs that line columns up would make empty ones.
  void guess(TextTable& table, std::size_t columns) const {
    table.counted = columns > 3 && first_counts(table.dialect);
    if (table.counted) table.roles.add(std::nullopt);
    const std::size_t first = table.roles.size();
    std::vector<FirstNumbers> rows(sample_.size());
    std::vector<bool> filled(columns);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      std::string_view rest = sample_[i];
      for (std::size_t k = 0; k < columns; ++k) {
        const std::string_view cell = take_cell(rest, table.dialect.separator).value_or("");
        filled[k] = filled[k] || !cell.empty();
        if (k < first || k - first >= rows[i].size()) continue;
        rows[i][k - first] = parse_cell(cell, table.dialect.decimal).value_or(0);
      }
    }
    if (!filled.back()) --columns;
    if (static_cast<std::size_t>(std::ranges::count(filled, true)) < columns) return;
    const Roles guessed = guess_roles(columns - first, rows);
    for (std::size_t k = 0; k < guessed.size(); ++k) table.roles.add(guessed[k]);
  }

  // Does the first column count all rows, from 0 or 1 on? Points at x = 0, 1, 2 ... of a surface
  // come back to the same x.
  bool first_counts(const Dialect& dialect) const {
    constexpr double kFewestRows = 4;  // rows: three points may well lie so
    TableRows rows(input_, begin_, dialect);
    double begin = 0;
    double count = 0;
    for (; rows.next(); ++count) {
      std::string_view line = rows.line();
      const double number = parse_cell(*take_cell(line, dialect.separator), '.').value_or(-1);
      if (count == 0) begin = number;
      if (number != begin + count || (begin != 0 && begin != 1)) return false;
    }
    return count >= kFewestRows;
  }

  // Reports why not even the first row is one.
  [[noreturn]] void refuse() const {
    const std::string_view line = sample_[0];
    const auto* separator = std::ranges::find_if(
        kSeparators, [&](std::string_view mark) { return line.find(mark) != line.npos; });
    if (separator == std::end(kSeparators)) --separator;
    const std::size_t columns = count_cells(line, *separator);
    const auto names = find_names(header_, 0);
    if (names && names->roles.size() != columns) {
      fail_at_row(input_, {first_, names->roles.size()},
                  {.separator = *separator, .declarer = "the header names"});
    }
    std::string what = "commas seem to be both within numbers and between them";
    if (columns < 3) what = fmt::format("{} columns, but x y z need 3", columns);
    if (columns > kMostTextColumns) what = fmt::format("more than {} columns", kMostTextColumns);
    for (std::string_view rest = line; const auto cell = take_cell(rest, *separator);) {
      if (!parse_cell(*cell, '.')) what = fmt::format("\"{}\" is not a number", excerpt(*cell));
    }
    fail_at_line(input_, first_, fmt::format("{}: \"{}\"", what, excerpt(line)), kRemedy);
  }

  // Is the line the number of a scan's points?
  bool begins_scan(const TableRows& rows) {
    const std::optional<std::size_t> count = parse_count(trim(rows.line()));
    if (!count) return false;
    end_scan();
    announced_ = *count;
    first_ = rows.begin();
    count_ = 0;
    return true;
  }

  void end_scan() const {
    if (!scans_ || count_ == announced_) return;
    fail_at_line(input_, first_,
                 fmt::format("{} points follow, but this line declares {}", count_, announced_),
                 fmt::format("Download it again; to use the points that are present, write {} here",
                             count_));
  }

  // Degrees of longitude and latitude become metres to the east and north of the first point.
  void to_metres(const TableRows& rows, Row& row) {
    const auto [longitude, latitude] = std::pair(row[0], row[1]);
    if (std::abs(longitude) > 360 || std::abs(latitude) > 90) {
      fail_at_line(input_, rows.begin(),
                   fmt::format("a longitude of {} and a latitude of {}", longitude, latitude),
                   "If they are no degrees, name these columns x and y");
    }
    if (!zero_ && std::isfinite(longitude + latitude)) zero_ = {longitude, latitude};
    if (!zero_) return;
    const double turn = zero_->second * std::numbers::pi / 180;
    // m a degree on the ellipsoid WGS 84. The builder scales what is a length in the file.
    const double east = 111412.84 * std::cos(turn) - 93.5 * std::cos(3 * turn);
    const double north = 111132.92 - 559.82 * std::cos(2 * turn);
    row[0] = std::remainder(longitude - zero_->first, 360) * east / input_.unit.plan;
    row[1] = (latitude - zero_->second) * north / input_.unit.plan;
  }

  std::string format() const {
    return fmt::format("text{}{}{}{}", table_.named ? ", columns named" : "",
                       table_.dialect.decimal == ',' ? ", decimal commas" : "",
                       table_.counted ? ", whose first column counts the rows" : "",
                       table_.degrees ? ", degrees made metres" : "");
  }

  Input input_;                 // in the unit that the file states
  std::size_t begin_ = 0;       // of the first row, or of the number of a scan's points, bytes
  std::size_t first_ = 0;       // of the first row; then of the last number of a scan's points
  std::string_view header_{};   // the line of text before the rows
  std::string_view comment_{};  // one that names a point
  std::vector<std::string_view> sample_{};
  std::size_t fitting_ = 0;  // rows of the sample, from the first on, that fit the table
  TextTable table_{};
  bool scans_ = false;
  std::size_t announced_ = 0;                        // points of this scan
  std::size_t count_ = 0;                            // that came
  std::optional<std::pair<double, double>> zero_{};  // degrees, of the first point
};

}  // namespace

CloudFile read_xyz(const Input& input) {
  return XyzReader(input).run();
}

}  // namespace palpate::io
