#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bag/mcap_reader.hpp"
#include "message/palpate_types.hpp"
#include "palpate/device/device.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "session/recorded_messages.hpp"

namespace palpate::session {

/// The recording of a run, to be read (docs/bags.md): what the run was made of, and its steps and
/// frames from any moment on. Times are s on the run's clock. Damaged data throw Error or
/// nlohmann::json::exception.
class Recording {
 public:
  struct Hand {
    std::string topic;
    DeviceInfo device;
    ServoOptions options;
  };
  struct Origin {  ///< of a source's surface
    std::string name;
    std::string topic;
    SourceOptions options;
    bool lives = false;  ///< it is a camera
    bool as_cloud = false;
    std::optional<CameraModel> lens;  ///< of a depth image that does not change
    std::optional<Eigen::Isometry3d> pose;
  };
  /// A step of a hand, and what was changed just before it.
  struct Step {
    std::size_t hand = 0;
    message::Tick tick;
    std::optional<message::ToolStep> tool = {};  ///< of a tool that turns
    std::vector<message::Change> changes;
  };
  class Steps;
  class Frames;

  /// @throws Error when the file cannot be read, or is no recording of a run.
  explicit Recording(const std::string& path) : Recording(bag::RandomFile(path)) {}
  explicit Recording(bag::RandomFile file);

  [[nodiscard]] const std::string& path() const { return file_.path(); }
  [[nodiscard]] const std::vector<Hand>& hands() const { return hands_; }
  [[nodiscard]] const std::vector<Origin>& sources() const { return sources_; }
  /// Was the run in the axes of a camera's picture, y down?
  [[nodiscard]] bool in_picture_axes() const { return in_picture_axes_; }

  /// When the first and the last step were. @throws Error when there is no step.
  struct Stretch {
    double begin = 0;
    double end = 0;
  };
  [[nodiscard]] Stretch stretch() const;

  /// Adds that source to `scene`, with its surface unless it lives.
  Source& add_source(std::size_t index, Scene& scene) const;

 private:
  [[nodiscard]] std::uint64_t logged_at(double time) const;
  [[nodiscard]] bag::Attachment attachment(const std::string& name) const;

  bag::RandomFile file_;
  bag::McapReader reader_;
  std::int64_t epoch_ = 0;  // when the run's clock was 0, ns since 1970
  bool in_picture_axes_ = false;
  std::vector<Hand> hands_;
  std::vector<Origin> sources_;
};

/// The steps of one hand or of all, in order. Holds a few chunks of the file. One thread; the
/// recording outlives it.
class Recording::Steps {
 public:
  /// `hand`: none: all of them.
  explicit Steps(const Recording& recording, std::optional<std::size_t> hand = {});

  /// next() gives what was recorded at `time` and after.
  void seek(double time);
  /// The next step, if it is not after `until`; none: there are no more until then.
  [[nodiscard]] std::optional<Step> next(double until = std::numeric_limits<double>::infinity());
  /// Last step at or before `time`, else the first; none if there is no step. next() continues
  /// after it.
  [[nodiscard]] std::optional<Step> at(double time);
  /// What of the file is lost, as far as it was read, in words.
  [[nodiscard]] const std::vector<std::string>& losses() const;

 private:
  const Recording* recording_;
  bag::McapReader reader_;
  std::map<std::string, std::size_t> topics_;            // with their hand
  std::vector<std::vector<message::Change>> changes_;    // of each hand, before its next step
  std::vector<std::optional<message::ToolStep>> tools_;  // the same
  std::optional<Step> upcoming_;                         // read, but not given yet
};

/// The frames of a source that lives, in order. One thread; the recording outlives it.
class Recording::Frames {
 public:
  Frames(const Recording& recording, std::size_t source);

  /// next() gives what was recorded at `time` and after.
  void seek(double time);
  /// The next frame with what became of it; none: there are no more.
  [[nodiscard]] std::optional<RecordedFrame> next();

 private:
  const Recording* recording_;
  bag::McapReader reader_;
  std::string topic_;
};

/// A device that was there while its hand was recorded.
class RecordedDevice final : public Device {
 public:
  explicit RecordedDevice(DeviceInfo info) : info_(std::move(info)) {}
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override { return {}; }
  void write(const Eigen::Vector3d& /*force*/) noexcept override {}
  [[nodiscard]] std::string reason() const override { return {}; }

 private:
  DeviceInfo info_;
};

}  // namespace palpate::session
