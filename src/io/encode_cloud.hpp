#pragma once

#include <string>

#include "palpate/io/cloud_file.hpp"

namespace palpate {

enum class CloudFormat { ply, pcd };

/// The bytes of a file that write_cloud() writes.
[[nodiscard]] std::string encode_cloud(const PointCloud& cloud, CloudFormat format,
                                       const WriteOptions& options = {});

}  // namespace palpate
