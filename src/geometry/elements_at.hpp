// Takes elements out of columns.
#pragma once

#include <cstdint>
#include <ranges>
#include <span>
#include <vector>

namespace palpate::detail {

/// The elements of a column at `indices`, in their order; empty of an empty column.
template <class Column>
[[nodiscard]] std::vector<std::ranges::range_value_t<Column>> elements_at(
    const Column& column, std::span<const std::uint32_t> indices) {
  std::vector<std::ranges::range_value_t<Column>> elements;
  if (column.empty()) return elements;
  elements.reserve(indices.size());
  for (const std::uint32_t i : indices) elements.push_back(column[i]);
  return elements;
}

}  // namespace palpate::detail
