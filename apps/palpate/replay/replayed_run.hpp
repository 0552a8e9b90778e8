#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "apps/palpate/cli/output.hpp"
#include "bag/mcap_reader.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// How the forces of a hand that was done again compare with those that were recorded.
struct ForceDifference {
  std::string topic;
  std::uint64_t steps = 0;
  std::uint64_t differing = 0;  ///< steps
  double largest = 0;           ///< |F - F recorded|, N
  double squares = 0;           ///< their sum, N^2
  std::uint64_t first = 0;      ///< the first step that differs; 0: none does
  double first_time = 0;        ///< s since the hand's first step
  std::string ended;            ///< why it could not be done to the end; empty: it was

  [[nodiscard]] bool exact() const { return steps > 0 && differing == 0 && ended.empty(); }
  [[nodiscard]] double rms() const;
};

/// What `path`, which `reader` reads, says of its run. @throws Error when it is no recording of
/// one.
[[nodiscard]] Json recorded_setup(const bag::McapReader& reader, const std::string& path);

/// A recorded run that is done again, hand by hand: to each hand's field a source shows in each
/// step what it showed in the run, so that it does not matter how hands and streams went side by
/// side. Reads the file as it goes. One thread.
class ReplayedRun {
 public:
  /// @throws Error when the file cannot be read, or is no recording of a run.
  explicit ReplayedRun(const std::string& path);

  [[nodiscard]] std::size_t hands() const { return setup_.at("hands").size(); }

  /// Told of every step, with times from 0.
  using EachStep = std::function<void(const ServoState&, const DeviceInfo&)>;

  /// Does what that hand did. @throws Error when the file's messages are damaged.
  [[nodiscard]] ForceDifference replay(std::size_t hand, const EachStep& each) const;

  /// The steps of that hand as they were recorded, whether they can be done again or not.
  /// @throws Error as replay() does.
  void recorded(std::size_t hand, const EachStep& each) const;

 private:
  std::string path_;
  Json setup_;
};

}  // namespace palpate::app
