#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {

/// Numbers in an input. Points lie along all axes but one, along which the numbers of each lie:
/// behind that axis there are `inner` points.
struct Array {
  NumberType type = NumberType::float32;
  std::size_t begin = 0;  ///< bytes
  std::size_t points = 0;
  std::size_t columns = 0;
  std::size_t inner = 1;
};

/// The cloud of an array that lies within the input.
[[nodiscard]] CloudFile cloud_of_array(const Input& input, const Array& array,
                                       const std::string& format);

/// How many numbers a point has of those from `begin` on, of 3 to 9 that divide their count: from
/// point to point the same number differs less than others do. 0: none divides it.
[[nodiscard]] std::size_t group_size(const Input& input, std::size_t begin, NumberType type);

/// NumPy's .npy.
[[nodiscard]] CloudFile read_npy(const Input& input);

}  // namespace palpate::io
