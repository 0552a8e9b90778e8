// Keeps the rows of the neighbourhood graph, and finds again those that have to hold more.
#include "geometry/neighborhood_graph.hpp"

#include <atomic>
#include <cassert>
#include <utility>

namespace palpate::detail {
namespace {

// Neighbours in all rows together: 64 MiB; judgement. A cloud of half a million points with R
// of 2.5 spacings has 6 million.
constexpr std::size_t kMostKept = std::size_t{1} << 24;

}  // namespace

NeighborhoodGraph::NeighborhoodGraph(const CellGrid& grid, std::vector<float> radii,
                                     std::span<const float> supports)
    : grid_(&grid), radii_(std::move(radii)), blocks_(make_blocks(grid, kBlockPoints)) {
  assert(radii_.size() == grid.size() && (supports.empty() || supports.size() == grid.size()));
  if (supports.empty()) return;
  squared_supports_.reserve(supports.size());
  for (const float support : supports) squared_supports_.push_back(support * support);
  cell_supports_ = largest_in_cells(grid, supports);
}

void NeighborhoodGraph::find_leaves(const Block& block, Surroundings& surroundings) const {
  const auto own = std::span<const float>(radii_).subspan(block.begin, block.size());
  surroundings.find(*grid_, block, *std::max_element(own.begin(), own.end()), cell_supports_);
}

NeighborRow NeighborhoodGraph::find_row(const Block& part, Surroundings& surroundings) const {
  const auto own = std::span<const float>(radii_).subspan(part.begin, part.size());
  return surroundings.row(part, *std::max_element(own.begin(), own.end()));
}

NeighborRow NeighborhoodGraph::find_sifted(const Block& part, Surroundings& surroundings) const {
  simd::Row squared = {};
  for (std::uint32_t q = 0; q < part.size(); ++q) {
    squared[q] = radii_[part.begin + q] * radii_[part.begin + q];
  }
  return surroundings.sifted_row(*grid_, part, squared, squared_supports_);
}

void NeighborhoodGraph::keep() {
  kept_.resize(blocks_.size());
  std::atomic<std::size_t> all = 0;
  struct Memory {
    Surroundings around;
    Kept rows;
  };
  parallel_each_with<Memory>(blocks_.size(), kBlocksAtOnce, [&](std::size_t b, Memory& memory) {
    if (all >= kMostKept) return;
    auto& [around, rows] = memory;
    rows.clear();
    find_leaves(blocks_[b], around);
    for_each_part(blocks_[b], [&](const Block& part) {
      if (rows.neighbors.size() < kMostKept)
        rows.push_back(find_sifted(make_block(*grid_, part.begin, part.end), around).neighbors);
    });
    // Which blocks are kept may depend on the threads; what is read does not.
    if ((all += rows.neighbors.size()) <= kMostKept) kept_[b] = rows;
  });
}

void NeighborhoodGraph::widen(std::span<const float> radii, std::span<const float> supports) {
  assert(radii.size() == radii_.size() && supports.size() == squared_supports_.size());
  std::vector<std::uint8_t> wider(radii_.size());
  std::vector<float> grown(radii_.size(), -1);  // supports that were smaller, m; -1: they were not
  for (std::size_t i = 0; i < radii_.size(); ++i) {
    wider[i] = radii[i] > radii_[i] ? 1 : 0;
    radii_[i] = std::max(radii_[i], radii[i]);
    const float squared = supports[i] * supports[i];
    if (squared <= squared_supports_[i]) continue;
    squared_supports_[i] = squared;
    grown[i] = supports[i];
  }
  const std::vector<float> cells = largest_in_cells(*grid_, grown);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    cell_supports_[c] = std::max(cell_supports_[c], cells[c]);
  }
  find_again(wider, cells);
}

void NeighborhoodGraph::find_again(std::span<const std::uint8_t> wider,
                                   std::span<const float> grown_cells) {
  struct Memory {
    Surroundings around;
    Surroundings grown;
    Kept rows;
  };
  parallel_each_with<Memory>(kept_.size(), kBlocksAtOnce, [&](std::size_t b, Memory& memory) {
    auto& [around, grown, rows] = memory;
    const auto is_wider = [&](const Block& part) {
      return std::ranges::count(wider.subspan(part.begin, part.size()), 1) > 0;
    };
    grown.find(*grid_, blocks_[b], -1, grown_cells);
    if (kept_[b].ends.empty() || (grown.empty() && !is_wider(blocks_[b]))) return;
    find_leaves(blocks_[b], around);
    rows.clear();
    std::size_t k = 0;
    for_each_part(blocks_[b], [&](const Block& part) {
      const bool again = is_wider(part) || grown.reach(make_block(*grid_, part.begin, part.end));
      rows.push_back(again ? find_sifted(make_block(*grid_, part.begin, part.end), around).neighbors
                           : kept_[b].row(k));
      ++k;
    });
    kept_[b] = rows;
  });
}

}  // namespace palpate::detail
