#pragma once

#include <cstdint>
#include <string>

#include "support/folder.hpp"

namespace palpate::sensor {

using test::Folder;

/// A depth image of which all samples are `value`, as PGM.
inline std::string pgm(std::uint16_t value, int width = 4, int height = 3) {
  std::string bytes = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 65535\n";
  for (int i = 0; i < width * height; ++i) {
    bytes += static_cast<char>(value >> 8U);
    bytes += static_cast<char>(value & 0xffU);
  }
  return bytes;
}

}  // namespace palpate::sensor
