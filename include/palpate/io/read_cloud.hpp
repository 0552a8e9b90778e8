#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "palpate/geometry/pinhole.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

struct ReadOptions {
  double scale = 1;                   ///< multiplies the file's coordinates to give metres
  std::optional<Pinhole> intrinsics;  ///< of a depth image; needed for one
  double depth_unit = 1e-3;           ///< metres a step of a depth image
  std::function<void(double)> progress;  ///< called with 0 ... 1 now and then, on this thread
};

/// A cloud and what its file said of itself.
struct CloudFile {
  PointCloud cloud;
  std::string format;             ///< such as "PLY, binary little endian"
  std::size_t declared = 0;       ///< points that the file announces
  std::size_t dropped = 0;        ///< of them not finite or marked invalid
  std::size_t width = 0;          ///< columns of an organised cloud, else 0
  std::size_t height = 0;         ///< rows of an organised cloud, else 0
};

/// Reads PLY, PCD, XYZ/TXT/CSV, OBJ, LAS (LAZ through the user's liblaszip), 16-bit depth PNG and
/// PGM; gzip around any of them. The kind is told from the bytes first and from the name second;
/// "-" is standard input. Points that are not finite are dropped and counted.
/// @throws Error that names the file, the place in it and a remedy.
[[nodiscard]] CloudFile read_cloud_file(const std::filesystem::path& path,
                                        const ReadOptions& options = {});

/// The same for bytes in memory. `name` stands for the file in messages and gives its extension.
[[nodiscard]] CloudFile read_cloud_bytes(std::span<const std::byte> bytes, const std::string& name,
                                         const ReadOptions& options = {});

/// The cloud alone.
[[nodiscard]] PointCloud read_cloud(const std::filesystem::path& path,
                                    const ReadOptions& options = {});

}  // namespace palpate
