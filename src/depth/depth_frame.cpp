#include "palpate/depth/depth_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr std::uint16_t kTooFar = 65535;

}  // namespace

void to_metres(std::span<const std::uint16_t> samples, double unit, std::span<float> depth) {
  if (!(unit > 0 && std::isfinite(unit))) {
    throw Error(fmt::format(
        "16-bit depth: invalid unit of {} m; give the metres per step, e.g. 0.001 for millimetres",
        unit));
  }
  if (samples.size() != depth.size()) {
    throw Error(fmt::format("16-bit depth: {} samples for {} depths; give the same number of both",
                            samples.size(), depth.size()));
  }
  std::ranges::transform(samples, depth.begin(), [unit](std::uint16_t sample) {
    return sample == kTooFar ? 0.0F : static_cast<float>(unit * sample);
  });
}

}  // namespace palpate
