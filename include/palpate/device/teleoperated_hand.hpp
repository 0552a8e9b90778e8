#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "palpate/device/simulated.hpp"

namespace palpate {

/// A tool that is taken, moved and released from outside: by a page's mouse, over a network, by
/// another program. One thread at a time sends; any number of others read, without locks.
class RemoteTarget {
 public:
  /// The newest command to a tool.
  struct Command {
    HandTarget target;
    double stamp = 0;         ///< of the target, s, on the sender's clock
    bool held = false;        ///< somebody holds the tool
    std::uint64_t moves = 0;  ///< targets that were sent so far
  };

  RemoteTarget();
  ~RemoteTarget();

  /// Takes the tool, unless it is held already, and moves it. `stamp`: s, on the sender's clock;
  /// grows from call to call. False: ignored, since it is not finite. Wait-free, as all that
  /// follows.
  bool move(const HandTarget& target, double stamp) noexcept;

  /// The user of the tool is still connected and keeps it still: a mouse that rests sends
  /// nothing, so its connection calls this, more often than the reader's command_timeout.
  void keep_alive() noexcept;

  void release() noexcept;

  /// The newest command; none when the sender was too fast for a consistent copy.
  [[nodiscard]] std::optional<Command> command() const noexcept;
  /// Grows with every call above that had an effect.
  [[nodiscard]] std::uint64_t generation() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

struct TeleoperatedHandOptions {
  double speed = 0.5;            ///< limit of the target's speed, but on the trajectory, m/s; > 0
  double command_timeout = 0.1;  ///< s without a command after which the tool is released; > 0
  double release_time = 0.2;     ///< time constant in which the hand ceases to pull, s; > 0
  double return_after = 3;       ///< s from the release until the trajectory goes on; 0 or more
};

/// A hand that plays a trajectory again and again, such as that of explore(), until somebody takes
/// the tool; then it follows the commands, and some time after the release it returns to the
/// trajectory.
///
///  - To the trajectory's beginning, and back to where it was interrupted, the target moves at
///    `speed`; the trajectory waits for it.
///  - Commands are interpolated between their irregular times, and followed no faster than `speed`.
///  - A command that is overdue counts as a release: the target moves to where the device is, so
///    that nothing pulls any more and the surface pushes it out.
///
/// Same commands at the same times, same bits. One thread calls target(); others send to the
/// RemoteTarget.
class TeleoperatedHand final : public TargetSource {
 public:
  /// `trajectory`: device frame; empty: none. `remote` outlives it.
  /// @throws Error when an option is out of range or the trajectory is not valid.
  explicit TeleoperatedHand(const RemoteTarget& remote, Trajectory trajectory = {},
                            const TeleoperatedHandOptions& options = {});
  ~TeleoperatedHand() override;

  [[nodiscard]] HandTarget target(double time, const Eigen::Vector3d& position) noexcept override;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate
