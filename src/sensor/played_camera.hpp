#pragma once

#include <memory>
#include <optional>
#include <string>

#include "palpate/sensor/depth_camera.hpp"

namespace palpate::sensor {

/// Images that were recorded, one after another.
class Recording {
 public:
  virtual ~Recording() = default;
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Begins again with the first.
  virtual void rewind() = 0;

  /// The next one: frame, damaged or unposed, and `why`; or ended, again and again. `time`: when it
  /// was taken, s since the first; never goes back.
  [[nodiscard]] virtual DepthCamera::Status next(DepthFrame& frame, double& time,
                                                 std::string& why) = 0;

 protected:
  Recording() = default;
};

/// Plays a recording: every image is shown, in order, at its time on the clock, or as fast as they
/// are requested where there is none; one that is requested too late at once. Stamps go on as
/// recorded, from begin() on; without that from when the first image is requested, and from 0
/// without a clock. A recording that loops begins again one image's time after its last.
class PlayedCamera final : public DepthCamera {
 public:
  /// Sets `info.paces` itself.
  PlayedCamera(CameraInfo info, std::unique_ptr<Recording> recording, const CameraOptions& options);

  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  void begin(double start) override;
  [[nodiscard]] DepthCamera::Status read(DepthFrame& frame, double timeout) override;
  [[nodiscard]] std::string reason() const override { return reason_; }

 private:
  void load();
  [[nodiscard]] bool wait(double time, double timeout) const;

  CameraInfo info_;
  std::unique_ptr<Recording> recording_;
  CameraOptions options_;
  std::optional<double> start_;  // stamp of the first image, s; unset until it is requested
  double lap_ = 0;               // s from there to the first image of this lap
  bool any_ = false;             // there was an image in this lap
  // The next image, if it was loaded beforehand, and how that went.
  bool loaded_ = false;
  DepthCamera::Status status_ = DepthCamera::Status::frame;
  DepthFrame frame_;
  double time_ = 0;  // s since the lap's first
  std::string why_;
  std::string reason_;
};

}  // namespace palpate::sensor
