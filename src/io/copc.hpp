// Declares what COPC files hold besides LAZ: an octree whose nodes can be read one by one.
#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/formats.hpp"
#include "palpate/geometry/point_store.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::io {

/// Which cube of the octree: level 0 is all of it, each level halves the cubes of the one before.
struct CopcKey {
  std::int32_t level = 0;
  std::array<std::int32_t, 3> cell{};  ///< 0 ... 2^level - 1 along x, y and z

  auto operator<=>(const CopcKey&) const = default;  // NOLINT(modernize-use-nullptr): its 0
};

/// Points in a cube that are not in those around it: a chunk of the file.
struct CopcNode {
  CopcKey key;
  std::size_t place = 0;  ///< bytes from the start of the file
  std::size_t bytes = 0;
  std::size_t points = 0;  ///< may be 0
};

struct Copc {
  Eigen::Vector3d center;  ///< of the octree, in the file's unit and frame
  double half_size = 0;    ///< of the octree, in the file's unit
  double spacing = 0;      ///< between points of level 0, in the file's unit; half as much a level
  std::vector<CopcNode> nodes;  ///< by their keys; the parent of each is there
};

/// The octree, where the file is a COPC file. All nodes with points lie within the file, and
/// together they have the points that the header announces, no more than its bytes can hold.
/// `head`: the file's first bytes, up to its points. @throws Error that names the byte of what is
/// wrong.
[[nodiscard]] std::optional<Copc> read_copc(const Input& head, const LasHeader& header,
                                            const Parts& file);

/// The cube of a node, in the file's unit and frame.
[[nodiscard]] Box box_of(const Copc& copc, const CopcKey& key);

/// The points of a node. `head` is named where the chunk is damaged, in an Error.
[[nodiscard]] std::vector<LasPoint> read_node(const Input& head, const LasHeader& header,
                                              const Parts& file, const CopcNode& node);

/// A COPC file as a store; null: it is none. Coordinates times `scale` are metres. @throws Error as
/// read_copc() does.
[[nodiscard]] std::shared_ptr<const PointStore> open_copc(const std::filesystem::path& path,
                                                          double scale);

}  // namespace palpate::io
