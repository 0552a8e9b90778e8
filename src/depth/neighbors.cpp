#include "depth/neighbors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::depth {
namespace {

constexpr double kSteepest =
    2.75;  // tangent of the incidence up to which neighbours count as close
constexpr int kSupporters = 2;
constexpr float kStraight = 7.3F;  // 3 sigma of a - 2 b + c

// Offsets of the eight neighbours; opposite ones are four apart.
std::array<std::ptrdiff_t, 8> offsets(const Blocks& blocks) {
  const auto row = static_cast<std::ptrdiff_t>(blocks.stride);
  return {1, row + 1, row, row - 1, -1, -row - 1, -row, -row + 1};
}
constexpr std::array<float, 8> kU{1, 1, 0, -1, -1, -1, 0, 1};
constexpr std::array<float, 8> kV{0, 1, 1, 1, 0, -1, -1, -1};

int supporters(const float* rho, const std::array<std::ptrdiff_t, 8>& around, float close,
               float straight) {
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    const float a = rho[around[i]];
    const float b = rho[around[i + 4]];
    const bool has_a = a > 0;
    const bool has_b = b > 0;
    const bool line = has_a && has_b && std::abs(a - 2 * *rho + b) <= straight;
    count += line ? 2
                  : int(has_a && std::abs(a - *rho) <= close) +
                        int(has_b && std::abs(b - *rho) <= close);
  }
  return count;
}

// Sums over the same surface in the 3x3 blocks around one, relative to it.
struct Sums {
  float n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0, r = 0, ur = 0, vr = 0;
};
Sums gather(const float* rho, const std::array<std::ptrdiff_t, 8>& around, float close) {
  Sums s;
  s.n = 1;
  for (int i = 0; i < 8; ++i) {
    const float d = rho[around[i]] - *rho;
    if (!(rho[around[i]] > 0) || std::abs(d) > close) continue;
    s.n += 1;
    s.u += kU[i];
    s.v += kV[i];
    s.uu += kU[i] * kU[i];
    s.uv += kU[i] * kV[i];
    s.vv += kV[i] * kV[i];
    s.r += d;
    s.ur += kU[i] * d;
    s.vr += kV[i] * d;
  }
  return s;
}

struct Slopes {
  float u = 0, v = 0;  // per block
  float variance = 0;  // in units of a block's
  float confidence = 0;
};
Slopes solve(const Sums& s) {
  const float uu = s.uu - s.u * s.u / s.n;
  const float uv = s.uv - s.u * s.v / s.n;
  const float vv = s.vv - s.v * s.v / s.n;
  const float determinant = uu * vv - uv * uv;
  if (!(determinant > .3F)) return {};  // on one line
  const float ur = s.ur - s.u * s.r / s.n;
  const float vr = s.vr - s.v * s.r / s.n;
  return {(vv * ur - uv * vr) / determinant, (uu * vr - uv * ur) / determinant,
          std::max(uu, vv) / determinant, std::clamp((s.n - 2) / 4, 0.0F, 1.0F)};
}

}  // namespace

SameSurface::SameSurface(const NoiseModel& noise_model, const BlockGrid& grid)
    : noise(noise_model),
      steep(
          static_cast<float>(kSteepest * std::max(std::abs(grid.step_x), std::abs(grid.step_y)))) {}

void reject_flying(const NoiseModel& noise, Blocks& blocks, std::vector<float>& scratch) {
  const SameSurface same(noise, blocks.grid);
  const auto around = offsets(blocks);
  scratch = blocks.rho;
  for (int row = 0; row < blocks.grid.rows; ++row) {
    for (int column = 0; column < blocks.grid.columns; ++column) {
      const std::size_t i = blocks.at(column, row);
      const float rho = scratch[i];
      if (rho <= 0) continue;
      const float straight = kStraight * block_sigma(noise, rho);
      if (supporters(&scratch[i], around, same.limit(rho), straight) >= kSupporters) continue;
      blocks.rho[i] = 0;
      blocks.counts[i] = 0;
    }
  }
}

void fit_plain(const Blocks& blocks, const NoiseModel& noise, BlockFits& fits) {
  const SameSurface same(noise, blocks.grid);
  const auto around = offsets(blocks);
  const auto per_x = static_cast<float>(1 / blocks.grid.step_x);
  const auto per_y = static_cast<float>(1 / blocks.grid.step_y);
  const float steepest = std::max(per_x * per_x, per_y * per_y);
  std::size_t to = 0;
  for (int row = 0; row < blocks.grid.rows; ++row) {
    for (int column = 0; column < blocks.grid.columns; ++column, ++to) {
      const std::size_t i = blocks.at(column, row);
      const float rho = blocks.rho[i];
      fits.states[to] = rho > 0 ? BlockState::plain : BlockState::empty;
      if (rho <= 0) continue;
      const float sigma = block_sigma(noise, rho);
      const Slopes slopes = solve(gather(&blocks.rho[i], around, same.limit(rho)));
      fits.rho[to] = rho;
      fits.variance[to] = sigma * sigma * 4 / float(blocks.counts[i]);
      fits.slope_x[to] = slopes.u * per_x;
      fits.slope_y[to] = slopes.v * per_y;
      fits.slope_variance[to] = sigma * sigma * slopes.variance * steepest;
      fits.confidences[to] = slopes.confidence;
    }
  }
}

}  // namespace palpate::depth
