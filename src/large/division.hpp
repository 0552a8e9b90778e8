// Divides a cloud into blocks: cubes of a fixed grid, larger ones where points are sparser.
#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/prepare/cloud_facts.hpp"

namespace palpate {

/// A cloud on several levels. Level 0 holds all points; on each further one lengths are four times
/// as large, and it holds the points that were too sparse for the level before and few of the
/// others. A point belongs to the first level on which enough points are around it. A block is a
/// cube of a level with the points in it that belong there. Which one a point belongs to depends on
/// the facts and on what lies near it alone.
class Division {
 public:
  using Index = std::array<std::int32_t, 3>;  ///< cell or cube in its grid

  /// The cube of a block.
  struct Key {
    std::size_t level = 0;
    Index at{};

    auto operator<=>(const Key&) const = default;
  };

  static constexpr double kBlockEdge = 96;  ///< typical R of a level: edge of its cubes

  /// `cloud` has to outlive it. `halvings`: of the cubes' edges; cube() and above() are of whole
  /// ones.
  Division(const PointCloud& cloud, const CloudFacts& facts, int halvings = 0);

  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  [[nodiscard]] Key key(std::size_t block) const;
  /// The block of a cube, if points belong to it.
  [[nodiscard]] std::optional<std::size_t> find(const Key& key) const;
  /// The tight box of the points in a cube that belong to further levels, world frame, m.
  [[nodiscard]] Box sparser(const Key& key) const;

  /// A cube, world frame, m.
  [[nodiscard]] static Box cube(const CloudFacts& facts, const Key& key);
  /// The cube of the next level that holds a cube.
  [[nodiscard]] static Key above(const Key& key);
  /// A typical R on a level, m.
  [[nodiscard]] static double radius(const CloudFacts& facts, std::size_t level);
  /// A typical R on the block's level, m: that of the facts times a power of four.
  [[nodiscard]] double radius(std::size_t block) const;
  /// How many points belong to the block.
  [[nodiscard]] std::size_t points(std::size_t block) const { return cube(block).own; }
  /// Their tight box, world frame, m.
  [[nodiscard]] const Box& box(std::size_t block) const { return cube(block).box; }
  /// Do points at this position (world frame, m) belong to the block?
  [[nodiscard]] bool owns(std::size_t block, const Eigen::Vector3d& position) const;
  /// The points of the block's level up to `reach` (m, at most an edge of its cube) around its box.
  /// Rising.
  [[nodiscard]] std::vector<std::uint32_t> around(std::size_t block, double reach) const;

 private:
  struct Cell {
    Index at{};
    std::uint32_t points = 0;
    std::uint64_t taken = 0;  // a bit for each part of it: was a point seen there?
    bool settled = false;     // are enough points around to prepare those in it on this level?
    std::uint32_t cube = 0;
  };
  struct Cube {
    Index at{};
    std::vector<std::uint32_t> points;
    std::size_t own = 0;  // how many points belong to it
    Box sparser = {};     // around those that belong to further levels, m
    Box box = {};         // around these, m
  };
  template <class T>
  struct Grid {
    std::vector<T> all;
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;  // in `all`, for each index

    std::uint32_t number_at(const Index& at);  // makes what is not there
    [[nodiscard]] const T* find(const Index& at) const;
  };
  struct Level {
    double radius = 0;  // typical R, m
    double cell = 0;    // edge, m
    Grid<Cell> cells;
    Grid<Cube> cubes;

    void make_cubes(bool takes_all, int cube_shift);
    [[nodiscard]] bool has_enough(const Index& at) const;  // points in and around a cell
    [[nodiscard]] bool is_settled(const Index& part) const;
  };
  struct Block {
    std::size_t level;
    std::uint32_t cube;
  };

  void add_level(std::vector<std::uint32_t>& members, std::vector<std::uint8_t>& waits);
  [[nodiscard]] Index index_of(const Eigen::Vector3d& point, double edge) const;
  [[nodiscard]] const Cube& cube(std::size_t block) const;

  const PointCloud& cloud_;
  Box extent_;
  double radius_;   // typical R of level 0, m
  int cube_shift_;  // of the cells along an edge of a cube
  std::vector<Level> levels_;
  std::vector<Block> blocks_;  // rising by level and index
};

}  // namespace palpate
