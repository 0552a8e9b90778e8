#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/row.hpp"
#include "io/xyz_line.hpp"

namespace palpate::io {

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

}  // namespace palpate::io
