#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace palpate::io {

/// Columns of a text cloud that are looked at; more are refused.
inline constexpr std::size_t kMostTextColumns = 64;

/// The cells of one line.
struct TextCells {
  std::array<std::string_view, kMostTextColumns> cells;
  std::size_t count = 0;
  bool too_many = false;
};

/// Cuts at blanks, tabs, commas and semicolons; several blanks count as one, and so do a comma and
/// the blanks beside it. Two commas in a row enclose an empty cell.
[[nodiscard]] TextCells split_cells(std::string_view line);

/// Blank, or a comment: starts with #, // or %.
[[nodiscard]] bool is_blank_or_comment(std::string_view line);

/// "1,5;2,0": commas inside the cells of a semicolon list.
[[nodiscard]] bool has_decimal_commas(std::string_view line);

}  // namespace palpate::io
