// Declares clouds that are too large for memory: sorted into an octree whose nodes are read one by
// one.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "palpate/geometry/file_unit.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// A cloud in an octree, as Potree and COPC write it. Each point is in exactly one node; those of a
/// level are about a spacing apart, which halves from level to level. So the points around a
/// position are in nodes of all levels that lie over it.
class PointStore {
 public:
  struct Node {
    std::int32_t level = 0;              ///< 0: the root; each has half the edge of the one before
    std::array<std::int32_t, 3> cell{};  ///< of its cube along x, y and z, 0 ... 2^level - 1
    std::size_t points = 0;              ///< may be 0
  };

  /// What the header and the tree contain, without any point. Lengths in metres.
  struct Layout {
    std::string format;                                ///< such as "COPC" or "Potree 2.0, DEFAULT"
    FileUnit unit;                                     ///< that was used
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the clouds that are read
    Eigen::Vector3d lower = Eigen::Vector3d::Zero();   ///< corner of the root's cube
    double edge = 0;                                   ///< of the root's cube
    double flatness = 1;      ///< height of cubes over their edge: heights may have another unit
    double spacing = 0;       ///< of the root's points
    std::size_t points = 0;   ///< of all nodes
    std::vector<Node> nodes;  ///< in the order in which their points are stored

    [[nodiscard]] Box box(std::size_t node) const;  ///< the cube of a node
    [[nodiscard]] Box box() const;                  ///< and of the root
  };

  virtual ~PointStore() = default;

  [[nodiscard]] virtual const Layout& layout() const = 0;

  /// The points of a node; those that are marked as not to be used are left out. Several threads
  /// may read at once. @throws Error that names what is wrong with the file.
  [[nodiscard]] virtual PointCloud read(std::size_t node) const = 0;
};

}  // namespace palpate
