// Declares what opens Potree 2.0 stores.
#pragma once

#include <filesystem>
#include <memory>

#include "palpate/geometry/point_store.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io {

/// Is it a folder with a metadata.json, or such a file itself?
[[nodiscard]] bool is_potree(const std::filesystem::path& path);

/// The store whose folder, or metadata.json, this is: metadata.json, hierarchy.bin and octree.bin,
/// encoded as DEFAULT or BROTLI. The origin suits the root's points; colours become bytes by one
/// rule for all nodes. `options`: the scale.
/// @throws Error that names the file of what is wrong and, where there is one, the byte or node.
[[nodiscard]] std::shared_ptr<const PointStore> open_potree(const std::filesystem::path& path,
                                                            const ReadOptions& options);

}  // namespace palpate::io
