#pragma once

#include "base/description.hpp"
#include "palpate/scene/source.hpp"

/// The descriptions of the options of sources.
namespace palpate {

// In the order in which help and errors list them.
inline constexpr std::array<Named<Policy>, 4> kPolicies = {{{"replace", Policy::replace},
                                                            {"average", Policy::average},
                                                            {"crossfade", Policy::crossfade},
                                                            {"morph", Policy::morph}}};
[[nodiscard]] constexpr const auto& choices(Policy /*of*/) {
  return kPolicies;
}

template <EitherConst<PolicyOptions> Options>
void describe(Options& options, const auto& take) {
  using enum Offered;
  auto& [policy, history, silence, fade, fits, clips] = options;
  take(About{"policy",
             "",
             {},
             "how successive frames update the surface: replace (hard swap), average (of N frames, "
             "as in the paper), crossfade or morph (default for depth cameras)"},
       policy);
  // A snapshot has room for the N and the newest.
  take(About{"history",
             "",
             {.least = 1, .most = static_cast<double>(Snapshot::kMaxLayers) - 1},
             "number of frames N for average and crossfade, 1 to 7 (4)",
             everywhere,
             "N"},
       history);
  take(About{"silence", "s", kPositive, "fade a surface after this long without new data (0.3)"},
       silence);
  take(About{"fade", "s", kPositive, "duration of that fade (0.5)"}, fade);
  take(About{"fit_everywhere",
             "",
             {},
             "run the depth filter's costly part on the whole image, not only where the tool can "
             "be before the next frame",
             files},
       fits);
  take(About{"clip_to_reach",
             "",
             {},
             "for frames processed as clouds: prepare only what the tool can reach before the next "
             "frame, as in the paper. Live, that begins once surfaces come 0.1 s late"},
       clips);
}

}  // namespace palpate
