// Gives bent blocks the quadric that explains most of what is around them.
#include "depth/bent_faces.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace palpate::depth {
namespace {

// Are its slopes at its own block not much vaguer than the window's? Few rows of blocks tell
// little.
bool knows_more(const Quadric& face, const BlockFits& fits) {
  const BlockGrid& grid = fits.grid;
  const std::size_t i = grid.index(face.column, face.row);
  const auto own = face.at(0, 0);
  const double x = grid.step_x;
  const double y = grid.step_y;
  const double most = kLessSure * fits.slope_variance[i] * std::min(x * x, y * y);
  return own && (fits.confidences[i] == 0 || own->slope_variance <= most);
}

// Are its slopes those that a block's window tells, within four deviations?
bool agrees(const Quadric::Sight& sight, const BlockFits& fits, std::size_t i) {
  if (fits.confidences[i] == 0) return true;
  const double x = fits.grid.step_x;
  const double y = fits.grid.step_y;
  const double u = sight.x - fits.slope_x[i] * x;
  const double v = sight.y - fits.slope_y[i] * y;
  const double variance = sight.slope_variance + fits.slope_variance[i] * std::max(x * x, y * y);
  return std::max(u * u, v * v) <= kOffFace * variance;
}

// Gives a block the first of some quadrics that it lies on.
void give(std::span<const Quadric* const> faces, float rho, double sigma, int column, int row,
          BlockFits& fits) {
  const double square = kOffFace * sigma * sigma;
  const std::size_t i = fits.grid.index(column, row);
  for (const Quadric* face : faces) {
    const int u = column - face->column;
    const int v = row - face->row;
    if (std::abs(u) > face->reach || std::abs(v) > face->reach) continue;
    if (!face->holds(u, v, rho, square)) continue;
    const auto sight = face->at(u, v);
    if (!sight || !(sight->variance > 0 && sight->slope_variance > 0)) continue;
    const double off = sight->rho - rho;
    if (off * off > square || !agrees(*sight, fits, i)) continue;
    fits.set(i, sight->rho, sight->variance, sight->x, sight->y, sight->slope_variance);
    return;
  }
}

}  // namespace

void BentFaces::find(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
                     const BlockFits& fits, int tile_row) {
  const simd::WindowTable& table = input.table;
  const BlockRange range{table.first_column, table.first_row, table.columns, table.rows};
  tiles_.each_middle(fits.grid, tile_row, [&](std::size_t place, int column, int row) {
    const bool bent = is_bent(fits, fits.grid.index(column, row));
    if (bent && kept.at(column, row)) return;  // it was fitted last time
    found_[place] = 0;
    if (!bent || !range.overlaps({column, row, 1, 1})) return;
    const auto face = fit_quadric(input, noise, fits, column, row);
    if (!face || !knows_more(*face, fits)) return;
    faces_[place] = *face;
    found_[place] = 1;
  });
}

// Bent blocks of each tile of a row take the quadric that they lie on and that explains most, the
// first of equals. The surer one would be a bad choice: a strip of another surface makes it so.
void BentFaces::share(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
                      int tile_row, BlockFits& fits) const {
  const auto takes = [&](int column, int row) {
    return is_bent(fits, fits.grid.index(column, row)) && !kept.at(column, row);
  };
  for (int tile = 0; tile < tiles_.columns; ++tile) {
    bool any = false;
    tiles_.each_block(fits.grid, tile, tile_row,
                      [&](int column, int row) { any |= takes(column, row); });
    if (!any) continue;
    const Quadric* near[(2 * kAround + 1) * (2 * kAround + 1)];
    std::size_t count = 0;
    tiles_.each_near(tile, tile_row, [&](std::size_t place) {
      if (found_[place]) near[count++] = &faces_[place];
    });
    if (count == 0) continue;
    std::sort(near, near + count, [](const Quadric* a, const Quadric* b) {
      return a->support > b->support || (a->support == b->support && a < b);
    });
    tiles_.each_block(fits.grid, tile, tile_row, [&](int column, int row) {
      if (!takes(column, row)) return;
      const float rho = input.blocks.rho[row * input.blocks.stride + column];
      give({near, count}, rho, block_sigma(noise, rho), column, row, fits);
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
