#pragma once

#include <span>

#include "depth/noise_bins.hpp"
#include "palpate/depth/noise_model.hpp"

namespace palpate::depth {

/// sigma(z) = s0 + s1 z + s2 z^2 through samples, robust against single wrong ones; relative errors
/// count. Fewer terms where the samples span little depth, `prior` times a factor where they span
/// next to none. Positive at all depths, and it neither vanishes before the nearest sample nor
/// falls behind the farthest. Keeps the prior's correlation. No samples: the prior.
[[nodiscard]] NoiseModel fit_noise_curve(std::span<const NoiseSample> samples,
                                         const NoiseModel& prior);

}  // namespace palpate::depth
