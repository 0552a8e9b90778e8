#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::float32;   ///< of the value, or of a list's items
  std::optional<NumberType> list_count{};  ///< type of a list's length, if it is a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< bytes up to the first element
};

/// @throws Error that names the line of what is wrong.
[[nodiscard]] PlyHeader read_ply_header(const Input& input);

/// PLY: ascii, binary little and big endian; any order and type of properties. Points are the
/// first element that has x, y and z; other elements and lists are skipped. Kept of a point: its
/// normal, colour and the first scalar whose name says intensity or quality.
[[nodiscard]] CloudFile read_ply(const Input& input);

}  // namespace palpate::io
