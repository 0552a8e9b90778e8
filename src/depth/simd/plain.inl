#pragma once

// Block means and those of their neighbours, eight blocks side by side. Everything stands in an
// anonymous namespace: code for a newer processor must never stand in for an older one's.

#include <cmath>
#include <cstring>

#include "depth/simd/fits.hpp"

namespace palpate::simd {
namespace {

constexpr int kLanes = kPlainLanes;  // blocks side by side
typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));
typedef std::int32_t Ints __attribute__((vector_size(kLanes * sizeof(std::int32_t))));
typedef std::uint8_t Bytes __attribute__((vector_size(kLanes)));

[[gnu::always_inline]] inline Floats load(const float* from) {
  Floats v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
[[gnu::always_inline]] inline Floats same(float value) {
  return value - Floats{};
}
[[gnu::always_inline]] inline Floats smaller(const Floats& a, const Floats& b) {
  return a < b ? a : b;
}
[[gnu::always_inline]] inline Floats larger(const Floats& a, const Floats& b) {
  return a > b ? a : b;
}
[[gnu::always_inline]] inline Floats absolute(const Floats& v) {
  return larger(v, -v);
}
[[gnu::always_inline]] inline Floats keep(const Ints& mask, const Floats& v) {
  return mask ? v : Floats{};
}
[[gnu::always_inline]] inline Floats number(const Ints& v) {
  return __builtin_convertvector(v, Floats);
}
[[gnu::always_inline]] inline Ints widened(const std::uint8_t* from) {
  Bytes bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  return __builtin_convertvector(bytes, Ints);
}
[[gnu::always_inline]] inline void store_bytes(std::uint8_t* to, const Ints& v, int count) {
  const Bytes bytes = __builtin_convertvector(v, Bytes);
  std::memcpy(to, &bytes, static_cast<std::size_t>(count));
}
[[gnu::always_inline]] inline void store(float* to, const Floats& v, int count = kLanes) {
  if (count == kLanes) {
    std::memcpy(to, &v, sizeof v);
  } else {
    std::memcpy(to, &v, static_cast<std::size_t>(count) * sizeof(float));
  }
}
[[gnu::always_inline]] inline void sort(Floats& a, Floats& b) {
  const Floats low = smaller(a, b);
  b = larger(a, b);
  a = low;
}

// The four pixels of eight blocks.
struct Pixels {
  Floats z[4];
};

[[gnu::always_inline]] inline Pixels pixels_of(const float* upper, const float* lower) {
  const Floats a = load(upper);
  const Floats b = load(upper + kLanes);
  const Floats c = load(lower);
  const Floats d = load(lower + kLanes);
  return {{__builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14),
           __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15),
           __builtin_shufflevector(c, d, 0, 2, 4, 6, 8, 10, 12, 14),
           __builtin_shufflevector(c, d, 1, 3, 5, 7, 9, 11, 13, 15)}};
}

[[gnu::always_inline]] inline void average_eight(Pixels p, const DepthGate& gate, Floats& rho,
                                                 Ints& count) {
  Ints valid{};
  for (Floats& z : p.z) {
    const Ints is = (z >= gate.nearest) & (z <= gate.farthest);  // neither for NaN
    z = is ? z : same(HUGE_VALF);
    valid -= is;
  }
  sort(p.z[0], p.z[1]);
  sort(p.z[2], p.z[3]);
  sort(p.z[0], p.z[2]);
  sort(p.z[1], p.z[3]);
  sort(p.z[1], p.z[2]);
  const Floats low = valid >= 3 ? p.z[1] : p.z[0];
  const Floats middle = valid >= 2 ? p.z[1] : p.z[0];
  const Floats high = valid == 4 ? p.z[2] : middle;
  const Floats median = .5F * (low + high);
  const Floats width = gate.width[0] + median * (gate.width[1] + median * gate.width[2]);
  Floats sum{};
  count = Ints{};
  for (const Floats& z : p.z) {
    const Ints near = absolute(z - median) <= width;
    sum += keep(near, z);
    count -= near;
  }
  rho = keep(count > 0, number(count) / larger(sum, same(gate.nearest)));
}

void average(const float* pixels, std::ptrdiff_t width, int columns, const DepthGate& gate,
             float* rho, std::uint8_t* counts) noexcept {
  for (int column = 0; column < columns; column += kLanes) {
    const int count = columns - column < kLanes ? columns - column : kLanes;
    const float* upper = pixels + std::ptrdiff_t{2} * column;
    const float* lower = upper + width;
    float rest[2][2 * kLanes] = {};
    if (count < kLanes) {
      const std::size_t bytes = 2 * static_cast<std::size_t>(count) * sizeof(float);
      std::memcpy(rest[0], upper, bytes);
      std::memcpy(rest[1], lower, bytes);
      upper = rest[0];
      lower = rest[1];
    }
    Floats mean;
    Ints used;
    average_eight(pixels_of(upper, lower), gate, mean, used);
    store(rho + column, mean, count);
    store_bytes(counts + column, used, count);
  }
}

[[gnu::always_inline]] inline Floats sigma_of(const BlockLimits& limits, const Floats& rho) {
  return larger(limits.sigma[2] + rho * (limits.sigma[1] + rho * limits.sigma[0]), same(0));
}

void reject(const float* rho, std::ptrdiff_t stride, int columns, const BlockLimits& limits,
            int supporters, float* to, std::uint8_t* counts) noexcept {
  const std::ptrdiff_t opposite[4] = {1, stride + 1, stride, stride - 1};
  for (int column = 0; column < columns; column += kLanes) {
    const int count = columns - column < kLanes ? columns - column : kLanes;
    const float* at = rho + column;
    const Floats own = load(at);
    const Floats sigma = sigma_of(limits, own);
    const Floats close = limits.close * sigma + limits.steep * own;
    const Floats straight = limits.straight * sigma;
    Ints found{};
    for (const std::ptrdiff_t offset : opposite) {
      const Floats a = load(at + offset);
      const Floats b = load(at - offset);
      const Ints has_a = a > 0.0F;
      const Ints has_b = b > 0.0F;
      const Ints line = has_a & has_b & (absolute(a - 2.0F * own + b) <= straight);
      const Ints near_a = has_a & (absolute(a - own) <= close);
      const Ints near_b = has_b & (absolute(b - own) <= close);
      found -= (line | near_a) + (line | near_b);
    }
    const Ints stays = (own > 0.0F) & (found >= supporters);
    store(to + column, keep(stays, own), count);
    store_bytes(counts + column, widened(counts + column) & stays, count);
  }
}

// Sums over those of the neighbours that show the same surface, relative to the block.
struct Sums {
  Floats n, u, v, uu, uv, vv, r, ur, vr;
};

[[gnu::always_inline]] inline Sums gather(const float* at, std::ptrdiff_t stride, const Floats& own,
                                          const Floats& close) {
  Floats is[3][3];
  Floats d[3][3];
  for (int v = 0; v < 3; ++v) {
    for (int u = 0; u < 3; ++u) {
      const Floats other = load(at + (v - 1) * stride + (u - 1));
      const Floats off = other - own;
      const Ints mask = (other > 0.0F) & (absolute(off) <= close);
      is[v][u] = mask ? same(1) : Floats{};
      d[v][u] = keep(mask, off);
    }
  }
  const auto column = [](const Floats(&m)[3][3], int u) { return m[0][u] + m[1][u] + m[2][u]; };
  const auto row = [](const Floats(&m)[3][3], int v) { return m[v][0] + m[v][1] + m[v][2]; };
  const auto corners = [](const Floats(&m)[3][3]) { return m[0][0] + m[2][2] - m[0][2] - m[2][0]; };
  const Floats left = column(is, 0);
  const Floats right = column(is, 2);
  const Floats above = row(is, 0);
  const Floats below = row(is, 2);
  return {left + column(is, 1) + right,
          right - left,
          below - above,
          right + left,
          corners(is),
          below + above,
          row(d, 0) + row(d, 1) + row(d, 2),
          column(d, 2) - column(d, 0),
          row(d, 2) - row(d, 0)};
}

void fit(const float* rho, const std::uint8_t* counts, std::ptrdiff_t stride, int columns,
         const BlockLimits& limits, float per_x, float per_y, const FitRow& out) noexcept {
  constexpr float kOnOneLine = .3F;   // below 1/3, the least determinant off one line (derived)
  constexpr std::uint8_t kPlain = 1;  // FilteredDepth::State::plain
  const float spread = per_x * per_x > per_y * per_y ? per_x * per_x : per_y * per_y;
  for (int column = 0; column < columns; column += kLanes) {
    const int count = columns - column < kLanes ? columns - column : kLanes;
    const Floats own = load(rho + column);
    const Ints measured = own > 0.0F;
    const Floats sigma = sigma_of(limits, own);
    const Sums s = gather(rho + column, stride, own, limits.close * sigma + limits.steep * own);
    const Floats per_n = 1.0F / larger(s.n, same(1));
    const Floats uu = s.uu - s.u * s.u * per_n;
    const Floats uv = s.uv - s.u * s.v * per_n;
    const Floats vv = s.vv - s.v * s.v * per_n;
    const Floats ur = s.ur - s.u * s.r * per_n;
    const Floats vr = s.vr - s.v * s.r * per_n;
    const Floats determinant = uu * vv - uv * uv;
    const Ints determined = measured & (determinant > kOnOneLine);
    const Floats per_determinant = keep(determined, 1.0F / larger(determinant, same(kOnOneLine)));
    const Floats variance = sigma * sigma;
    const Floats pixels = larger(number(widened(counts + column)), same(1));
    const Floats confidence = smaller(.25F * (s.n - 2.0F), same(1));
    store_bytes(out.states + column, measured & int{kPlain}, count);
    store(out.rho + column, own, count);
    store(out.variance + column, variance * 4.0F / pixels, count);
    store(out.slope_x + column, (vv * ur - uv * vr) * per_determinant * per_x, count);
    store(out.slope_y + column, (uu * vr - uv * ur) * per_determinant * per_y, count);
    store(out.slope_variance + column, variance * larger(uu, vv) * per_determinant * spread, count);
    store(out.confidences + column, keep(determined, confidence), count);
  }
}

}  // namespace
}  // namespace palpate::simd
