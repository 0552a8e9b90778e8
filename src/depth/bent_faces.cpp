// Gives blocks of bent things the quadric that explains most of what is around them.
#include "depth/bent_faces.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace palpate::depth {
namespace {

// Are a quadric's slopes about as certain as those by the block's window? Where no plane serves
// windows are farther off than their variance states: there a quadric that explains more than a
// plane need not be.
bool is_precise(const Quadric::Sight& sight, const BlockFits& fits, std::size_t i) {
  const double step = std::min(std::abs(fits.grid.step_x), std::abs(fits.grid.step_y));
  return fits.confidences[i] == 0 || is_bent(fits, i) ||
         sight.slope_variance <= kLessPrecise * fits.slope_variance[i] * step * step;
}

// Gives a block the first of some quadrics that explains what is around it.
void give(std::span<const Quadric* const> faces, const simd::FitInput& input,
          const SameSurface& same, int column, int row, BlockFits& fits) {
  const float rho = input.blocks.rho[row * input.blocks.stride + column];
  const double sigma = block_sigma(same.noise, rho);
  const double square = kOffFace * sigma * sigma;
  const std::size_t i = fits.grid.index(column, row);
  for (const Quadric* face : faces) {
    const int u = column - face->column;
    const int v = row - face->row;
    if (std::abs(u) > face->reach || std::abs(v) > face->reach) continue;
    if (!face->holds(u, v, rho, square) || !face->explains(input.blocks, same, u, v)) continue;
    const auto sight = face->at(u, v);
    if (!sight || !(sight->variance > 0 && sight->slope_variance > 0)) continue;
    const double off = sight->rho - rho;
    if (off * off > square || !is_precise(*sight, fits, i)) continue;
    fits.set(i, sight->rho, sight->variance, sight->x, sight->y, sight->slope_variance);
    return;
  }
}

}  // namespace

void BentFaces::find(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
                     const BlockFits& fits, int tile_row) {
  const simd::WindowTable& table = input.table;
  const BlockRange range{table.first_column, table.first_row, table.columns, table.rows};
  tiles_.each_middle(fits.grid, tile_row, [&](std::size_t index, int column, int row) {
    const bool bent = is_bent(fits, fits.grid.index(column, row));
    if (bent && kept.at(column, row)) return;  // it was fitted last time
    found_[index] = 0;
    if (!bent || !range.overlaps({column, row, 1, 1})) return;
    const auto face = fit_quadric(input, noise, fits, column, row);
    if (!face) return;
    faces_[index] = *face;
    found_[index] = 1;
  });
}

// Blocks of each tile with bent ones take the quadric that explains them and most around, the first
// of equals. The more precise one would be a bad choice: a strip of another surface makes it so. In
// small windows a plane serves for some of a ball's blocks, so these take them, too. Straight
// blocks, whose largest window is a plane, take none.
void BentFaces::share(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
                      int tile_row, BlockFits& fits) const {
  const SameSurface same(noise, fits.grid);
  for (int tile = 0; tile < tiles_.columns; ++tile) {
    bool bent = false;
    bool changed = false;
    tiles_.each_block(fits.grid, tile, tile_row, [&](int column, int row) {
      bent |= is_bent(fits, fits.grid.index(column, row));
      changed |= !kept.at(column, row);
    });
    if (!bent || !changed) continue;
    const Quadric* near[(2 * kAround + 1) * (2 * kAround + 1)];
    std::size_t count = 0;
    tiles_.each_near(tile, tile_row, [&](std::size_t index) {
      if (found_[index]) near[count++] = &faces_[index];
    });
    if (count == 0) continue;
    std::sort(near, near + count, [](const Quadric* a, const Quadric* b) {
      return a->support > b->support || (a->support == b->support && a < b);
    });
    tiles_.each_block(fits.grid, tile, tile_row, [&](int column, int row) {
      const std::size_t i = fits.grid.index(column, row);
      const bool fitted = fits.states[i] == FilteredDepth::State::fitted;
      const bool straight = fits.flat[i] == simd::kStraight;
      if (fitted && !straight && !kept.at(column, row))
        give({near, count}, input, same, column, row, fits);
    });
  }
}

void BentFaces::refit(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
                      BlockFits& fits) {
  found_.resize(tiles_.set(fits.grid, input.table));
  faces_.resize(found_.size());
  tiles_.for_rows(1, [&](int row) { find(input, noise, kept, fits, row); });
  tiles_.for_rows(1, [&](int row) { share(input, noise, kept, row, fits); });
}

}  // namespace palpate::depth
