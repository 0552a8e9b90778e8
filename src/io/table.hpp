// Declares how tables of numbers are read: row by row from text, and what their columns hold.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "io/cloud_builder.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {

/// How a line of text divides into cells, and how its numbers are written.
struct Dialect {
  /// Between cells: white space of any length (" "), a tab, a semicolon, a comma, or a comma that
  /// white space follows (", "): other commas are then within numbers.
  std::string_view separator = " ";
  char decimal = '.';  ///< or a comma
  bool comments = false;
  std::string_view declarer = "the header declares";  ///< what sets the number of cells
  bool open = false;                                  ///< any number of cells may follow those
};

/// Takes the next cell off a line, without blanks and double quotes around it; nothing at the end
/// of the line, where `rest` becomes a null view. Two separators in a row enclose an empty cell.
[[nodiscard]] std::optional<std::string_view> take_cell(std::string_view& rest,
                                                        std::string_view separator);

[[nodiscard]] std::size_t count_cells(std::string_view line, std::string_view separator = " ");

/// The number in a cell; not a number (NaN) where it is empty; nothing where it holds other text.
[[nodiscard]] std::optional<double> parse_cell(std::string_view cell, char decimal);

/// Throws Error for a row whose line has another number of values than are declared.
[[noreturn]] void fail_at_row(const Input& input, const TextRow& row, const Dialect& dialect = {});

/// Walks through rows of text: one a line; blank lines and comments are passed over.
class TableRows {
 public:
  TableRows(const Input& input, std::size_t offset, const Dialect& dialect = {})
      : input_(input), scanner_(input, offset), dialect_(dialect) {}

  /// On to the next row; false at the end of the text.
  bool next();

  /// Reads the row: the k-th cell to row[slots[k]], where it has a slot.
  /// @return false where the text ends before the row is complete.
  /// @throws Error for a line with another number of cells, and for a cell that is no number.
  [[nodiscard]] bool read(std::span<const std::optional<std::size_t>> slots,
                          std::span<double> row) const;

  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t begin() const { return begin_; }  ///< of the line, bytes
  [[nodiscard]] std::size_t offset() const { return scanner_.offset(); }

 private:
  const Input& input_;
  TextScanner scanner_;
  Dialect dialect_;
  std::string_view line_;
  std::size_t begin_ = 0;
};

inline constexpr std::size_t kMostTextColumns = 4096;  ///< no honest table has more (judgement)

/// Do commas divide the line into cells of one width?
[[nodiscard]] bool has_columns_of_one_width(std::string_view line);

/// In the order in which they are tried: commas may be within numbers, blanks around all else.
inline constexpr std::string_view kSeparators[] = {";", "\t", ", ", ",", " "};

/// What a header line names.
struct ColumnNames {
  Roles roles{};
  bool degrees = false;  ///< x and y are longitude and latitude
  bool open = false;     ///< a list follows them, as COLMAP's "TRACK[]": any number of values
  /// m a unit of x, y and z, where their names tell: "X [mm]".
  std::array<std::optional<double>, 3> units{};

  /// Adds the next column by its name; `role_of`: what the name stands for.
  void add(std::string_view cell, std::optional<Role> (*role_of)(std::string_view name));
  /// The last column that is x, y or z has this unit.
  void add_unit(double metres);
};

/// The names in a line that names a point, divided by any separator: x, y and z or, without them,
/// easting, northing and height, or their like. `columns`: so many names, or at most so many before
/// a list; 0: any number.
[[nodiscard]] std::optional<ColumnNames> find_names(std::string_view line, std::size_t columns);

/// The first numbers of a row: all that guess_roles() looks at.
using FirstNumbers = std::array<double, 9>;

/// What the columns of a table without names hold, judged by their number and some of its rows: 3
/// are x y z; 4 and an intensity; 6 and a normal if the last three have unit length in most rows,
/// else a colour; 7 an intensity and a colour; 9 a normal and a colour, in the order in which unit
/// length is found. Of any other number the first three are used.
[[nodiscard]] Roles guess_roles(std::size_t columns, std::span<const FirstNumbers> rows);

}  // namespace palpate::io
