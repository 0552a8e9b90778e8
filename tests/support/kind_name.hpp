#pragma once

#include <array>
#include <cstddef>

#include "palpate/field/field_options.hpp"

namespace palpate::test {

/// What a kind of surface is called in names of tests and in what they record.
[[nodiscard]] inline const char* kind_name(FieldOptions::Kind kind) {
  constexpr std::array kNames = {"balanced", "pointset", "metaball"};
  return kNames.at(static_cast<std::size_t>(kind));
}

}  // namespace palpate::test
