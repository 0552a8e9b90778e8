#pragma once

#include <optional>

namespace palpate {

/// How clouds that follow one another become one surface in time (docs/architecture.md).
enum class Policy {
  replace,    ///< the newest cloud, at once (hard swap)
  average,    ///< the newest N clouds, 1/N each (the paper)
  crossfade,  ///< N + 1 clouds; the newest fades in while the oldest fades out
  fusion,     ///< a running mean in voxels that moves in straight lines
  morph,      ///< blocks of a depth image, filtered in time and by the noise-sized fit
};

/// What stands for a policy that is not set.
inline constexpr Policy kDepthPolicy = Policy::morph;      ///< of depth frames
inline constexpr Policy kCloudPolicy = Policy::crossfade;  ///< of clouds

struct PolicyOptions {
  std::optional<Policy> policy = {};  ///< unset: kDepthPolicy or kCloudPolicy
  int history = 4;       ///< N of `average` and `crossfade`, 1 to 7; unset by `replace`, `morph`
  double silence = 0.3;  ///< a surface that nothing confirmed for so long begins to fade, s
  double fade = 0.5;     ///< in which it fades away, s
  bool fit_everywhere = false;  ///< run the depth filter's fit outside the fields' reach as well
  bool clip_to_reach = false;   ///< leave out points of clouds that no tool can come to before the
                                ///< next ones (the paper's section IV-B)
};

}  // namespace palpate
