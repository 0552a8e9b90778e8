// What counts as a jump, a fall or a softer spring: of a point and of a tool that turns alike.
#pragma once

#include "palpate/contact/proxy.hpp"

namespace palpate {

struct Limit {
  /// The proxy has not caught up with the hand.
  static constexpr ContactNote kUnfinished =
      ContactNote::sweep_truncated | ContactNote::not_converged;
  static constexpr double kFastest =
      1;                                ///< m/s: a surface that moves faster has jumped (judgement)
  static constexpr double kFall = 0.5;  ///< of the stretch, the least that is noted (judgement)
  static constexpr double kLeastFall = 0.01;  ///< of R: what iterations leave open is no jump
  static constexpr double kHardest =
      10;  ///< N in free air: desktop devices sustain less (judgement)
  static constexpr double kFar =
      10;  ///< of R, from the proxy, for which a hand is away (judgement)
  static constexpr double kGone = 0.002;       ///< of the stiffness that fades: 3 mN of 1.5 N
  static constexpr double kMuchSofter = 0.95;  ///< of the wanted one; less is felt (judgement)
};

}  // namespace palpate
