#pragma once

#include <atomic>
#include <cstdint>

#include "palpate/device/hand_guide.hpp"
#include "palpate/device/playback.hpp"
#include "palpate/device/pose_glide.hpp"
#include "palpate/device/remote_hand.hpp"

namespace palpate {

struct GuidedHandOptions {
  double speed = 0.5;       ///< the wish goes no faster, but along the trajectory itself, m/s; > 0
  double silence = 0.1;     ///< s without a word after which the tool counts as let go; > 0
  double letting_go = 0.2;  ///< time constant in which the hand ceases to pull, s; > 0
  double return_after = 3;  ///< from letting go until the trajectory goes on, s; 0 or more
};

/// A hand that plays a trajectory again and again, such as that of explore(), until somebody takes
/// the tool; then it follows him, and some time after he let go it returns to the trajectory.
///
///  - Where the way begins, is interrupted or starts anew, the wish goes there at `speed`;
///    the trajectory waits for it.
///  - Poses are followed as PoseGlide does, and no faster than `speed`.
///  - Silence is letting go: the wish goes to where the device is, so that nothing pulls any more
///    and the surface pushes it out. That is the fade of a simulated device's force.
///
/// Same words at the same times, same bits. One thread asks; speaking to the RemoteHand is for
/// others.
class GuidedHand final : public HandGuide {
 public:
  /// `way`: device frame; empty: none. `remote` outlives it.
  /// @throws Error when an option is out of range or the way is no trajectory.
  explicit GuidedHand(const RemoteHand& remote, Trajectory way = {},
                      const GuidedHandOptions& options = {});

  [[nodiscard]] HandWish wanted(double time, const Eigen::Vector3d& position) noexcept override;

  /// Somebody outside has the tool. Any thread.
  [[nodiscard]] bool taken() const noexcept { return taken_.load(); }

 private:
  enum class Mode { returning, playing, following, letting_go };

  void begin(double time, const Eigen::Vector3d& position) noexcept;
  void listen(double time) noexcept;
  void choose(double time) noexcept;
  void go_on(double time, const Eigen::Vector3d& position) noexcept;
  void play(double dt) noexcept;
  void approach(const Eigen::Vector3d& goal, double dt) noexcept;

  const RemoteHand& remote_;
  Playback way_;
  GuidedHandOptions options_;
  PoseGlide glide_;
  HandWord word_;
  HandWish wish_;
  Mode mode_ = Mode::letting_go;
  double time_ = 0;      // of the last call
  double way_time_ = 0;  // on the trajectory
  double heard_ = 0;     // when something was said last
  double let_go_ = 0;    // when the tool was let go
  std::uint64_t generation_ = 0;
  bool started_ = false;
  std::atomic<bool> taken_{false};
};

}  // namespace palpate
