#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/parallel.hpp"
#include "geometry/simd/joins.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// Neighbouring points in sorted order whose neighbourhoods are looked up together.
struct Group {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  Eigen::Vector3f lower = Eigen::Vector3f::Zero();  ///< tight box, m
  Eigen::Vector3f upper = Eigen::Vector3f::Zero();

  [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

inline constexpr std::uint32_t kGroupPoints = 32;

/// All points once, in sorted order, in groups of at most kGroupPoints.
[[nodiscard]] std::vector<Group> make_groups(const CellGrid& grid);

/// Points side by side as the joins want them.
class Columns {
 public:
  void clear() { indices_.clear(); }
  void reserve(std::size_t count);
  void push_back(std::uint32_t index, const Eigen::Vector3f& p);

  /// Repeats the last point up to a multiple of simd::kQueryStep.
  void pad();

  [[nodiscard]] std::size_t size() const { return indices_.size(); }
  [[nodiscard]] std::span<const std::uint32_t> indices() const { return indices_; }
  [[nodiscard]] simd::Coordinates coordinates() const;

 private:
  std::vector<std::uint32_t> indices_;
  std::vector<float> x_, y_, z_;
};

/// Replaces `found` by all points within `radius` of the group's box, in sorted order. False as
/// soon as there are more than `limit`.
bool gather(const CellGrid& grid, const Group& group, float radius, Columns& found,
            std::size_t limit = ~std::size_t{0});

/// Replaces `found` by all points within whose own radius the group's box lies, in sorted order.
/// cell_reach: for each cell the largest radius in it.
void gather_reaching(const CellGrid& grid, const Group& group, std::span<const float> radii,
                     std::span<const float> cell_reach, Columns& found);

/// For each cell the largest of its points' values.
[[nodiscard]] std::vector<float> largest_in_cells(const CellGrid& grid,
                                                  std::span<const float> values);

/// What a thread needs to work through groups: queries, candidates and room for kRows results of
/// every query.
struct JoinSpace {
  static constexpr std::size_t kRows = simd::kMoments;

  Columns queries;
  Columns candidates;
  std::array<std::vector<float>, 2> values;  ///< columns beside the candidates
  std::vector<float> query_values;           ///< a column beside the queries
  std::array<std::array<float, kGroupPoints>, kRows> results;
  std::array<float*, kRows> rows;

  JoinSpace();
  JoinSpace(const JoinSpace&) = delete;
  JoinSpace& operator=(const JoinSpace&) = delete;

  /// Makes the group's points the queries.
  void ask_for(const CellGrid& grid, const Group& group);
};

/// Calls body(group, space) for all groups, on every core when there are many.
template <class Body>
void for_each_group(const CellGrid& grid, const Body& body) {
  const std::vector<Group> groups = make_groups(grid);
  parallel_ranges(groups.size(), 64, [&](std::size_t begin, std::size_t end) {
    JoinSpace space;
    for (std::size_t g = begin; g < end; ++g) body(groups[g], space);
  });
}

}  // namespace palpate::detail
