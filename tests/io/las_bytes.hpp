#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/reading.hpp"

namespace palpate {

/// Bytes of a record of LAS point format 0 - 10.
inline constexpr std::array<std::uint16_t, 11> kLasRecordSizes{20, 28, 26, 34, 57, 63,
                                                               30, 36, 38, 59, 67};

struct LasPoint {
  std::array<std::int32_t, 3> number;  ///< coordinate = number * 0.01 + offset
  std::uint16_t intensity = 0;
  std::array<std::uint16_t, 3> color{};
  bool withheld = false;
};

/// A LAS file; offsets 637291, 851210, 511. `extra` bytes follow each record.
inline std::string las_bytes(int minor, int format, const std::vector<LasPoint>& points,
                             std::size_t extra = 0) {
  const std::size_t size = minor == 4 ? 375 : minor == 3 ? 235 : 227;
  const auto record = static_cast<std::uint16_t>(kLasRecordSizes[format] + extra);
  std::string bytes(size, '\0');
  bytes.replace(0, 4, "LASF");
  overwrite<std::uint8_t>(bytes, 24, 1);
  overwrite(bytes, 25, static_cast<std::uint8_t>(minor));
  overwrite(bytes, 94, static_cast<std::uint16_t>(size));
  overwrite(bytes, 96, static_cast<std::uint32_t>(size + 3));
  overwrite(bytes, 104, static_cast<std::uint8_t>(format));
  overwrite(bytes, 105, record);
  overwrite(bytes, 107, static_cast<std::uint32_t>(format >= 6 ? 0 : points.size()));
  const double transform[] = {0.01, 0.01, 0.01, 637291, 851210, 511};
  for (std::size_t i = 0; i < 6; ++i) overwrite(bytes, 131 + 8 * i, transform[i]);
  if (minor == 4) overwrite(bytes, 247, static_cast<std::uint64_t>(points.size()));
  bytes += "vlr";  // something between header and points
  for (const LasPoint& p : points) {
    std::string row(record, '\x55');
    for (std::size_t k = 0; k < 3; ++k) overwrite(row, 4 * k, p.number[k]);
    overwrite(row, 12, p.intensity);
    const int withheld = format >= 6 ? 4 : 128;
    overwrite(row, 15, static_cast<std::uint8_t>(p.withheld ? withheld : 2 & ~withheld));
    const int color = format == 2 ? 20 : format == 3 || format == 5 ? 28 : 30;
    if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10) {
      for (std::size_t k = 0; k < 3; ++k) overwrite(row, color + 2 * k, p.color[k]);
    }
    bytes += row;
  }
  return bytes;
}

inline std::vector<LasPoint> las_points() {
  return {{.number = {-20887, 100, -9000}, .intensity = 17, .color = {0, 257, 65535}},
          {.number = {93652, -230806, 5}, .intensity = 4000, .color = {514, 0, 0}},
          {.number = {0, 0, 0}, .withheld = true}};
}

}  // namespace palpate
