#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "apps/palpate/cli/output.hpp"
#include "bag/mcap_reader.hpp"
#include "message/palpate_types.hpp"
#include "palpate/device/device.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// A device that was there while its hand was recorded.
class RecordedDevice final : public Device {
 public:
  explicit RecordedDevice(const Json& info);
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override { return {}; }
  void write(const Eigen::Vector3d& /*force*/) noexcept override {}
  [[nodiscard]] std::string reason() const override { return {}; }

 private:
  DeviceInfo info_;
};

/// When a moment of a run was recorded, ns; where the run's time is before the first, 0.
/// `epoch`: when the run's clock was 0, ns.
[[nodiscard]] std::uint64_t logged_at(double time, std::int64_t epoch);

/// The steps of a recorded hand, from any moment on. Holds a few chunks of the file. One thread.
/// What is damaged throws Error.
class RecordedHand {
 public:
  /// `setup`: the recording's; `reader`: of the file.
  RecordedHand(const std::string& path, const bag::McapReader& reader, const Json& setup,
               std::size_t hand);

  [[nodiscard]] const ServoOptions& options() const { return options_; }

  /// next() gives what was recorded at `time` (s, on the run's clock) and after.
  void seek(double time);

  /// The next step, if it is not after `until` (s); none: there are no more until then.
  [[nodiscard]] std::optional<ServoState> next(
      double until = std::numeric_limits<double>::infinity());

  /// The last step at or before `time`, or the first one where there is none; next() goes on
  /// behind it. None: there are no steps.
  [[nodiscard]] std::optional<ServoState> at(double time);

 private:
  bag::McapReader reader_;
  std::string topic_;
  std::int64_t epoch_;  // ns
  ServoOptions options_;
  std::optional<ServoState> upcoming_;  // that was read already
};

}  // namespace palpate::app
