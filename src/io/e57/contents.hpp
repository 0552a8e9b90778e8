// Declares what the XML of an E57 file contains about its scans.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/e57/pages.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// One column of a scan's points.
struct E57Field {
  enum class Kind { integer, float32, float64, skipped };

  std::string name;  ///< without the prefix of an extension: "normalX"
  Kind kind = Kind::skipped;
  unsigned bits = 0;         ///< of a value
  std::int64_t minimum = 0;  ///< of an integer: integer - minimum is stored
  double scale = 1;          ///< value = integer * scale + offset
  double offset = 0;
  double black = 0;  ///< the smallest value of a colour ...
  double white = 1;  ///< ... and the largest
};

struct E57Scan {
  std::string name;
  Eigen::Isometry3d T_file_scan = Eigen::Isometry3d::Identity();  ///< in the file's units
  std::uint64_t section = 0;                                      ///< logical offset of its points
  std::uint64_t points = 0;
  std::vector<E57Field> fields;
};

struct E57Contents {
  std::vector<E57Scan> scans;
  std::size_t images = 0;
};

/// @throws Error that describes what is wrong with the header or the XML.
[[nodiscard]] E57Contents read_e57_contents(const Input& input, E57Pages& pages);

}  // namespace palpate::io
