#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::sensor {

/// Why a frame is not passed on.
struct Objection {
  std::uint64_t StreamState::Drops::*cause;
  std::string words;
};

/// Does the camera itself leave a frame out that came?
[[nodiscard]] bool left_out(CameraStatus status) noexcept;

/// The objection to such a frame, for the camera's reason.
[[nodiscard]] Objection objection_to(CameraStatus status, const std::string& reason);

/// Looks at the frames of one camera, in the order in which they come.
class FrameCheck {
 public:
  explicit FrameCheck(bool allow_repeats) : allow_repeats_(allow_repeats) {}

  /// Nothing when the frame is good. No stamp can lie after `latest`, s.
  [[nodiscard]] std::optional<Objection> examine(const DepthFrame& frame, double latest);

  /// New sizes that lasted.
  [[nodiscard]] std::uint64_t size_changes() const { return size_changes_; }

 private:
  [[nodiscard]] std::optional<Objection> check_stamp(double stamp, double latest) const;
  [[nodiscard]] std::optional<Objection> check_size(const DepthFrame& frame);
  [[nodiscard]] std::optional<Objection> check_picture(const DepthFrame& frame);

  struct Size {
    int width = 0;
    int height = 0;
    bool operator==(const Size&) const = default;
  };

  bool allow_repeats_;
  Size size_;               // of frames that are passed on
  Size candidate_;          // another one that came lately
  int candidate_seen_ = 0;  // times in a row
  std::uint64_t size_changes_ = 0;
  std::optional<double> stamp_;           // of the last frame that was passed on
  std::optional<std::uint64_t> picture_;  // sum over its depths
};

}  // namespace palpate::sensor
