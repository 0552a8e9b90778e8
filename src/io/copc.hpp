// Declares what COPC files hold besides LAZ: an octree whose nodes can be read one by one.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/formats.hpp"
#include "io/stored_node.hpp"
#include "palpate/geometry/point_store.hpp"

namespace palpate::io {

struct Copc {
  Eigen::Vector3d center;  ///< of the octree, in the file's unit and frame
  double half_size = 0;    ///< of the octree, in the file's unit
  double spacing = 0;      ///< between points of level 0, in the file's unit; half as much a level
  std::vector<StoredNode> nodes;  ///< by level and cell; the parent of each is there
};

/// The octree, where the file is a COPC file. All nodes with points lie within the file, and
/// together they have the points that the header announces, no more than its bytes can hold.
/// `head`: the file's first bytes, up to its points. @throws Error that names the byte of what is
/// wrong.
[[nodiscard]] std::optional<Copc> read_copc(const Input& head, const LasHeader& header,
                                            const Parts& file);

/// "node 3-0-1-2": its level, then x, y and z of its cell.
[[nodiscard]] std::string name_of(const PointStore::Node& node);

/// The points of a node, given its bytes. `head` is named where these are damaged, in an Error.
[[nodiscard]] std::vector<LasPoint> decode_node(const Input& head, const LasHeader& header,
                                                std::span<const std::byte> bytes,
                                                const StoredNode& node);

/// A COPC file as a store; null: it is none. `options`: the scale. @throws Error as read_copc() and
/// in_las_unit() do.
[[nodiscard]] std::shared_ptr<const PointStore> open_copc(const std::filesystem::path& path,
                                                          const ReadOptions& options);

}  // namespace palpate::io
