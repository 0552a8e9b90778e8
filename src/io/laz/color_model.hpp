// Decodes colours of LAZ points.
#pragma once

#include <array>
#include <cstdint>

#include "io/laz/range_decoder.hpp"

namespace palpate::io::laz {

using Color = std::array<std::uint16_t, 3>;

class ColorModel {
 public:
  /// The colour that follows `last`. Red is coded as its difference to the last red, by bytes;
  /// green is expected to change as red did, and blue as both did.
  Color decode(RangeDecoder& in, const Color& last) {
    const std::uint32_t changed = in.symbol(changed_);
    std::array<int, 3> low{last[0] & 255, last[1] & 255, last[2] & 255};
    std::array<int, 3> high{last[0] >> 8, last[1] >> 8, last[2] >> 8};
    const std::array<int, 2> red{low[0], high[0]};
    if ((changed & 1U) != 0) low[0] = add(in, 0, low[0]);
    if ((changed & 2U) != 0) high[0] = add(in, 1, high[0]);
    if ((changed & 64U) == 0) {
      low[1] = low[2] = low[0];
      high[1] = high[2] = high[0];
    } else {
      follow(in, changed >> 2U, 2, low[0] - red[0], low);
      follow(in, changed >> 3U, 3, high[0] - red[1], high);
    }
    Color color;
    for (std::size_t k = 0; k < 3; ++k)
      color[k] = static_cast<std::uint16_t>(high[k] << 8 | low[k]);
    return color;
  }

 private:
  int add(RangeDecoder& in, std::size_t model, int expected) {
    return static_cast<int>(in.symbol(differences_[model]) + static_cast<unsigned>(expected)) & 255;
  }

  // Green and blue of one half, where red has changed by `step`.
  void follow(RangeDecoder& in, std::uint32_t changed, std::size_t model, int step,
              std::array<int, 3>& half) {
    const int green = half[1];
    if ((changed & 1U) != 0) half[1] = add(in, model, std::clamp(green + step, 0, 255));
    if ((changed & 4U) == 0) return;
    step = (step + half[1] - green) / 2;
    half[2] = add(in, model + 2, std::clamp(half[2] + step, 0, 255));
  }

  SymbolModel changed_{128};
  // Red low and high, green low and high, blue low and high.
  std::array<SymbolModel, 6> differences_ = symbol_models<6>(256);
};

}  // namespace palpate::io::laz
