// Declares the clouds that are tiled: read piece by piece, twice and more.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/formats.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::io::tile {

/// A cloud whose points come in pieces, which several threads may read at once.
class TileInput {
 public:
  struct Facts {
    std::string name;
    std::string format;
    std::size_t points = 0;   ///< those that are marked as not to be used among them
    Eigen::Vector3d scale;    ///< m; coordinate = number * scale + offset
    Eigen::Vector3d offset;   ///< m
    Box box;                  ///< m; as it is announced, which may be wrong
    bool intensities = true;  ///< may they have them?
    bool colors = true;
    bool surveyed = false;  ///< its scale is that of a survey, which a store keeps
  };

  virtual ~TileInput() = default;
  [[nodiscard]] virtual const Facts& facts() const = 0;
  [[nodiscard]] virtual std::size_t pieces() const = 0;
  /// @throws Error that says what is wrong with the file.
  [[nodiscard]] virtual std::vector<LasPoint> read(std::size_t piece) const = 0;
};

/// The file, or "synthetic:terrain:N". LAS and LAZ are read piece by piece, others whole each time.
/// `scale`: multiplies a file's coordinates to give metres.
/// @throws Error that names it and what is wrong.
[[nodiscard]] std::unique_ptr<TileInput> open_input(const std::string& path, double scale);

/// A LAS or LAZ file.
[[nodiscard]] std::unique_ptr<TileInput> open_las(const std::string& path, double scale);

/// So many points of made terrain: hills, boxes and trees, 0.1 m apart, with noise of 3 cm.
[[nodiscard]] std::unique_ptr<TileInput> open_terrain(std::size_t points);

/// A step for coordinates of a cloud so long (m) that has none of its own: 1 mm; a shorter cloud
/// than 1 km has the power of ten that is a millionth of its length or less; for a longer one than
/// 2^30 steps it is ten times as long, or a hundred.
[[nodiscard]] double step_for(double length);

}  // namespace palpate::io::tile
