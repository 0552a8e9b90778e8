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

/// Cuts at commas and semicolons where the line has any, blanks around the cells left out; two in
/// a row enclose an empty cell. Otherwise cuts at blanks and tabs, several counting as one.
[[nodiscard]] TextCells split_cells(std::string_view line);

/// Blank, or a comment: starts with #, // or %.
[[nodiscard]] bool is_blank_or_comment(std::string_view line);

/// "1,5;2,0": commas inside the cells of a semicolon list.
[[nodiscard]] bool has_decimal_commas(std::string_view line);

}  // namespace palpate::io
