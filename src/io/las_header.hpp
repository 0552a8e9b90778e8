#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
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

}  // namespace palpate::io
