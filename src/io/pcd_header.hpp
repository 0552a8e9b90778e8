#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "io/input.hpp"
#include "io/number.hpp"

namespace palpate::io {

enum class PcdEncoding { ascii, binary, compressed };

struct PcdField {
  std::string name;
  NumberType type = NumberType::float32;
  std::size_t count = 1;   ///< numbers a point
  std::size_t offset = 0;  ///< bytes from the start of a point
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t point_size = 0;  ///< bytes of a binary point
  std::size_t width = 0;
  std::size_t height = 1;
  std::size_t points = 0;
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};  ///< position, quaternion w x y z
  PcdEncoding encoding = PcdEncoding::ascii;
  std::size_t size = 0;  ///< bytes up to the data

  [[nodiscard]] bool organised() const { return height > 1; }
};

/// @throws Error that names the line of what is wrong.
[[nodiscard]] PcdHeader read_pcd_header(const Input& input);

}  // namespace palpate::io
