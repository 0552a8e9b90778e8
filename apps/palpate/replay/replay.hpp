#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "palpate/servo/servo.hpp"
#include "session/recording.hpp"

namespace palpate::app {

/// How the forces of a replayed hand compare with the recorded ones; of a tool that turns its
/// torques, grip and pose, too.
struct ForceDifference {
  std::string topic;
  std::uint64_t steps = 0;
  std::uint64_t differing = 0;                ///< steps
  double largest = 0;                         ///< |F - F recorded|, N
  std::optional<double> largest_torque = {};  ///< the same of a tool that turns, N m
  double squares = 0;                         ///< their sum, N^2
  std::uint64_t first = 0;                    ///< the first step that differs; 0: none does
  double first_time = 0;                      ///< s since the hand's first step
  std::string ended;  ///< why it could not be done to the end; empty: it was

  [[nodiscard]] bool exact() const { return steps > 0 && differing == 0 && ended.empty(); }
  [[nodiscard]] double rms() const;
};

/// Does a recorded run again, hand by hand: in each step, each source shows a hand's field what it
/// showed in the run. So it does not matter how hands and streams ran side by side. Reads the file
/// as it goes. One thread.
class Replay {
 public:
  /// @throws Error when the file cannot be read, or is no recording of a run.
  explicit Replay(const std::string& path) : recording_(path) {}

  [[nodiscard]] std::size_t hands() const { return recording_.hands().size(); }
  /// Does that hand hold a tool that turns?
  [[nodiscard]] bool turns(std::size_t hand) const {
    return recording_.hands().at(hand).options.tool != nullptr;
  }
  /// Metres of the world for one of that hand's device.
  [[nodiscard]] double scale(std::size_t hand) const {
    return recording_.hands().at(hand).options.workspace.scale;
  }

  /// Called with every step, with times from 0.
  using EachStep = std::function<void(const ServoState&, const DeviceInfo&)>;

  /// Does what that hand did. @throws Error when the file's messages are damaged.
  [[nodiscard]] ForceDifference run(std::size_t hand, const EachStep& each) const;

  /// The steps of that hand as they were recorded, even if they cannot be done again.
  /// @throws Error as run() does.
  void show(std::size_t hand, const EachStep& each) const;

 private:
  session::Recording recording_;
};

}  // namespace palpate::app
