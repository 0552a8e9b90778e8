#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"
#include "viewer/messages.hpp"

namespace palpate::viewer {

/// Names the servos' tools: the device's name, with a number if several share it: "simulated 1",
/// "simulated 2".
[[nodiscard]] std::vector<std::string> tool_names(const std::vector<Servo*>& servos);

/// State of every source of `scene` at `now` (s, on the snapshots' clock). Takes milliseconds; any
/// thread but a servo's.
[[nodiscard]] std::vector<SourceReport> source_reports(const Scene& scene,
                                                       std::span<const ViewedStream> streams,
                                                       const Eigen::Vector3d& origin, double now);

/// Makes the messages of one servo's state: of what happened since the message before. One thread
/// uses it.
class StateReporter {
 public:
  StateReporter(const Servo& servo, std::size_t device, const Eigen::Vector3d& origin)
      : servo_(servo), device_(static_cast<std::uint8_t>(device)), origin_(origin) {}

  /// `now`: s, of the host; `radius`: R, m; none: the servo made no step yet.
  [[nodiscard]] std::optional<StateMessage> next(double now, double radius, bool taken);

 private:
  [[nodiscard]] double rate(double now, std::uint64_t step);
  [[nodiscard]] double interval(const ServoState& state);
  [[nodiscard]] std::vector<Eigen::Vector3f> forces_until(std::uint64_t step);
  [[nodiscard]] std::uint32_t flags(const ServoState& state, bool taken);

  const Servo& servo_;
  std::uint8_t device_;
  Eigen::Vector3d origin_;
  std::uint64_t step_ = 0;  // of the message before
  double time_ = 0;         // of it, s
  std::uint64_t forces_seen_ = 0;
  Guard::State::Counts counts_;
  StepDurations durations_;
  std::deque<std::pair<double, std::uint64_t>> steps_;  // when which step was the newest
};

/// The latched fault of a device, if there is one.
struct DeviceFault {
  std::string name;
  Guard::Fault fault = Guard::Fault::none;
};

/// Reports new problems of streams and devices, and remembers lasting ones. One thread uses it.
class FaultNotices {
 public:
  /// A problem that comes again after so long, in s of the stream's clock, is a new one.
  static constexpr double kPeace = 10;

  /// Problems new since the last call, and those that lasted until then and are over. Each index
  /// stands for the same device in every call.
  [[nodiscard]] std::vector<Notice> update(std::span<const ViewedStream> streams,
                                           std::span<const DeviceFault> devices);

  /// Problems present at the last call, for pages that connect later.
  [[nodiscard]] const std::vector<Notice>& present() const { return present_; }

 private:
  struct Problem {
    std::string words;
    double time = 0;
  };

  [[nodiscard]] bool is_new(const StreamState& stream);

  std::map<std::string, Problem> problems_;  // the last one of each source
  std::map<std::size_t, Guard::Fault> faults_;
  std::vector<Notice> present_;
};

}  // namespace palpate::viewer
