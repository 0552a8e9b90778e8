#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/cloud_builder.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// Columns of a text cloud that are looked at; more are refused.
inline constexpr std::size_t kMostTextColumns = 64;

/// The cells of one line.
struct TextCells {
  std::array<std::string_view, kMostTextColumns> cells;
  std::size_t count = 0;
  bool too_many = false;
};

/// Cuts at commas and semicolons where the line has any, blanks around the cells left out; two in
/// a row enclose an empty cell. Otherwise cuts at blanks and tabs, several counting as one.
[[nodiscard]] TextCells split_cells(std::string_view line);

/// Blank, or a comment: starts with #, // or %.
[[nodiscard]] bool is_blank_or_comment(std::string_view line);

/// "1,5;2,0": commas inside the cells of a semicolon list.
[[nodiscard]] bool has_decimal_commas(std::string_view line);

/// What the columns of a text cloud mean.
struct TextColumns {
  std::size_t count = 0;                   ///< cells that every line must have
  std::vector<std::optional<Role>> roles;  ///< one a cell
  Columns columns;
};

/// From a header line; nothing if it lacks x, y or z.
[[nodiscard]] std::optional<TextColumns> columns_from_names(const TextCells& names);

/// From the number of columns and the first few rows of numbers; see read_xyz.
[[nodiscard]] TextColumns columns_from_rows(
    std::size_t count, const std::vector<std::array<double, kMostTextColumns>>& rows);

/// A point a line, numbers separated by blanks, tabs, commas or semicolons. Lines that start with
/// #, // or % are comments; a first line of one whole number announces a count (PTS).
///
/// A header line names the columns. Without one their number decides: 3 x y z; 4 and an
/// intensity; 6 and a normal if the last three have unit length in the first lines, else a colour;
/// 7 intensity and colour; 9 and a normal and a colour, in the order in which unit length is found.
/// Of other numbers the first three columns are used.
[[nodiscard]] CloudFile read_xyz(const Input& input);

}  // namespace palpate::io
