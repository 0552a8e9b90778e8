#pragma once

#include <cstdint>
#include <optional>

#include "palpate/base/latest.hpp"
#include "palpate/device/hand_guide.hpp"

namespace palpate {

/// Where somebody wants the hand to be, and when.
struct HandPose {
  HandWish wish;
  double stamp = 0;  ///< s, on the sender's clock; grows from pose to pose
};

/// What was said of a hand last.
struct HandWord {
  HandPose pose;
  bool held = false;        ///< somebody has the tool
  std::uint64_t poses = 0;  ///< that were told until now
};

/// A tool that somebody outside takes, moves and lets go: a page's mouse, a network, another
/// program. One thread at a time speaks; any number of others listen, without locks.
class RemoteHand {
 public:
  /// Takes the tool, if nobody has it, and moves it. False: the pose was left out, since it is not
  /// finite. Wait-free, as all that follows.
  bool move(const HandPose& pose) noexcept;

  /// Whoever has the tool is still there and lets it rest: a mouse says nothing while nobody moves
  /// it, but its connection does. More often than the listener's silence.
  void keep() noexcept;

  /// Lets the tool go.
  void release() noexcept;

  /// What was said last; none when the speaker was too fast to be understood.
  [[nodiscard]] std::optional<HandWord> look() const noexcept { return word_.look(); }
  /// Grows with everything that is said.
  [[nodiscard]] std::uint64_t generation() const noexcept { return word_.generation(); }

 private:
  HandWord said_;  // of those who speak
  Latest<HandWord> word_;
};

}  // namespace palpate
