// Decodes coordinates of LAZ points.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "io/laz/range_decoder.hpp"

namespace palpate::io::laz {

/// Models of x, y and z that all point formats share. Each is chosen by whether a pulse gave a
/// `single` return and by how large the errors before it were.
class XyzModel {
 public:
  void decode_xy(RangeDecoder& in, bool single, RunningMedian& step_x, RunningMedian& step_y,
                 std::array<std::int32_t, 3>& number) {
    move(x_, in, single ? 1 : 0, step_x, number[0]);
    move(y_, in, context(x_.size(), 20, single), step_y, number[1]);
  }

  /// After decode_xy() of the same point.
  [[nodiscard]] std::int32_t decode_z(RangeDecoder& in, bool single, std::int32_t prediction) {
    return static_cast<std::int32_t>(z_.decode(in, static_cast<std::uint32_t>(prediction),
                                               context((x_.size() + y_.size()) / 2, 18, single)));
  }

 private:
  static std::size_t context(std::uint32_t size, std::uint32_t most, bool single) {
    return (std::min(size, most) & ~1U) + (single ? 1U : 0U);
  }

  static void move(NumberModel& model, RangeDecoder& in, std::size_t context, RunningMedian& median,
                   std::int32_t& number) {
    const std::uint32_t step =
        model.decode(in, static_cast<std::uint32_t>(median.value()), context);
    number = static_cast<std::int32_t>(static_cast<std::uint32_t>(number) + step);
    median.add(static_cast<std::int32_t>(step));
  }

  NumberModel x_{32, 2};
  NumberModel y_{32, 22};
  NumberModel z_{32, 20};
};

}  // namespace palpate::io::laz
