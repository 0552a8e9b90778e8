// Declares the parts of the LAZ encoder.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "io/laz_encoder_parts.hpp"

namespace palpate {

[[nodiscard]] inline std::size_t hex_digit(char digit) {
  return static_cast<std::size_t>(digit <= '9' ? digit - '0' : digit - 'a' + 10);
}

[[nodiscard]] std::string encode_chunk_10(int format, std::span<const std::string_view> records);
[[nodiscard]] std::string encode_chunk_14(int format, std::span<const std::string_view> records);

}  // namespace palpate
