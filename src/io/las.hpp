#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "io/input.hpp"

namespace palpate::io {

/// What reading points needs of a LAS header (ASPRS LAS 1.0 - 1.4).
struct LasHeader {
  int minor_version = 0;
  int format = 0;           ///< point format, 0 - 10
  bool compressed = false;  ///< LAZ
  std::size_t points_offset = 0;
  std::size_t record_size = 0;
  std::size_t points = 0;
  Eigen::Vector3d scale;  ///< coordinate = number * scale + offset
  Eigen::Vector3d offset;

  /// Formats from 6 on lay out a point's flags otherwise.
  [[nodiscard]] bool extended() const { return format >= 6; }
  /// The bit of a record's byte 15 that marks a point as withheld; LAS 1.0 has none.
  [[nodiscard]] std::byte withheld_mask() const;
  [[nodiscard]] std::optional<std::size_t> color_offset() const;  ///< bytes into a record
  [[nodiscard]] std::string name() const;                         ///< "LAS 1.2, point format 0"
};

/// @throws Error that names the byte of what is wrong.
[[nodiscard]] LasHeader read_las_header(const Input& input);

/// LAS 1.0 - 1.4, point formats 0 - 10. Points marked withheld are dropped; intensity and colour
/// are kept unless they are zero throughout. Made for tens of millions of points: two passes over
/// the bytes, nothing held twice. A compressed (LAZ) file goes to read_laz.
[[nodiscard]] CloudFile read_las(const Input& input);

/// Under what names the user's LASzip is looked for (as dlopen does).
inline const std::array<std::string, 2> kLaszipNames{"liblaszip.so.8", "liblaszip.so"};

/// LAZ (and COPC, which is LAZ), through the C interface of the user's LASzip 3 library.
/// @throws Error that says how to convert the file where none of `libraries` can be loaded.
[[nodiscard]] CloudFile read_laz(const Input& input, const LasHeader& header,
                                 std::span<const std::string> libraries = kLaszipNames);

}  // namespace palpate::io
