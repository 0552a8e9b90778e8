// Keeps the rows of the neighbourhood graph, and finds those again that have to hold more.
#include "geometry/neighborhood_graph.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace palpate::detail {

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
  if (kept_.empty()) {  // read once, it is not worth sifting
    return surroundings.row(part, *std::max_element(own.begin(), own.end()));
  }
  simd::Row squared = {};
  for (std::uint32_t q = 0; q < part.size(); ++q) squared[q] = own[q] * own[q];
  return surroundings.sifted_row(*grid_, part, squared, squared_supports_);
}

void NeighborhoodGraph::keep_block(std::size_t b, Search& search) {
  Kept& rows = search.rows;
  const std::size_t most = kMostAPoint * blocks_[b].size();
  rows.clear();
  find_leaves(blocks_[b], search.around);
  for_each_part(blocks_[b], [&](const Block& part) {
    if (rows.neighbors.size() > most) return;
    rows.push_back(find_row(make_block(*grid_, part.begin, part.end), search.around).neighbors);
  });
  if (rows.neighbors.size() > most) rows.clear();
  kept_[b] = rows;
}

void NeighborhoodGraph::keep() {
  kept_.resize(blocks_.size());
  parallel_each_with<Search>(blocks_.size(), kBlocksAtOnce,
                             [&](std::size_t b, Search& search) { keep_block(b, search); });
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
  parallel_each_with<Search>(kept_.size(), kBlocksAtOnce, [&](std::size_t b, Search& search) {
    if (!is_kept(b)) return;
    const std::span own = std::span(wider).subspan(blocks_[b].begin, blocks_[b].size());
    search.around.find(*grid_, blocks_[b], -1, cells);
    if (!search.around.empty() || std::ranges::count(own, 1) > 0) keep_block(b, search);
  });
}

}  // namespace palpate::detail
