#pragma once

#include <cstdint>
#include <span>

namespace palpate {

/// 16-bit depth, as cameras, drivers and files give it, in metres, as a DepthFrame holds it:
///
///   frame.depth.resize(samples.size());
///   to_metres(samples, 1e-3, frame.depth);  // millimetres
///
/// `unit`: metres a step. 0 and 65535 become 0: nothing was measured there, or it was too far to
/// tell. Other values that a sensor marks such pixels with are to be made 0 before. Takes no
/// memory; any thread; a row at a time where rows do not follow one another in memory.
/// @throws Error when the unit is not finite or not above 0, or the two differ in size.
void to_metres(std::span<const std::uint16_t> samples, double unit, std::span<float> depth);

}  // namespace palpate
