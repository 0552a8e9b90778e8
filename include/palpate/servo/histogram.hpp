#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace palpate {

/// How long things took, counted in bins that grow geometrically: eight to an octave, from 1/8 us
/// to 17 s. What lies outside counts in the first or the last.
struct Durations {
  static constexpr std::size_t kPerOctave = 8;
  static constexpr std::size_t kBins = 27 * kPerOctave;

  std::array<std::uint64_t, kBins> counts{};
  std::uint64_t count = 0;
  double sum = 0;      ///< s
  double longest = 0;  ///< s

  /// s; what is negative counts as 0, what is not a number is left out.
  void add(double duration) noexcept;

  /// The duration that a share `p` (0-1) of all stays below, to 5 %: the middle of its bin, and
  /// never above the longest. 0 when there are none.
  [[nodiscard]] double quantile(double p) const noexcept;
  [[nodiscard]] double mean() const noexcept {
    return count > 0 ? sum / static_cast<double>(count) : 0;
  }

  /// What came after `earlier` was taken. `longest` stays that of all.
  [[nodiscard]] Durations since(const Durations& earlier) const noexcept;
};

/// Durations that one thread adds to while others look. Lock-free; adding is real-time.
class Histogram {
 public:
  /// s; what is negative counts as 0, what is not a number is left out.
  void add(double duration) noexcept;

  /// What was added until now; a step that is under way may be in some numbers and not in others.
  [[nodiscard]] Durations look() const noexcept;

 private:
  std::array<std::atomic<std::uint64_t>, Durations::kBins> counts_{};
  std::atomic<double> sum_{0};
  std::atomic<double> longest_{0};
};

}  // namespace palpate
