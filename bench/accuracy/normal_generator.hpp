#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace palpate::accuracy {

/// Random numbers that are the same with every standard library: its engines are specified, its
/// distributions are not.
class NormalGenerator {
 public:
  explicit NormalGenerator(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in (0, 1).
  [[nodiscard]] double uniform() {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
    return (static_cast<double>(engine_() >> 11) + 0.5) * kUnit;
  }

  /// Mean 0, variance 1 (Box and Muller 1958).
  [[nodiscard]] double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2 * std::log(uniform()));
    const double angle = 2 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace palpate::accuracy
