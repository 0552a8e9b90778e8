#pragma once

// Up to 64 blocks of one row on their way through the fits. In an anonymous namespace: see
// windows.inl.

#include <cmath>

#include "depth/simd/windows.inl"

namespace palpate::simd {
namespace {

constexpr int kChunk = 64;
constexpr int kBentSizes = 4;  // quadratic fits up to 2/3 r_max: cubic terms would bias larger ones

enum Kind : int { kNone, kAffine, kQuadratic };

struct Chunk {
  int count;
  const std::int32_t* columns;  // of the image
  double rho[kChunk];           // measured, in kRhoUnits
  double variance[kChunk];      // of it
  float slope_x[kChunk];        // first guesses, as in BlockFits
  float slope_y[kChunk];
  float reach_u[kChunk];  // blocks from the middle to the border of the largest window
  float reach_v[kChunk];
  float lever_u[kChunk];  // a quarter of r_max, in blocks
  float lever_v[kChunk];
  int half_u[kSizes][kChunk];
  int half_v[kSizes][kChunk];
  // The window that serves best so far: middle relative to the block, half sizes.
  Kind kind[kChunk];
  int shift_u[kChunk];
  int shift_v[kChunk];
  int best_u[kChunk];
  int best_v[kChunk];
  bool edge[kChunk];
};

// The window's sizes from a quarter of its largest reach on.
inline void round_sizes(Chunk& c) {
  const auto half = [](float reach) {
    const int rounded = static_cast<int>(reach + .5F);
    return rounded < 1 ? 1 : rounded > kLargestWindow ? kLargestWindow : rounded;
  };
  for (int k = 0; k < kSizes; ++k) {
    for (int i = 0; i < c.count; ++i) {
      c.half_u[k][i] = half(kRatios[k] * c.reach_u[i]);
      c.half_v[k][i] = half(kRatios[k] * c.reach_v[i]);
    }
  }
}

// Largest windows: what noise and wanted error ask for, in blocks foreshortened as the slopes
// tell.
inline void size_windows(const FitInput& in, int row, Chunk& c) {
  constexpr float kSide = .88F;  // a square with the second moments of a disc
  const auto y = static_cast<float>(in.y0 + row * in.step_y);
  const auto step_x = static_cast<float>(in.step_x);
  const auto step_y = static_cast<float>(in.step_y);
  const float pixel = .25F * (step_x + step_y);
  const auto n0 = static_cast<float>(in.pixel_noise[0]);
  const auto n1 = static_cast<float>(in.pixel_noise[1]);
  const auto n2 = static_cast<float>(in.pixel_noise[2]);
  const auto growth = static_cast<float>(in.growth);
  const auto per_error = static_cast<float>(1.6 / in.normal_error);
  for (int i = 0; i < c.count; ++i) {
    const int column = c.columns[i];
    const auto x = static_cast<float>(in.x0 + column * in.step_x);
    const float rho = in.blocks.rho[row * in.blocks.stride + column];
    const float z = 1 / rho;
    const float a = c.slope_x[i] * z;
    const float b = c.slope_y[i] * z;
    const float ax = 1 - a * x;
    const float by = 1 - b * y;
    const float pitch_u = step_x * std::sqrt(ax * ax + a * a * (y * y + 1));  // per z
    const float pitch_v = step_y * std::sqrt(by * by + b * b * (x * x + 1));
    const float across = ax - b * y;
    const float cosine = 1 / std::sqrt((a * a + b * b + across * across) * (x * x + y * y + 1));
    const float root = std::sqrt(cosine);
    const float delta = pixel / root;                           // per z
    const float sigma = (n2 + rho * (n1 + rho * n0)) * z;       // of z, per z
    float reach = std::sqrt(per_error * sigma * pixel * root);  // per z
    reach = reach < 6 * delta ? 6 * delta : reach;
    reach = reach > 18 * delta ? 18 * delta : reach;
    reach *= growth;
    c.reach_u[i] = kSide * reach / pitch_u;
    c.reach_v[i] = kSide * reach / pitch_v;
    c.lever_u[i] = .25F * reach / pitch_u;
    c.lever_v[i] = .25F * reach / pitch_v;
  }
  round_sizes(c);
}

inline void start(const FitInput& in, int row, const FitRow& plain, Chunk& c) {
  for (int i = 0; i < c.count; ++i) {
    const std::ptrdiff_t at = row * in.blocks.stride + c.columns[i];
    const double rho = static_cast<double>(in.blocks.rho[at]);
    const double sigma = in.noise[2] + rho * (in.noise[1] + rho * in.noise[0]);
    const double variance = kRhoUnits * kRhoUnits * sigma * sigma * 4 / in.blocks.counts[at];
    c.rho[i] = kRhoUnits * rho;
    c.variance[i] = variance > 1. / 12 ? variance : 1. / 12;
    c.slope_x[i] = plain.slope_x[c.columns[i]];
    c.slope_y[i] = plain.slope_y[c.columns[i]];
    c.kind[i] = kNone;
    c.shift_u[i] = c.shift_v[i] = c.best_u[i] = c.best_v[i] = 0;
    c.edge[i] = false;
  }
}

}  // namespace
}  // namespace palpate::simd
