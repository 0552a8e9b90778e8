// Finds the level of each point and the cubes of each level.

#include "large/division.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kCoarserShift = 2;  // all lengths times 4 from level to level; judgement
constexpr int kCellShift = 4;     // cells along an edge of a cube: 16, 6 R each; judgement

// Points in a cell and those around it from which on they are prepared on its level. A flat surface
// has 2000 there, its corner 200. So surfaces stay that are up to six times as sparse, whose R is
// half of the largest. Measured: of 25, 60 and 120 the one whose forces differ least from those of
// all prepared together (docs/preparation.md).
constexpr std::uint32_t kEnoughAround = 60;

// Parts of a cell along an edge, each of which has one point on the next level: 1.5 R, less than
// the spacing of what is too sparse. Measured: with 3 R forces differ more (docs/preparation.md).
constexpr int kPartShift = 2;
constexpr int kParts = 1 << kPartShift;  // derived

// Parts along an axis in either direction; derived: 21 bits each. Points farther out, 1.6 million
// R, count as if they were in the outermost ones.
constexpr double kMostParts = 1 << 20;

/// Calls visit(index) for an index and the 26 around it, itself first.
template <class Visit>
void each_around(const std::array<std::int32_t, 3>& at, const Visit& visit) {
  for (int n = 13; n < 13 + 27; ++n) {
    const int k = n % 27;
    visit(std::array{at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
  }
}

/// The index, in a grid with 2^shift times the edge, of what holds the cell with an index.
std::array<std::int32_t, 3> coarser(std::array<std::int32_t, 3> at, int shift) {
  for (std::int32_t& axis : at) axis >>= shift;
  return at;
}

int number_in_cell(const std::array<std::int32_t, 3>& part) {
  int number = 0;
  for (const std::int32_t axis : part) number = number << kPartShift | (axis & (kParts - 1));
  return number;
}

std::uint64_t key_of(const std::array<std::int32_t, 3>& at) {
  std::uint64_t key = 0;
  for (const std::int32_t axis : at) {
    key = key << 21 | static_cast<std::uint64_t>(axis + static_cast<std::int32_t>(kMostParts));
  }
  return key;
}

}  // namespace

template <class T>
std::uint32_t Division::Grid<T>::number_at(const Index& at) {
  const auto [found, is_new] =
      numbers.try_emplace(key_of(at), static_cast<std::uint32_t>(all.size()));
  if (is_new) all.emplace_back().at = at;
  return found->second;
}

template <class T>
const T* Division::Grid<T>::find(const Index& at) const {
  const auto found = numbers.find(key_of(at));
  return found == numbers.end() ? nullptr : &all[found->second];
}

Division::Division(const PointCloud& cloud, const CloudFacts& facts, int halvings)
    : cloud_(cloud),
      extent_(facts.extent),
      radius_(facts.radius),
      cube_shift_(kCellShift - halvings) {
  std::vector<std::uint32_t> members(cloud.size());
  std::iota(members.begin(), members.end(), 0u);
  std::vector<std::uint8_t> waits(cloud.size(), 1);  // has the point no level yet?
  while (!members.empty()) add_level(members, waits);
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    const auto& cubes = levels_[k].cubes.all;
    for (std::uint32_t c = 0; c < cubes.size(); ++c) {
      if (cubes[c].own > 0) blocks_.push_back({k, c});
    }
  }
  std::ranges::sort(blocks_, {}, [&](const Block& block) {
    return Key{block.level, levels_[block.level].cubes.all[block.cube].at};
  });
}

Division::Key Division::key(std::size_t block) const {
  return {blocks_[block].level, cube(block).at};
}

std::optional<std::size_t> Division::find(const Key& wanted) const {
  for (std::size_t k = 0; k < size(); ++k) {
    if (key(k) == wanted) return k;
  }
  return std::nullopt;
}

Box Division::sparser(const Key& key) const {
  if (key.level >= levels_.size()) return {};
  const Cube* const found = levels_[key.level].cubes.find(key.at);
  return found == nullptr ? Box{} : found->sparser;
}

Box Division::cube(const CloudFacts& facts, const Key& key) {
  const double edge = kBlockEdge * radius(facts, key.level);
  const Vector3d lower = facts.extent.lower + edge * Vector3d(key.at[0], key.at[1], key.at[2]);
  return {lower, lower + Vector3d::Constant(edge)};
}

Division::Key Division::above(const Key& key) {
  return {key.level + 1, coarser(key.at, kCoarserShift)};
}

double Division::radius(const CloudFacts& facts, std::size_t level) {
  return std::ldexp(facts.radius, kCoarserShift * static_cast<int>(level));
}

/// Adds a level of these points and replaces them by those of the next one.
void Division::add_level(std::vector<std::uint32_t>& members, std::vector<std::uint8_t>& waits) {
  const double radius = std::ldexp(radius_, kCoarserShift * static_cast<int>(levels_.size()));
  Level& level = levels_.emplace_back();
  level.radius = radius;
  level.cell = std::ldexp(kBlockEdge * radius, -kCellShift);
  std::vector<std::uint32_t> cells(members.size());
  std::vector<std::uint8_t> first(members.size());  // of its part of a cell
  Index last{};
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Index part = index_of(cloud_.point(members[k]), level.cell / kParts);
    const Index at = coarser(part, kPartShift);
    cells[k] = k > 0 && at == last ? cells[k - 1] : level.cells.number_at(at);
    last = at;
    Cell& cell = level.cells.all[cells[k]];
    ++cell.points;
    const std::uint64_t bit = std::uint64_t{1} << number_in_cell(part);
    first[k] = (cell.taken & bit) == 0 ? 1 : 0;
    cell.taken |= bit;
  }
  // A level whose cells are as large as the cloud takes all that is left.
  level.make_cubes(!(level.cell < extent_.size().maxCoeff()), cube_shift_);
  bool more = false;
  std::vector<std::uint32_t> next;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const std::uint32_t i = members[k];
    const Cell& cell = level.cells.all[cells[k]];
    Cube& cube = level.cubes.all[cell.cube];
    cube.points.push_back(i);
    if (waits[i] != 0 && cell.settled) {
      waits[i] = 0;
      ++cube.own;
      cube.box.extend(cloud_.point(i));
    }
    if (waits[i] != 0) cube.sparser.extend(cloud_.point(i));
    if (waits[i] != 0 || first[k] != 0) next.push_back(i);
    more = more || waits[i] != 0;
  }
  if (!more) next.clear();
  members = std::move(next);
}

/// Decides in which cells points are prepared on this level and makes room for all that is in them.
void Division::Level::make_cubes(bool takes_all, int cube_shift) {
  std::vector<std::size_t> in_cubes;  // points
  for (Cell& in : cells.all) {
    in.settled = takes_all || has_enough(in.at);
    in.cube = cubes.number_at(coarser(in.at, cube_shift));
    in_cubes.resize(cubes.all.size());
    in_cubes[in.cube] += in.points;
  }
  for (std::size_t c = 0; c < in_cubes.size(); ++c) cubes.all[c].points.reserve(in_cubes[c]);
}

bool Division::Level::has_enough(const Index& at) const {
  std::uint32_t points = 0;
  each_around(at, [&](const Index& near) {
    const Cell* const there = points < kEnoughAround ? cells.find(near) : nullptr;
    if (there != nullptr) points += there->points;
  });
  return points >= kEnoughAround;
}

Division::Index Division::index_of(const Vector3d& point, double edge) const {
  const Vector3d at = (point - extent_.lower) / edge;
  // Not negative, so that a conversion rounds down; that is faster than std::floor().
  const Vector3d counted = at.cwiseMax(-kMostParts).cwiseMin(kMostParts - 1).array() + kMostParts;
  const Eigen::Vector3i index = counted.cast<int>().array() - static_cast<int>(kMostParts);
  return {index.x(), index.y(), index.z()};
}

const Division::Cube& Division::cube(std::size_t block) const {
  return levels_[blocks_[block].level].cubes.all[blocks_[block].cube];
}

double Division::radius(std::size_t block) const {
  return levels_[blocks_[block].level].radius;
}

/// Is what lies in a part prepared on this level? Also for means of points, where no cell may be.
bool Division::Level::is_settled(const Index& part) const {
  const Index at = coarser(part, kPartShift);
  const Cell* const found = cells.find(at);
  return found != nullptr ? found->settled : has_enough(at);
}

bool Division::owns(std::size_t block, const Vector3d& position) const {
  std::size_t k = 0;
  const auto part = [&] { return index_of(position, levels_[k].cell / kParts); };
  while (k + 1 < levels_.size() && !levels_[k].is_settled(part())) ++k;
  return k == blocks_[block].level && coarser(part(), kPartShift + cube_shift_) == cube(block).at;
}

std::vector<std::uint32_t> Division::around(std::size_t block, double reach) const {
  const Level& level = levels_[blocks_[block].level];
  const Box& own = box(block);
  std::vector<std::uint32_t> found;
  each_around(cube(block).at, [&](const Index& at) {
    const Cube* const near = level.cubes.find(at);
    if (near == nullptr) return;
    for (const std::uint32_t i : near->points) {
      const Vector3d point = cloud_.point(i);
      const Vector3d off = point - point.cwiseMax(own.lower).cwiseMin(own.upper);
      if (off.cwiseAbs().maxCoeff() <= reach) found.push_back(i);
    }
  });
  std::ranges::sort(found);
  return found;
}

}  // namespace palpate
