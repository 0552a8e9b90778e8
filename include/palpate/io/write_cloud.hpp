#pragma once

#include <filesystem>
#include <string>

#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

enum class CloudFormat { ply, pcd };

struct WriteOptions {
  bool ascii = false;  ///< text instead of binary (little endian); digits enough to lose none
};

/// Writes positions in metres, and normals, colours and intensities where the cloud has them, as
/// PLY or PCD by the path's extension. Coordinates are float where the origin is zero, else double.
/// PCD keeps the viewpoint, PLY has no place for one. What was under `path` is replaced only once
/// the new file is complete.
/// @throws Error for another extension, columns of unequal length, or a path that cannot be
/// written.
void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const WriteOptions& options = {});

/// The bytes of such a file.
[[nodiscard]] std::string encode_cloud(const PointCloud& cloud, CloudFormat format,
                                       const WriteOptions& options = {});

}  // namespace palpate
