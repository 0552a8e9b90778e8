// Declares how readers of PLY files get at the rows of elements.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "io/formats.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// What is wanted of an element's rows, and who takes it.
struct PlyTable {
  const PlyElement* element = nullptr;
  std::vector<std::optional<std::size_t>>
      slots{};                ///< of each property's value in `row`, if wanted
  std::vector<double> row{};  ///< values as they are where the file has no such property
  std::function<void(std::span<const double>)> take{};  ///< gets each row in turn
  std::optional<std::size_t> list{};                    ///< the property whose lists are wanted
  std::vector<double> items{};                          ///< of the list of this row
  std::size_t list_begin = 0;                           ///< its byte in the file
};

/// The table of the properties called `names`, whose values come in that order. Those that the
/// element lacks are `absent`.
[[nodiscard]] PlyTable table_of(const PlyElement& element, std::span<const std::string_view> names,
                                double absent = 0);

/// Reads the file up to the last of `tables`, which come in its order; skips all else.
/// @return how many rows follow the last one that is declared; of bytes only where their rows have
///   one size, and only where the last element was read.
/// @throws Error when the file is cut, a number is none, or rows of text do not fit their lines.
std::size_t read_ply_rows(const Input& input, const PlyHeader& header, std::span<PlyTable> tables);

/// How many rows of the element the file's bytes can hold, at most.
[[nodiscard]] std::size_t most_rows(const Input& input, const PlyHeader& header,
                                    const PlyElement& element);

/// "PLY, binary little endian".
[[nodiscard]] std::string_view name_of(PlyEncoding encoding);

}  // namespace palpate::io
