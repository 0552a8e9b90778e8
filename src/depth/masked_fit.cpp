#include "depth/masked_fit.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::depth {
namespace {

constexpr int kReach = 2;
constexpr int kEnough = 5;   // blocks
constexpr float kGuard = 4;  // deviations between the plane and the block

// Relative to the block, in blocks.
struct Sums {
  float n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0, r = 0, ur = 0, vr = 0;

  void add(float du, float dv, float d) {
    n += 1;
    u += du;
    v += dv;
    uu += du * du;
    uv += du * dv;
    vv += dv * dv;
    r += d;
    ur += du * d;
    vr += dv * d;
  }
};

Sums gather(const Blocks& blocks, const SameSurface& same, int column, int row) {
  const float rho = blocks.rho[blocks.at(column, row)];
  Sums s;
  for (int dv = -kReach; dv <= kReach; ++dv) {
    for (int du = -kReach; du <= kReach; ++du) {
      const float other = blocks.rho[blocks.at(column + du, row + dv)];
      const auto distance = static_cast<float>(std::max(std::abs(du), std::abs(dv)));
      if (!(other > 0) || std::abs(other - rho) > same.limit(rho, distance)) continue;
      s.add(static_cast<float>(du), static_cast<float>(dv), other - rho);
    }
  }
  return s;
}

}  // namespace

void fit_masked(const Blocks& blocks, const SameSurface& same, int column, int row,
                BlockFits& fits) {
  const std::size_t from = blocks.at(column, row);
  const std::size_t to = fits.grid.index(column, row);
  const float sigma = block_sigma(same.noise, blocks.rho[from]);
  const float own = sigma * sigma * 4 / static_cast<float>(blocks.counts[from]);
  fits.rho[to] = blocks.rho[from];
  fits.variance[to] = own;
  fits.slope_x[to] = fits.slope_y[to] = fits.slope_variance[to] = fits.confidences[to] = 0;
  const Sums s = gather(blocks, same, column, row);
  const float uu = s.uu - s.u * s.u / s.n;
  const float uv = s.uv - s.u * s.v / s.n;
  const float vv = s.vv - s.v * s.v / s.n;
  const float determinant = uu * vv - uv * uv;
  if (s.n < kEnough || !(determinant > 0.05F * uu * vv)) return;
  const float ur = s.ur - s.u * s.r / s.n;
  const float vr = s.vr - s.v * s.r / s.n;
  const float slope_u = (vv * ur - uv * vr) / determinant;
  const float slope_v = (uu * vr - uv * ur) / determinant;
  const float off = (s.r - slope_u * s.u - slope_v * s.v) / s.n;
  const auto per_x = static_cast<float>(1 / fits.grid.step_x);
  const auto per_y = static_cast<float>(1 / fits.grid.step_y);
  fits.slope_x[to] = slope_u * per_x;
  fits.slope_y[to] = slope_v * per_y;
  const float spread = std::max(vv * per_x * per_x, uu * per_y * per_y) / determinant;
  const float variance =
      sigma * sigma * static_cast<float>(shared_error(same.noise.correlation, 1, s.n));
  fits.slope_variance[to] = variance * spread;
  fits.confidences[to] = 1;
  if (off * off > kGuard * kGuard * own) return;
  const float lever =
      (s.u * s.u * vv - 2 * s.u * s.v * uv + s.v * s.v * uu) / (s.n * s.n * determinant);
  fits.rho[to] += off;
  fits.variance[to] = variance * (1 / s.n + lever);
}

}  // namespace palpate::depth
