#pragma once

// Sums over what is around blocks, eight blocks side by side. Everything stands in an anonymous
// namespace: code for a newer processor must never stand in for an older one's.

#include <cmath>
#include <cstring>

#include "stream/simd/rims.hpp"

namespace palpate::simd {
namespace {

typedef float Floats __attribute__((vector_size(kRimLanes * sizeof(float))));
typedef std::int32_t Ints __attribute__((vector_size(kRimLanes * sizeof(std::int32_t))));

template <class Lanes, class T>
[[gnu::always_inline]] inline Lanes load(const T* from) {
  Lanes v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

// Eqs. (1) and (2) (field/formulas.hpp) of q = r^2 below 1.
template <bool kWendland>
[[gnu::always_inline]] inline Floats weight(const Floats& q) {
  if constexpr (kWendland) {
    Floats r;
    for (int l = 0; l < kRimLanes; ++l) r[l] = std::sqrt(q[l]);
    const Floats s = 1 - r;
    return (s * s) * (s * s) * (4 * r + 1);
  }
  const Floats s = 1 - q;
  return s * s * (5 + 4 * s) * (1.F / 9);
}

template <bool kWendland>
[[gnu::always_inline]] inline Floats sum(const Surroundings& blocks, const Ints& halves) {
  int largest = 0;
  for (int l = 0; l < kRimLanes; ++l) largest = halves[l] > largest ? halves[l] : largest;
  const auto x = load<Floats>(blocks.x);
  const auto y = load<Floats>(blocks.y);
  const auto z = load<Floats>(blocks.z);
  Floats total{};
  for (int v = -largest; v <= largest; ++v) {
    for (int u = -largest; u <= largest; ++u) {
      const std::ptrdiff_t at = v * blocks.stride + u;
      const Floats dx = load<Floats>(blocks.x + at) - x;
      const Floats dy = load<Floats>(blocks.y + at) - y;
      const Floats dz = load<Floats>(blocks.z + at) - z;
      const Floats q = (dx * dx + dy * dy + dz * dz) * load<Floats>(blocks.per_r2 + at);
      const Floats w = weight<kWendland>(q) * load<Floats>(blocks.factors + at);
      const Ints inside = (q < 1) & (halves >= std::abs(u)) & (halves >= std::abs(v));
      total += inside ? w : Floats{};
    }
  }
  return total;
}

void around(const Surroundings& blocks, bool wendland, const std::int32_t* halves,
            float* sums) noexcept {
  const auto reach = load<Ints>(halves);
  const Floats total = wendland ? sum<true>(blocks, reach) : sum<false>(blocks, reach);
  std::memcpy(sums, &total, sizeof total);
}

}  // namespace
}  // namespace palpate::simd
