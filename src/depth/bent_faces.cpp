// Gives bent blocks the quadric that explains most of what is around them.
#include "depth/bent_faces.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/parallel.hpp"

namespace palpate::depth {
namespace {

constexpr int kBentTile = 8;  // blocks of a tile; the one in the middle looks (judgement)
static_assert(kBentTile % KeptTiles::kSide == 0);

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
  const int row = std::min(tile_row * kBentTile + kBentTile / 2, fits.grid.rows - 1);
  const int v = row - input.table.first_row;
  for (int tile = 0; tile < columns_; ++tile) {
    const int column = std::min(tile * kBentTile + kBentTile / 2, fits.grid.columns - 1);
    const int u = column - input.table.first_column;
    const std::size_t place = static_cast<std::size_t>(tile_row) * columns_ + tile;
    if (kept.at(column, row) && is_bent(fits, fits.grid.index(column, row))) continue;
    found_[place] = 0;
    const bool inside = u >= 0 && u < input.table.columns && v >= 0 && v < input.table.rows;
    if (!inside || !is_bent(fits, fits.grid.index(column, row))) continue;
    const auto face = fit_quadric(input, noise, fits, column, row);
    if (!face || !knows_more(*face, fits)) continue;
    faces_[place] = *face;
    found_[place] = 1;
  }
}

// Bent blocks of each tile of a row take the quadric that they lie on and that explains most, the
// first of equals. The surer one would be a bad choice: a strip of another surface makes it so.
void BentFaces::share(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
                      int tile_row, BlockFits& fits) const {
  constexpr int kAround = kLargestReach / kBentTile + 1;  // tiles
  const int top = std::max(tile_row - kAround, 0);
  const int bottom = std::min(tile_row + kAround, rows_ - 1);
  for (int tile = 0; tile < columns_; ++tile) {
    const Quadric* near[(2 * kAround + 1) * (2 * kAround + 1)];
    std::size_t count = 0;
    const int right = std::min(tile + kAround, columns_ - 1);
    for (int r = top; r <= bottom; ++r) {
      for (int c = std::max(tile - kAround, 0); c <= right; ++c) {
        const std::size_t place = static_cast<std::size_t>(r) * columns_ + c;
        if (found_[place]) near[count++] = &faces_[place];
      }
    }
    std::sort(near, near + count, [](const Quadric* a, const Quadric* b) {
      return a->support > b->support || (a->support == b->support && a < b);
    });
    for (int k = 0; count > 0 && k < kBentTile * kBentTile; ++k) {
      const int column = tile * kBentTile + k % kBentTile;
      const int row = tile_row * kBentTile + k / kBentTile;
      if (column >= fits.grid.columns || row >= fits.grid.rows) continue;
      if (!is_bent(fits, fits.grid.index(column, row)) || kept.at(column, row)) continue;
      const float rho = input.blocks.rho[row * input.blocks.stride + column];
      give({near, count}, rho, block_sigma(noise, rho), column, row, fits);
    }
  }
}

void BentFaces::refit(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
                      BlockFits& fits) {
  columns_ = (fits.grid.columns + kBentTile - 1) / kBentTile;
  rows_ = (fits.grid.rows + kBentTile - 1) / kBentTile;
  found_.resize(static_cast<std::size_t>(columns_) * rows_);
  faces_.resize(found_.size());
  detail::parallel_each(static_cast<std::size_t>(rows_), 1, [&](std::size_t tile_row) {
    find(input, noise, kept, fits, static_cast<int>(tile_row));
  });
  detail::parallel_each(static_cast<std::size_t>(rows_), 1, [&](std::size_t tile_row) {
    share(input, noise, kept, static_cast<int>(tile_row), fits);
  });
}

}  // namespace palpate::depth
