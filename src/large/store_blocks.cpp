// Lists the blocks of a store that tools may need soon, and prepares them of the nodes there.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <set>
#include <utility>

#include "large/block_supply.hpp"
#include "large/node_cache.hpp"
#include "large/store_sample.hpp"
#include "palpate/base/error.hpp"
#include "prepare/place.hpp"
#include "prepare/sampling.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Key = Division::Key;

// Typical R around a cube within which points count for its block. Derived: on level 0 the halo is
// 3 and cells are 6; on further ones 12, and cells of all levels before are 2 together. The tenth
// is for points that a turn, or rounding in the file, has moved.
constexpr double kAround = 6.1;
constexpr double kAroundSparse = 14.1;  // derived, too

// Distances between points in the largest R that may be requested. Derived: a block then has some
// 4e8 pairs of points within R of each other, which take two cores some 10 s (measured).
constexpr double kMostSpacings = 10;

// Cubes around the one that holds a tool which are prepared before it comes there; judgement.
constexpr int kSoon = 1;
// The same where a tool can reach far, so that a list has at most 125 cubes a tool; judgement.
constexpr int kMostSoon = 2;

// Points that are read for a block of a further level at most: a second's work; judgement. Only
// outliers and single things far above a dense surface are then without one.
constexpr std::size_t kMostRead = std::size_t{1} << 22;
// The same on level 0: beyond it R is so large that all memory would go into one block; judgement.
constexpr std::size_t kMostReadAtOnce = std::size_t{1} << 24;

// Cubes from the lower corner of the extent, in either direction; a Division has none farther out.
constexpr double kMostCubes = 1 << 14;

constexpr std::size_t kPieces = 4;       // one of so many bytes is for prepared blocks; judgement
constexpr std::size_t kPieceBytes = 72;  // a point; derived from the columns of SurfacePoints

/// A range of cubes of level 0, both ends included.
struct Range {
  Division::Index first{};
  Division::Index last{};

  [[nodiscard]] bool has(const Key& key) const {
    bool within = true;
    for (std::size_t k = 0; k < 3; ++k) {
      within = within && key.at[k] >= first[k] && key.at[k] <= last[k];
    }
    return within;
  }
  auto operator<=>(const Range&) const = default;  // NOLINT(modernize-use-nullptr): its 0
};

/// What is left of a box outside another: up to six boxes.
void subtract(const Box& from, const Box& taken, std::vector<Box>& left) {
  const bool apart = (from.lower.array() >= taken.upper.array()).any() ||
                     (taken.lower.array() >= from.upper.array()).any();
  if (apart) return left.push_back(from);
  Box rest = from;
  for (int axis = 0; axis < 3; ++axis) {
    Box below = rest;
    Box above = rest;
    below.upper[axis] = rest.lower[axis] = std::max(rest.lower[axis], taken.lower[axis]);
    above.lower[axis] = rest.upper[axis] = std::min(rest.upper[axis], taken.upper[axis]);
    if (below.size()[axis] > 0) left.push_back(below);
    if (above.size()[axis] > 0) left.push_back(above);
  }
}

/// The box around a box that is turned.
Box moved(const Eigen::Isometry3d& pose, const Box& box) {
  const Vector3d half = pose.linear().cwiseAbs() * (0.5 * box.size());
  const Vector3d center = pose * box.center();
  return {center - half, center + half};
}

std::size_t points_of(std::span<const CloudBlock> blocks) {
  std::size_t points = 0;
  for (const CloudBlock& block : blocks) points += block.piece.positions.size();
  return points;
}

/// Takes out cubes without points that no tool may need soon.
void drop_empty(std::span<const Range> ranges, std::vector<CloudBlock>& blocks) {
  std::erase_if(blocks, [&](const CloudBlock& block) {
    return block.key.level == 0 && block.piece.positions.empty() &&
           std::ranges::none_of(ranges, [&](const Range& range) { return range.has(block.key); });
  });
}

class StoreBlocks final : public BlockSupply {
 public:
  StoreBlocks(const std::shared_ptr<const PointStore>& store, const PrepareOptions& options,
              const Eigen::Isometry3d& pose, std::size_t memory)
      : options_(options),
        pose_(pose),
        nodes_(store, memory - memory / kPieces),
        most_prepared_(memory / kPieces / kPieceBytes) {
    if (options.paper || options.material_from_intensity) {
      throw Error(
          "the paper's preparation and materials from intensities need all of a store: read "
          "it whole");
    }
    const StoreSample sample = sample_of(*store);
    if (!options_.facts) options_.facts = measure_facts(sample, options, pose);
    check_radius();
    all_ = moved(pose_, store->layout().box());
    look_over(sample.all);
  }

  [[nodiscard]] const CloudFacts& facts() const override { return *options_.facts; }
  [[nodiscard]] std::size_t points() const override { return nodes_.layout().points; }
  [[nodiscard]] Vector3d origin() const override { return pose_ * nodes_.layout().origin; }
  [[nodiscard]] Vector3d start() const override { return start_; }
  [[nodiscard]] std::shared_ptr<const PointCloud> overview(
      std::span<const CloudBlock> /*blocks*/) const override {
    return overview_;
  }
  [[nodiscard]] bool is_whole() const override { return false; }

  [[nodiscard]] std::vector<Box> list(std::span<const Ball> tools, double near,
                                      std::vector<CloudBlock>& blocks) override {
    std::vector<Range> ranges;
    for (const Ball& ball : tools) ranges.push_back(range_of(ball));
    std::ranges::sort(ranges);
    ranges.erase(std::unique(ranges.begin(), ranges.end()), ranges.end());
    drop_empty(ranges, blocks);
    make_room(tools, near, blocks);
    std::set<Key> listed;
    for (const CloudBlock& block : blocks) listed.insert(block.key);
    for (const Range& range : ranges) add(range, listed, blocks);
    add_sparser(listed, blocks);
    return unlisted(ranges);
  }

  // The largest block so far has to fit, or blocks would come and go without end.
  [[nodiscard]] bool has_room(std::span<const CloudBlock> blocks) const override {
    return points_of(blocks) + largest_ <= most_prepared_;
  }

  void prepare(CloudBlock& block) override {
    const double radius = Division::radius(facts(), block.key.level);
    const double around = (block.key.level == 0 ? kAround : kAroundSparse) * radius;
    Box wide = Division::cube(facts(), block.key);
    wide.lower.array() -= around;
    wide.upper.array() += around;
    const Box there = moved(pose_.inverse(), wide);
    const std::size_t read = nodes_.points_around(there);
    if (block.key.level > 0 && read > kMostRead) return;
    if (read > kMostReadAtOnce) fail_too_many(read);
    if (nodes_.inside(moved(pose_.inverse(), Division::cube(facts(), block.key))).empty()) return;
    PointCloud near = nodes_.inside(there);
    if (options_.clip) near = clip(near, *options_.clip);
    if (near.empty()) return;
    const Placed placed = place(near, options_, pose_);
    const Blocks parts(placed, options_);
    block.sparser = parts.division().sparser(block.key);
    const std::optional<std::size_t> own = parts.division().find(block.key);
    if (!own) return;
    block.piece = parts.prepare(*own);
    largest_ = std::max(largest_, block.piece.positions.size());
    block.box = parts.division().box(*own);
  }

 private:
  /// Nobody waits for blocks in which each point has thousands around it.
  void check_radius() const {
    if (!options_.radius && options_.minimum_radius == 0) return;  // it follows from the distances
    const double apart = std::max(facts().spacing, voxel_of(facts(), options_));
    const double most = kMostSpacings * apart;
    if (facts().radius <= most) return;
    throw Error(
        fmt::format("an R of {:.3g} m is too large for a store whose points are {:.3g} m apart: a "
                    "block would take minutes. Give a radius of at most {:.2g} m, or a voxel of at "
                    "least {:.2g} m",
                    facts().radius, apart, most, facts().radius / kMostSpacings));
  }

  [[noreturn]] void fail_too_many(std::size_t points) const {
    throw Error(
        fmt::format("with an R of {:.3g} m one block of the cloud takes {} points: give a smaller "
                    "radius or voxel",
                    facts().radius, points));
  }

  void look_over(const PointCloud& all) {
    const auto seen = std::make_shared<const PointCloud>(place(all, {}, pose_).cloud());
    overview_ = seen;
    const Vector3d middle = facts().extent.center();
    const auto off = [&](const Eigen::Vector3f& p) {
      return (seen->origin + p.cast<double>() - middle).squaredNorm();
    };
    start_ = seen->origin + std::ranges::min_element(seen->positions, {}, off)->cast<double>();
  }

  [[nodiscard]] Range range_of(const Ball& ball) const {
    const double edge = Division::kBlockEdge * facts().radius;
    const Vector3d middle =
        ((ball.center - facts().extent.lower) / edge).cwiseMax(-kMostCubes).cwiseMin(kMostCubes);
    const double reach = std::min<double>(kSoon + ball.radius / edge, kMostSoon);
    Range range;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = middle[static_cast<int>(k)];
      range.first[k] = static_cast<std::int32_t>(std::floor(at - reach));
      range.last[k] = static_cast<std::int32_t>(std::floor(at + reach));
    }
    return range;
  }

  /// Takes out the farthest blocks that are not near. A tool high above the points of its cube
  /// needs the cube all the same: taken out, it would be prepared again at once.
  void make_room(std::span<const Ball> tools, double near, std::vector<CloudBlock>& blocks) const {
    const auto away = [&](const CloudBlock& block) {
      return block.piece.positions.empty() ? 0 : distance(block.region, tools);
    };
    std::size_t points = points_of(blocks);
    while (points > most_prepared_) {
      const auto farthest = std::ranges::max_element(blocks, {}, away);
      if (away(*farthest) <= near) return;
      points -= farthest->piece.positions.size();
      blocks.erase(farthest);
    }
  }

  void add(const Range& range, std::set<Key>& listed, std::vector<CloudBlock>& blocks) const {
    for (std::int32_t x = range.first[0]; x <= range.last[0]; ++x) {
      for (std::int32_t y = range.first[1]; y <= range.last[1]; ++y) {
        for (std::int32_t z = range.first[2]; z <= range.last[2]; ++z) {
          const Key key{0, {x, y, z}};
          if (!listed.insert(key).second) continue;
          blocks.emplace_back().key = key;
          blocks.back().box = blocks.back().region = Division::cube(facts(), key);
        }
      }
    }
  }

  /// Adds blocks of further levels for points that were found to be too sparse.
  static void add_sparser(std::set<Key>& listed, std::vector<CloudBlock>& blocks) {
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const Box sparser = blocks[k].sparser;
      if (sparser.empty()) continue;
      const Key key = Division::above(blocks[k].key);
      if (listed.insert(key).second) blocks.emplace_back().key = key;
      CloudBlock& block = *std::ranges::find(blocks, key, &CloudBlock::key);
      block.region.extend(sparser);
      if (block.state == CloudBlock::State::missing) block.box.extend(sparser);
    }
  }

  /// The store's cube without what is listed.
  [[nodiscard]] std::vector<Box> unlisted(std::span<const Range> ranges) const {
    std::vector<Box> left{all_};
    for (const Range& range : ranges) {
      Box listed = Division::cube(facts(), {0, range.first});
      listed.extend(Division::cube(facts(), {0, range.last}));
      std::vector<Box> less;
      for (const Box& box : left) subtract(box, listed, less);
      left = std::move(less);
    }
    return left;
  }

  PrepareOptions options_;  // with the facts
  Eigen::Isometry3d pose_;
  NodeCache nodes_;
  std::size_t most_prepared_;  // points
  std::size_t largest_ = 0;    // points of the largest block so far
  Box all_;                    // that holds the store, world frame, m
  std::shared_ptr<const PointCloud> overview_;
  Vector3d start_ = Vector3d::Zero();  // the point of the overview that is nearest to the middle
};

}  // namespace

std::unique_ptr<BlockSupply> blocks_of(const std::shared_ptr<const PointStore>& store,
                                       const PrepareOptions& options,
                                       const Eigen::Isometry3d& T_world_sensor,
                                       std::size_t memory) {
  return std::make_unique<StoreBlocks>(store, options, T_world_sensor, memory);
}

}  // namespace palpate
