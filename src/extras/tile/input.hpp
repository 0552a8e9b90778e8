// Declares the clouds that are tiled: read piece by piece, twice and more.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "palpate/geometry/shapes.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io::tile {

struct InputPoint {
  Eigen::Vector3d position;  ///< m
  std::uint16_t intensity = 0;
  std::array<std::uint16_t, 3> color{};
};

/// A cloud whose points come in pieces.
struct TileInput {
  std::string name;
  std::string format = {};  ///< of a file
  FileUnit unit = {};       ///< that is used
  Box box = {};             ///< m, of its points as announced
  std::size_t points = 0;   ///< those that read() leaves out among them
  std::size_t pieces = 1;
  Eigen::Vector3d steps = Eigen::Vector3d::Zero();  ///< m, of a survey's coordinates; 0: it is none
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m; positions are whole steps away
  double length = 0;                                 ///< m, of what is no survey
  /// The points of a piece but those that are marked as not to be used, or beyond 10^12 m. Several
  /// threads may read at once. @throws Error that names what is wrong with the file.
  std::function<std::vector<InputPoint>(std::size_t piece)> read{};
};

/// The file, or "synthetic:terrain:N". LAS and LAZ are read piece by piece, others whole each time.
/// `options`: the scale.
/// @throws Error that names it and what is wrong.
[[nodiscard]] TileInput open_input(const std::string& path, const ReadOptions& options);

/// A LAS or LAZ file.
[[nodiscard]] TileInput open_las(const std::string& path, const ReadOptions& options);

/// So many points of made terrain: hills and houses, points 0.1 m apart, with noise of 3 cm.
[[nodiscard]] TileInput make_terrain(std::size_t points);

/// A step for coordinates of a cloud so long (m) that has none of its own: 1 mm; a shorter cloud
/// than 1 km has the power of ten that is a millionth of its length or less; for a longer one than
/// 2^30 steps it is ten times as long, or a hundred.
[[nodiscard]] double step_for(double length);

}  // namespace palpate::io::tile
