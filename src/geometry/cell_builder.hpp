#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/sort_records.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// Sorts points along a Morton curve and cuts them into cells.
///
/// Keys have a few levels only, in a box around the points; cells that stay too full, because
/// density varies more than these levels resolve, are sorted anew with keys in their own box.
class CellBuilder {
 public:
  /// @throws Error when a position is not finite.
  explicit CellBuilder(std::span<const Eigen::Vector3f> positions);

  [[nodiscard]] std::vector<std::uint32_t> take_order();
  [[nodiscard]] std::vector<Eigen::Vector3f> take_points();
  [[nodiscard]] std::vector<CellGrid::Cell> take_cells();

 private:
  struct Bounds {
    Eigen::Vector3f lower;
    Eigen::Vector3f upper;
  };

  void make_keys(std::uint32_t begin, std::uint32_t end, const Bounds& bounds, int levels);
  void divide(std::size_t cell);
  bool sort_again(std::size_t cell);
  void append_children(std::size_t cell, int shift);
  void fit_boxes();
  [[nodiscard]] Bounds bounds_of(std::uint32_t begin, std::uint32_t end) const;

  std::span<const Eigen::Vector3f> positions_;
  std::vector<Record> records_;
  std::vector<Record> scratch_;
  std::vector<CellGrid::Cell> cells_;
  std::vector<std::uint8_t> depths_;  ///< levels used up by the keys of each cell's points
  std::vector<Eigen::Vector3f> points_;
};

}  // namespace palpate::detail
