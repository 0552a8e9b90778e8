// Provides the degree, and random numbers that are the same on every platform.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace palpate {

inline constexpr double kDegree = std::numbers::pi / 180;  ///< rad

/// SplitMix64 (Steele, Lea, Flood 2014). The standard library's distributions differ from one
/// implementation to another; the same seed has to give the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Even over all 64-bit numbers.
  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// Even in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  /// Normal with mean 0 and deviation 1 (Box and Muller).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace palpate
