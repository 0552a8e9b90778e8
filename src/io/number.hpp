#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace palpate::io {

/// How a number is kept in a binary file.
enum class NumberType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// Bytes that a number of this type takes.
[[nodiscard]] constexpr std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 10> kSizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

[[nodiscard]] constexpr bool is_floating(NumberType type) {
  return type == NumberType::float32 || type == NumberType::float64;
}

/// A T read from unaligned bytes of the given byte order.
template <class T>
[[nodiscard]] T load_as(const std::byte* bytes, std::endian order = std::endian::little) {
  std::array<std::byte, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<T>(copy);
}

/// The number at `bytes` as a double (64-bit integers beyond 2^53 are rounded).
[[nodiscard]] double load_number(NumberType type, const std::byte* bytes,
                                 std::endian order = std::endian::little);

}  // namespace palpate::io
