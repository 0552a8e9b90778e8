// Declares the readers of Gaussian splats.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "extras/splats/splat_shell.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// Splats of a file, and how many of its rows were dropped.
struct SplatFile {
  std::string format;  ///< such as "SPZ 3"
  std::vector<Splat> splats{};
  std::size_t dropped = 0;

  /// Adds a splat with a rotation of any length; drops it where a number is not finite, its
  /// rotation is zero, or an extent is negative. `scale`: metres for one of the file's units.
  void add(Splat splat, double scale);
};

/// 0 to 1 as 0 to 255.
[[nodiscard]] std::uint8_t byte_of(double share);

/// A colour from the first coefficients of spherical harmonics.
[[nodiscard]] std::array<std::uint8_t, 3> color_of(const Eigen::Vector3d& coefficients);

/// The rotation whose largest of four components was left out. `others` are the rest, in order.
/// Components are w x y z, or x y z w.
[[nodiscard]] Eigen::Vector4f with_largest(std::size_t largest, const Eigen::Vector3f& others);

/// Does a PLY file with this header hold splats, compressed or not?
[[nodiscard]] bool holds_splats(const PlyHeader& header);

/// PLY as splats are trained (x, f_dc_0, opacity, scale_0, rot_0, ...; two scales too), and
/// compressed PLY (chunk and packed_position, ...).
[[nodiscard]] SplatFile read_splat_ply(const Input& input);

/// .splat: 32 bytes a splat, no header.
[[nodiscard]] SplatFile read_dot_splat(const Input& input);

/// .spz, versions 1 to 4. Those up to 3 come unpacked from gzip.
[[nodiscard]] SplatFile read_spz(const Input& input);

/// The surface of the splats that `read`, one of the above, finds in the file.
/// @throws Error when no splat is finite, or none opaque.
[[nodiscard]] CloudFile shell_file(const Input& input, SplatFile (*read)(const Input&));

}  // namespace palpate::io
