#include "io/swapped.hpp"

#include <cstdint>
#include <cstdlib>

namespace palpate::io {
namespace {

constexpr std::size_t kEveryRow = 4;  // one row in four tells enough
// Swapped images of real sensors are 20 to 100 times rougher than right ones.
constexpr std::uint64_t kRougher = 4;
constexpr std::uint64_t kFewest = 32;  // steps to judge by

std::uint16_t exchanged(std::uint16_t v) {
  return static_cast<std::uint16_t>((v >> 8U) | (v << 8U));
}

std::uint64_t step(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint64_t>(std::abs(static_cast<int>(a) - static_cast<int>(b)));
}

}  // namespace

bool looks_swapped(const DepthImage& image) {
  std::uint64_t steps = 0;
  std::uint64_t fine = 0;  // samples that are more than a count of 256
  std::uint64_t as_read = 0;
  std::uint64_t as_exchanged = 0;
  for (std::size_t row = 0; row < image.height; row += kEveryRow) {
    const std::uint16_t* samples = image.samples.data() + row * image.width;
    for (std::size_t i = 1; i < image.width; ++i) {
      const std::uint16_t a = samples[i - 1];
      const std::uint16_t b = samples[i];
      if (a == 0 || b == 0 || a == 65535 || b == 65535) continue;
      ++steps;
      fine += (b & 0xffU) != 0 ? 1 : 0;
      as_read += step(a, b);
      as_exchanged += step(exchanged(a), exchanged(b));
    }
  }
  // Whole counts of 256 are coarse, and look smooth either way.
  return steps >= kFewest && 2 * fine > steps && as_read > kRougher * as_exchanged;
}

void swap_bytes(DepthImage& image) {
  for (std::uint16_t& sample : image.samples) sample = exchanged(sample);
}

}  // namespace palpate::io
