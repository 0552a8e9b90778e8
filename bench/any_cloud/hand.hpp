#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::any_cloud {

/// What is asked of a tick.
enum class Wanted {
  judged,   ///< contact where the ideal proxy has it, none in free air
  either,   ///< with contact or without, but without steps: where an edge lets go
  ignored,  ///< nothing but finite numbers
  free,     ///< no contact, whatever the truth says
};

struct HandTick {
  Eigen::Vector3d hand = Eigen::Vector3d::Zero();
  Wanted wanted = Wanted::judged;
  bool starts = false;  ///< a stroke begins: the proxy is put where the hand is
  bool poke = false;    ///< the next of the pokes of one stroke begins
};

/// Draws strokes of a hand, tick by tick, in spacings.
class HandPath {
 public:
  HandPath& start(const Eigen::Vector3d& place);
  /// In a straight line, at `speed` spacings a second.
  HandPath& to(const Eigen::Vector3d& goal, double speed, Wanted wanted = Wanted::judged);
  /// The ticks from here on are another poke.
  HandPath& poke();
  /// One tick.
  HandPath& tick(const Eigen::Vector3d& place, Wanted wanted = Wanted::judged);

  std::vector<HandTick> ticks;
};

}  // namespace palpate::any_cloud
