#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpate {

/// The spatial index: points sorted along a Morton curve and cut into cells that follow the local
/// density, held in flat arrays.
///
/// Cell 0 is the root (an empty index has no cells); the children of a cell lie together, behind
/// their parent. A cell's points are one contiguous run of the sorted order, and its box is the
/// tight box of those points. Cells that a division would leave whole are not stored twice, so a
/// cell has two children or more. The order depends on the input alone (ties keep the input's
/// order), never on the number of threads.
class CellGrid {
 public:
  struct Cell {
    Eigen::Vector3f lower;  ///< tight box of the cell's points
    Eigen::Vector3f upper;
    std::uint32_t begin = 0;        ///< first point, in sorted order
    std::uint32_t end = 0;          ///< one past the last point
    std::uint32_t first_child = 0;  ///< index of the first child; 0 for a leaf
    std::uint32_t children = 0;     ///< number of children (2-8); 0 for a leaf

    [[nodiscard]] std::uint32_t size() const { return end - begin; }
  };

  /// A neighbour in a k-nearest search.
  struct Neighbor {
    std::uint32_t index = 0;     ///< in sorted order
    float squared_distance = 0;  ///< m^2
  };

  static constexpr std::uint32_t kLeafPoints = 16;  ///< a cell with more points is divided ...
  static constexpr int kMaxDepth = 44;              ///< ... unless its points coincide
  /// Entries that suffice for the stack of any depth-first walk over cells().
  static constexpr std::size_t kMaxStack = 7 * kMaxDepth + 1;

  CellGrid() = default;

  /// Builds the index. At most 2^31 - 1 points.
  /// @throws Error when there are more points than that, or one is not finite.
  explicit CellGrid(std::span<const Eigen::Vector3f> positions);

  /// A cube that the Morton curve runs through, in the frame of the points.
  struct Cube {
    Eigen::Vector3d lower = Eigen::Vector3d::Zero();  ///< m
    double edge = 0;                                  ///< m
  };

  /// The same, sorted along the curve of a given cube and not of the points' own: points that are
  /// more than a 2048th of it apart have the same order whichever others are there. Those outside
  /// count as at its faces.
  CellGrid(std::span<const Eigen::Vector3f> positions, const Cube& cube);

  /// Builds the index again, in the memory of the last one, of points that stand along a curve
  /// already, as those of a depth image do: `codes`, which never fall, give the position on it, two
  /// bits a level. A cell's points agree in their leading bits; those that agree in all of them
  /// stay together, however many. Their order is kept. Allocates only to grow. Positions are
  /// finite.
  ///
  /// `ends`: where the points are going, empty when they stay: the cells' boxes hold both, so a
  /// search finds what passes by on its path, too. within() and nearest() see the positions alone.
  void rebuild(std::span<const Eigen::Vector3f> positions, std::span<const std::uint32_t> codes,
               std::span<const Eigen::Vector3f> ends = {});

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] std::span<const Cell> cells() const { return cells_; }

  /// The points in sorted order.
  [[nodiscard]] std::span<const Eigen::Vector3f> points() const { return points_; }

  /// order()[k] is the index in the input of the k-th sorted point.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }

  /// Appends the sorted indices of all points with |p - center| <= radius to `found`, in rising
  /// order. Allocates only when `found` has to grow. Ends where `found` holds `most`, or a few
  /// more.
  void within(const Eigen::Vector3f& center, float radius, std::vector<std::uint32_t>& found,
              std::size_t most = std::numeric_limits<std::size_t>::max()) const;

  /// Replaces `found` by the min(k, size()) nearest points to `center`, nearest first; ties by
  /// sorted index. Allocates only when `found` has to grow.
  void nearest(const Eigen::Vector3f& center, std::size_t k, std::vector<Neighbor>& found) const;

 private:
  CellGrid(std::span<const Eigen::Vector3f> positions, const Cube* cube);
  void divide(std::size_t cell, std::span<const std::uint32_t> codes);

  std::vector<Eigen::Vector3f> points_;
  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;
};

}  // namespace palpate
