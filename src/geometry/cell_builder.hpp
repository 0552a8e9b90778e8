#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "geometry/parallel.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// @throws Error naming the first position that is not finite.
void require_finite(std::span<const Eigen::Vector3f> positions);

/// Sorts points along a Morton curve and cuts them into cells.
///
/// Keys have a few levels only, in a cube around the points or one that is given; cells that stay
/// too full, because density varies more than these levels resolve, are sorted again with keys in
/// their own box.
class CellBuilder {
 public:
  /// @throws Error when a position is not finite.
  CellBuilder(std::span<const Eigen::Vector3f> positions, const CellGrid::Cube* cube);

  [[nodiscard]] std::vector<std::uint32_t> order() const;
  [[nodiscard]] std::vector<Eigen::Vector3f> points() const;

  /// Without their boxes.
  [[nodiscard]] std::vector<CellGrid::Cell> cells() const;

 private:
  struct Bounds {
    Eigen::Vector3f lower;
    Eigen::Vector3f upper;

    [[nodiscard]] CellGrid::Cube cube() const {
      return {lower.cast<double>(), (upper.cast<double>() - lower.cast<double>()).maxCoeff()};
    }
  };

  [[nodiscard]] std::span<Record> allocate(std::size_t count);
  template <class IndexOf>
  void make_keys(std::uint32_t begin, std::uint32_t end, const CellGrid::Cube& cube, int levels,
                 const IndexOf& index_of);
  void divide(std::size_t cell);
  bool sort_again(std::size_t cell);
  void append_children(std::size_t cell, int shift);
  [[nodiscard]] Bounds bounds_of_all() const;
  [[nodiscard]] Bounds bounds_of(const CellGrid::Cell& cell) const;

  std::span<const Eigen::Vector3f> positions_;
  // Holds all temporary memory in one block: small indices that are rebuilt often then get the same
  // warm memory each time, while freed pieces would go back to the system.
  std::pmr::monotonic_buffer_resource memory_;
  std::span<Record> records_;
  std::span<Record> scratch_;
  std::pmr::vector<CellGrid::Cell> cells_;
  std::pmr::vector<std::uint8_t> depths_;  // levels used up by the keys of each cell's points
};

/// Fits the boxes of leaves to their points, and to where these are going unless they stay, and
/// those of other cells to their children's.
void fit_boxes(std::span<const Eigen::Vector3f> points, std::span<CellGrid::Cell> cells,
               std::span<const Eigen::Vector3f> ends = {});

}  // namespace palpate::detail
