// Declares what the metadata.json of a Potree store contains.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io::potree {

/// Numbers that each point has, such as its position.
struct Attribute {
  NumberType type = NumberType::int32;  ///< of each number
  std::size_t offset = 0;               ///< bytes of a point before these
  std::size_t bytes = 0;                ///< a point
  double largest = 0;                   ///< of the numbers of all points; 0: unknown
};

/// Lengths in the store's own unit.
struct Metadata {
  std::size_t points = 0;       ///< as announced
  std::size_t first_chunk = 0;  ///< bytes of hierarchy.bin that begin at the root
  Eigen::Vector3d offset;       ///< of coordinates
  Eigen::Vector3d scale;        ///< of the numbers in octree.bin
  Eigen::Vector3d lower;        ///< corner of the root's cube
  double edge = 0;              ///< of the root's cube
  double spacing = 0;           ///< of the root's points
  std::string projection;       ///< the system of its coordinates; empty: unknown
  bool packed = false;  ///< BROTLI: attribute after attribute, packed; DEFAULT: point by point
  std::size_t point_size = 0;  ///< bytes of a point, unpacked
  Attribute position;
  std::optional<Attribute> color;
  std::optional<Attribute> intensity;
};

/// @throws Error for what is no metadata of Potree 2.0.
[[nodiscard]] Metadata read_metadata(const Input& input);

}  // namespace palpate::io::potree
